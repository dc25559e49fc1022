#include "benchmark/reference/reference_contact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace endovascular_sim::benchmark
{
namespace
{

// Nonlinear elastica with k0 l = 1: for h/l = 0.1 part of the wire lies on the floor, for h/l = 0.3 none.
TEST(ReferenceContact, WallForceOfAJTipInAStraightChannelEqualsTheElastica)
{
  for (const char* scheme : {"kkt", "mixed", "paper"})
  {
    const double tolerance = std::string(scheme) == "paper" ? 0.02 : 0.002;
    const Measured lying = ceilingForce(scheme, 1.0, 0.1, 51);
    EXPECT_EQ(lying.note, "") << scheme;
    EXPECT_NEAR(lying.value, 1.312420794870624, tolerance * 1.312420794870624) << scheme;
    const Measured free = ceilingForce(scheme, 1.0, 0.3, 51);
    EXPECT_EQ(free.note, "") << scheme;
    EXPECT_NEAR(free.value, 0.6228358256021349, tolerance * 0.6228358256021349) << scheme;
  }
}

// µ = 0.3, 90°, EI/(T1 R²) = 0.1; the ratio without bending stiffness is e^0.47 = 1.602.
TEST(ReferenceContact, TensionRatioOfAStiffWireOverAPegEqualsTheCapstan)
{
  for (const char* scheme : {"kkt", "mixed"})
  {
    const Measured capstan = capstanRatio(scheme, 59, 0.02);
    EXPECT_EQ(capstan.note, "") << scheme;
    EXPECT_NEAR(capstan.value, kCapstanRatio, 0.01 * kCapstanRatio) << scheme;
  }
}

// Exact: ½EIκ² while the tip is in the bend, within a clearance of a hundredth of the radius, and 0 beyond it.
TEST(ReferenceContact, InsertionForceEqualsTheBendingEnergyPerLengthWithinABend)
{
  for (const char* scheme : {"kkt", "mixed"})
  {
    const Insertion insertion = insertIntoABend(scheme, 81);
    EXPECT_EQ(insertion.note, "") << scheme;
    EXPECT_GT(insertion.filling, 1.0 / (1.01 * 1.01)) << scheme;
    EXPECT_LT(insertion.filling, 1.005 / (0.99 * 0.99)) << scheme;
    EXPECT_NEAR(insertion.beyond, 0.0, 0.02) << scheme;
  }
}

}  // namespace
}  // namespace endovascular_sim::benchmark
