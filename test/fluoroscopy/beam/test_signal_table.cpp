#include "fluoroscopy/beam/signal_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace endovascular_sim::fluoroscopy
{
namespace
{

MaterialLibrary library()
{
  return MaterialLibrary::load(PROJECT_DIR "/config/xray/materials.yaml");
}

TEST(SignalTable, EqualsDirectIntegrationWithinTheTable)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const BeamSettings& settings : {BeamSettings{50.0, 2.5e-3, 0.0, {}}, BeamSettings{80.0, 2.5e-3, 0.2e-3, {}},
                                       BeamSettings{125.0, 2.5e-3, 0.1e-3, {}}, BeamSettings{80.0, 2.5e-3, 0.0, 60.0}})
  {
    const SignalTable table(Beam(settings), library());
    for (int k = 0; k < 3000; ++k)
    {
      const double bone = uniform(random), iodine = uniform(random);
      const ArealDensities densities{500.0 * uniform(random), 60.0 * bone * bone, 8.0 * iodine * iodine};
      const Response fast = table.at(densities), exact = table.integrate(densities);
      ASSERT_NEAR(std::exp(fast.log_signal - exact.log_signal), 1.0, 0.002)
          << settings.tube_voltage << " kV " << densities.tissue << " " << densities.bone << " " << densities.iodine;
      ASSERT_NEAR(fast.variance_weight, exact.variance_weight, 0.002 * exact.variance_weight);
      ASSERT_NEAR(fast.steel_slope, exact.steel_slope, 0.005 * exact.steel_slope);
    }
  }
}

TEST(SignalTable, ContinuesMonotonicallyBeyondTheTable)
{
  const SignalTable table(Beam({}), library());
  float before = table.at({0.0, 0.0, 0.0}).log_signal;
  for (double x = 0.5; x < 3.0; x += 0.5)
  {
    const float now =
        table.at({x * SignalTable::kTissueMax, x * SignalTable::kBoneMax, x * SignalTable::kIodineMax}).log_signal;
    EXPECT_LT(now, before);
    before = now;
  }
  EXPECT_GT(table.at({-10.0, 0.0, 0.0}).log_signal, table.at({0.0, 0.0, 0.0}).log_signal);
}

TEST(SignalTable, HardensWithThickness)
{
  const SignalTable table(Beam({}), library());
  EXPECT_GT(table.at({200.0, 0.0, 0.0}).variance_weight, table.at({0.0, 0.0, 0.0}).variance_weight);
  EXPECT_LT(table.at({200.0, 0.0, 0.0}).steel_slope, table.at({0.0, 0.0, 0.0}).steel_slope);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
