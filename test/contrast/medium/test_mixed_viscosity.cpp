#include "contrast/medium/mixed_viscosity.h"

#include <gtest/gtest.h>

namespace endovascular_sim::contrast
{
namespace
{

constexpr double kWater = 0.69e-3, kIohexol350 = 10.4e-3;  // at 37 °C [Pa·s]

TEST(MixedViscosity, OfIohexolWithWaterIsThatOfItsWeakerSolutions)
{
  const struct
  {
    double concentration, viscosity;  // Omnipaque, prescribing information
  } solutions[] = {{140.0, 1.5e-3}, {180.0, 2.0e-3}, {240.0, 3.4e-3}, {300.0, 6.3e-3}, {350.0, 10.4e-3}};
  for (const auto& solution : solutions)
  {
    const double mixed = kWater * mixedViscosityRatio(solution.concentration / 350.0, kIohexol350, kWater);
    EXPECT_NEAR(mixed, solution.viscosity, 0.4 * solution.viscosity) << solution.concentration;
  }
}

TEST(MixedViscosity, IsThatOfTheBloodWithoutMediumAndThatOfTheMediumWithoutBlood)
{
  EXPECT_EQ(mixedViscosityRatio(0.0, 0.01, 0.004), 1.0);
  EXPECT_NEAR(mixedViscosityRatio(1.0, 0.01, 0.004), 2.5, 1e-12);
  EXPECT_NEAR(mixedViscosityRatio(1.7, 0.01, 0.004), 2.5, 1e-12);
  EXPECT_EQ(mixedViscosityRatio(-0.2, 0.01, 0.004), 1.0);
}

}  // namespace
}  // namespace endovascular_sim::contrast
