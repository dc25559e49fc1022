#include "contrast/medium/medium_viscosity.h"

#include <gtest/gtest.h>

namespace endovascular_sim::contrast
{
namespace
{

TEST(MediumViscosity, IsThatOfIohexolAndOfWater)
{
  EXPECT_EQ(mediumViscosity(350.0), 10.4e-3);
  EXPECT_EQ(mediumViscosity(300.0), 6.3e-3);
  EXPECT_EQ(mediumViscosity(140.0), 1.5e-3);
  EXPECT_NEAR(mediumViscosity(0.0), 0.69e-3, 1e-18);
}

TEST(MediumViscosity, RisesWithTheConcentration)
{
  for (double concentration = 0.0; concentration < 400.0; concentration += 10.0)
    EXPECT_LT(mediumViscosity(concentration), mediumViscosity(concentration + 10.0)) << concentration;
  EXPECT_NEAR(mediumViscosity(400.0), 17.2e-3, 0.1e-3);
}

}  // namespace
}  // namespace endovascular_sim::contrast
