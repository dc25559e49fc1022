#include "benchmark/reference/reference_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace endovascular_sim::benchmark
{
namespace
{

// L/s* = 24.
TEST(ReferenceShapes, LocalisedHelixConvergesWithSecondOrder)
{
  const LocalisedHelix coarse = localisedHelix(601);
  const LocalisedHelix fine = localisedHelix(1201);
  EXPECT_TRUE(coarse.converged);
  EXPECT_TRUE(fine.converged);
  EXPECT_LT(fine.envelope_error, 1e-2);
  EXPECT_LT(fine.torque_error, 1e-3);
  EXPECT_NEAR(std::log2(coarse.envelope_error / fine.envelope_error), 2.0, 0.1);
}

TEST(ReferenceShapes, StepsAndStaticSolverGiveTheSameLocalisedHelix)
{
  const LocalisedHelix rest = localisedHelix(301);
  const LocalisedHelix steps = localisedHelixInSteps(301);
  EXPECT_TRUE(steps.converged);
  EXPECT_NEAR(steps.envelope_error, rest.envelope_error, 1e-4);
  EXPECT_NEAR(steps.torque_error, rest.torque_error, 1e-5);
}

TEST(ReferenceShapes, PostBucklingOfAClampedWireConvergesToTheElasticaWithSecondOrder)
{
  const Buckled coarse = buckle(27);
  const Buckled fine = buckle(51);
  const double edges = std::log(49.0 / 25.0);
  EXPECT_NEAR(std::log((coarse.force - kBuckledForce) / (fine.force - kBuckledForce)) / edges, 2.0, 0.1);
  EXPECT_NEAR(std::log((coarse.deflection - kBuckledDeflection) / (fine.deflection - kBuckledDeflection)) / edges, 2.0,
              0.1);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
