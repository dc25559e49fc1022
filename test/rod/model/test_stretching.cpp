#include "rod/model/stretching.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kRest = 0.9;
constexpr double kStiffness = 3.0;
constexpr double kStep = 1e-6;
const Eigen::Vector3d kStretched(0.9, 0.3, -0.2);
const Eigen::Vector3d kCompressed(0.5, 0.2, 0.3);

/** ∂²E/∂e², indefinite under compression [N/m]. */
Eigen::Matrix3d exactHessian(const Stretching& edge)
{
  return (edge.axial_stiffness / edge.rest_length) * edge.direction * edge.direction.transpose() +
         edge.geometric(edge.tension);
}

TEST(Stretching, EnergyIsHalfTheStiffnessTimesStrainSquaredTimesLength)
{
  const Stretching edge(Eigen::Vector3d(1.08, 0.0, 0.0), kRest, kStiffness);
  EXPECT_NEAR(edge.energy(), 0.5 * kStiffness * 0.2 * 0.2 * kRest, 1e-15);
  EXPECT_NEAR(edge.tension, kStiffness * 0.2, 1e-15);
}

TEST(Stretching, GradientAndExactHessianEqualFiniteDifferences)
{
  for (const Eigen::Vector3d& e : {kStretched, kCompressed})
  {
    const Stretching edge(e, kRest, kStiffness);
    for (int axis = 0; axis < 3; ++axis)
    {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const Stretching up(e + step, kRest, kStiffness);
      const Stretching down(e - step, kRest, kStiffness);
      EXPECT_NEAR((up.energy() - down.energy()) / (2.0 * kStep), edge.gradient()[axis], 1e-9);
      EXPECT_LT(((up.gradient() - down.gradient()) / (2.0 * kStep) - exactHessian(edge).col(axis)).norm(), 1e-8);
    }
  }
}

TEST(Stretching, PositiveHessianOmitsTheGeometricTermOfCompressionOnly)
{
  const Stretching stretched(kStretched, kRest, kStiffness);
  const Stretching compressed(kCompressed, kRest, kStiffness);
  EXPECT_EQ(exactHessian(stretched), stretched.positiveHessian());
  using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;
  EXPECT_LT(Solver(exactHessian(compressed)).eigenvalues()[0], -0.1);
  EXPECT_GT(Solver(compressed.positiveHessian()).eigenvalues()[0], -1e-15);
}

TEST(Stretching, GeometricTermIsTheSecondDerivativeOfTheMultiplierTimesTheLength)
{
  const double multiplier = -1.4;
  const Eigen::Matrix3d geometric = Stretching(kStretched, kRest, kStiffness).geometric(multiplier);
  for (int axis = 0; axis < 3; ++axis)
  {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d difference =
        multiplier / (2.0 * kStep) * ((kStretched + step).normalized() - (kStretched - step).normalized());
    EXPECT_LT((difference - geometric.col(axis)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
