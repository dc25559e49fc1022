#include "benchmark/facets/facets_study.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

TEST(FacetsStudy, ASmoothWallOf16FacetsExertsNoTorqueOnAJTip)
{
  EXPECT_GT(turnJTip(16, false, 0.0, 0.125, 1e-3).mean_torque, 60e-6);
  EXPECT_LT(std::abs(turnJTip(16, true, 0.0, 0.125, 1e-3).mean_torque), 10e-6);
}

// In a round tube without friction, turning costs nothing. Before positions and turns were solved together, the torque
// was 7 µN·m here, in proportion to the time step.
TEST(FacetsStudy, ATipInARoundTubeExertsNoTorqueWhateverTheTimeStep)
{
  for (const double time_step : {0.5e-3, 1e-3, 2e-3})
    EXPECT_LT(std::abs(turnJTip(64, true, 0.0, 0.125, time_step).mean_torque), 0.2e-6) << time_step;
}

TEST(FacetsStudy, TheTorqueOfFrictionOnASmoothWallIsIndependentOfTheFacets)
{
  const double few = turnJTip(16, true, 0.1, 0.125, 1e-3).mean_torque;
  const double many = turnJTip(48, true, 0.1, 0.125, 1e-3).mean_torque;
  EXPECT_NEAR(few, many, 0.02 * many);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
