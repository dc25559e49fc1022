#include "phantom/diseased_vessel.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"

namespace endovascular_sim::phantom
{
namespace
{

constexpr double kUsual = std::numeric_limits<double>::quiet_NaN();

TEST(DiseasedVessel, HasADistanceOfSlopeOneAtItsWall)
{
  constexpr double kStep = 1e-6;
  for (const std::string& name : diseaseNames())
  {
    const auto vessel = diseasedVessel(name, kUsual);
    double worst = 0.0;
    const double x_end = vessel->halfExtent().x();
    for (double z = -0.9 * vessel->halfExtent().z(); z < 0.9 * vessel->halfExtent().z(); z += 1.7e-3)
      for (double x = -x_end; x < x_end; x += 2e-5)
      {
        const Eigen::Vector3d p(x, 1e-4, z);
        if (std::abs(vessel->toWall(p)) > 1e-5)
          continue;
        Eigen::Vector3d gradient;
        for (int axis = 0; axis < 3; ++axis)
        {
          const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
          gradient[axis] = (vessel->toWall(p + step) - vessel->toWall(p - step)) / (2.0 * kStep);
        }
        worst = std::max(worst, std::abs(gradient.norm() - 1.0));
      }
    EXPECT_LT(worst, 0.15) << name;
  }
}

TEST(DiseasedVessel, HasClicksInsideOfItsLumenAndImage)
{
  for (const std::string& name : diseaseNames())
  {
    const auto vessel = diseasedVessel(name, kUsual);
    const PhantomSettings settings = vessel->usualImage();
    for (const Eigen::Vector3d& click : vessel->clicks())
    {
      EXPECT_LT(vessel->toWall(click), 0.0) << name;
      EXPECT_TRUE(settings.grid.bounds().contains(click)) << name;
    }
  }
}

TEST(DiseasedVessel, HasTheWantedDegree)
{
  EXPECT_NEAR(diseasedVessel("stenosis", 0.8)->toWall({3e-4, 0.0, 0.0}), 0.0, 1e-9);
  EXPECT_NEAR(diseasedVessel("bone", 1e-3)->valueAt({3.7e-3, 0.0, 0.0}), 1100.0, 1e-9);
  const auto dissection = diseasedVessel("dissection", 0.0);
  EXPECT_LT(dissection->toWall({1e-3, 0.0, 0.04}), 0.0);
  EXPECT_GT(dissection->toWall({-1e-3, 0.0, 0.04}), 0.0);
  EXPECT_EQ(dissection->valueAt({-5e-3, 0.0, 0.04}), 230.0);
}

TEST(DiseasedVessel, RefusesUnknownNamesAndDegreesOutOfRange)
{
  EXPECT_NE(inputErrorOf([] { diseasedVessel("measles", kUsual); }).find("choose aneurysm"), std::string::npos);
  EXPECT_NE(inputErrorOf([] { diseasedVessel("aneurysm", 1.0); }).find("between 0.025 and 0.08"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::phantom
