#include "benchmark/facets/facets_study.h"

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

TEST(FacetsStudy, ASmoothWallOf16FacetsExertsNoTorqueOnAJTip)
{
  EXPECT_GT(turnJTip(16, false, 0.0, 0.125, 1e-3).mean_torque, 60e-6);
  EXPECT_LT(turnJTip(16, true, 0.0, 0.125, 1e-3).mean_torque, 10e-6);
}

TEST(FacetsStudy, TheTorqueOfFrictionOnASmoothWallIsIndependentOfTheFacets)
{
  const double few = turnJTip(16, true, 0.1, 0.125, 1e-3).mean_torque;
  const double many = turnJTip(48, true, 0.1, 0.125, 1e-3).mean_torque;
  EXPECT_NEAR(few, many, 0.02 * many);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
