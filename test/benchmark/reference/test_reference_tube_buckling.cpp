#include "benchmark/reference/reference_tube_buckling.h"

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

// Pinned ends, L = 10 (EI r/q)^¼; Paslay & Bogy 1964, Dawson & Paslay 1984.
TEST(ReferenceTubeBuckling, ForceOfAHeavyWireInAStraightTubeEqualsTheTheory)
{
  for (const char* scheme : {"kkt", "mixed", "paper"})
  {
    const Measured force = buckleInATube(scheme, 41);
    EXPECT_EQ(force.note, "") << scheme;
    EXPECT_NEAR(force.value, kTubeBuckling, 0.01 * kTubeBuckling) << scheme;
  }
}

// 4 EI/(r R), He & Kyllingstad 1995; clamps add 2.5 % at this length.
TEST(ReferenceTubeBuckling, ForceOfAWeightlessWireInABentTubeEqualsTheTheory)
{
  const Measured force = buckleInABentTube("kkt", 62);
  EXPECT_EQ(force.note, "");
  EXPECT_NEAR(force.value, 1.0, 0.05);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
