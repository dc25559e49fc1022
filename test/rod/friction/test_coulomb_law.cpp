#include "rod/friction/coulomb_law.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace endovascular_sim::rod
{
namespace
{

constexpr CoulombLaw kLaw{0.2, 0.5e-6};
constexpr double kLengths[] = {0.0, 0.1e-6, 0.3e-6, 0.49e-6, 0.51e-6, 0.8e-6, 5e-6};  // m

TEST(CoulombLaw, ForceAndTangentAreTheDerivativesOfThePotential)
{
  const double h = 1e-3 * kLaw.slip;
  for (const double u : kLengths)
  {
    const auto potential = [](double stretch) { return kLaw.potential(std::abs(stretch)); };
    EXPECT_NEAR(kLaw.force(u), (potential(u + h) - potential(u - h)) / (2.0 * h), 1e-9 * kLaw.limit) << u;
    EXPECT_NEAR(kLaw.tangent(u), (kLaw.force(u + h) - kLaw.force(u - h)) / (2.0 * h), 1e-6 * kLaw.limit / kLaw.slip)
        << u;
    EXPECT_EQ(kLaw.force(-u), -kLaw.force(u));
  }
}

TEST(CoulombLaw, TheParabolaOfTheSecantTouchesThePotentialFromAbove)
{
  for (const double at : kLengths)
  {
    EXPECT_NEAR(kLaw.secant(at) * at, kLaw.force(at), 1e-15);
    const double offset = kLaw.potential(at) - 0.5 * kLaw.secant(at) * at * at;
    for (const double u : kLengths)
      EXPECT_GE(offset + 0.5 * kLaw.secant(at) * u * u, kLaw.potential(u) - 1e-22) << at << " " << u;
  }
}

TEST(CoulombLaw, SlidesWithTheLimitAtTheStretchThatIsCut)
{
  EXPECT_EQ(kLaw.returned(3e-6), kLaw.slip);
  EXPECT_EQ(kLaw.returned(-3e-6), -kLaw.slip);
  EXPECT_EQ(kLaw.returned(0.2e-6), 0.2e-6);
  Eigen::Vector3d stretch(3e-6, 0.0, 4e-6);
  kLaw.cut(stretch);
  EXPECT_NEAR(stretch.norm(), kLaw.slip, 1e-20);
  EXPECT_NEAR(kLaw.force(stretch.norm()), kLaw.limit, 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::rod
