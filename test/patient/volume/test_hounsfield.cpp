#include "patient/volume/hounsfield.h"

#include <gtest/gtest.h>

#include <limits>

namespace endovascular_sim::patient
{
namespace
{

TEST(Hounsfield, TheMassDensityIsThatOfThePublishedLines)
{
  EXPECT_DOUBLE_EQ(densityFromHounsfield(-1000.0).tissue, 1.21);
  EXPECT_NEAR(densityFromHounsfield(-98.0).tissue, 930.0, 1.0);
  EXPECT_DOUBLE_EQ(densityFromHounsfield(0.0).tissue, 1018.0);
  EXPECT_NEAR(densityFromHounsfield(45.0).tissue, 1047.0, 3.0);  // blood, muscle
  for (const double number : {150.0, 400.0, 900.0, 1400.0, 2000.0})
  {
    const Density density = densityFromHounsfield(number);
    EXPECT_NEAR(density.tissue + density.bone, 1017.0 + 0.592 * number, 1e-9) << number;
  }
  EXPECT_EQ(densityFromHounsfield(1524.0).tissue, 0.0);
}

TEST(Hounsfield, MassBoneAndSoftTissueBelowBoneIncreaseWithTheNumber)
{
  for (int number = -1024; number < 3071; ++number)
  {
    const Density a = densityFromHounsfield(number), b = densityFromHounsfield(number + 1);
    EXPECT_LE(a.tissue + a.bone, b.tissue + b.bone) << number;
    EXPECT_LE(a.bone, b.bone) << number;
    EXPECT_LT(b.tissue + b.bone - a.tissue - a.bone, 1.5) << number;  // continuous
    if (number < 100)
    {
      EXPECT_EQ(b.bone, 0.0) << number;
    }
  }
}

TEST(Hounsfield, TheNumberOfADensityIsTheInverse)
{
  for (int number = -1000; number < 2500; number += 7)
    EXPECT_NEAR(hounsfieldOf(densityFromHounsfield(number)), number, 1e-9);
  EXPECT_NEAR(hounsfieldOf({1060.0, 0.0}), 69.0, 1.0);  // blood
  EXPECT_NEAR(hounsfieldOf({930.0, 0.0}), -98.5, 1.0);  // fat
  EXPECT_EQ(hounsfieldOf({0.0, 0.0}), -1000.0);
}

TEST(Hounsfield, NumbersBelowAirAndNoNumbersAreAir)
{
  EXPECT_DOUBLE_EQ(densityFromHounsfield(-3024.0).tissue, 1.21);
  EXPECT_DOUBLE_EQ(densityFromHounsfield(std::numeric_limits<double>::quiet_NaN()).tissue, 1.21);
}

}  // namespace
}  // namespace endovascular_sim::patient
