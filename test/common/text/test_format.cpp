#include "common/text/format.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/units.h"

namespace endovascular_sim
{
namespace
{

TEST(TextFormat, WritesValuesOfAnyLength)
{
  EXPECT_EQ(formatted("%d of %s, %.2f", 3, "wire", 0.125), "3 of wire, 0.12");
  EXPECT_EQ(formatted("%s", std::string(5000, 'x').c_str()).size(), 5000U);
  EXPECT_EQ(formatted("%s", ""), "");
}

TEST(TextFormat, WritesNumbersWithSignificantDigits)
{
  EXPECT_EQ(shortNumber(0.25), "0.25");
  EXPECT_EQ(shortNumber(1216000.0, 4), "1.216e+06");
  EXPECT_EQ(shortNumber(1.0 / 3.0, 4), "0.3333");
}

TEST(TextFormat, WritesLengthsAndPositionsInMillimetres)
{
  EXPECT_EQ(inMillimetres(2.5e-3), "2.5 mm");
  EXPECT_EQ(inMillimetres(Eigen::Vector3d(1e-3, -2.5e-3, 0.03)), "(1.0, -2.5, 30.0) mm");
}

TEST(Units, HaveTheirValuesInSi)
{
  EXPECT_EQ(units::kPi, M_PI);
  EXPECT_EQ(units::kDegree, M_PI / 180.0);
  EXPECT_DOUBLE_EQ(6.0 * units::kFrench, 2e-3);
  EXPECT_NEAR(units::kAtmosphere, 760.0 * units::kMillimetreOfMercury, 0.1);
}

}  // namespace
}  // namespace endovascular_sim
