#include "rod/model/bending.h"

#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::rod
{
namespace
{

Eigen::Vector3d randomVector(std::mt19937& random)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return {uniform(random), uniform(random), uniform(random)};
}

/** Jacobians of κb by both edges, by central differences. */
void differences(const Eigen::Vector3d& e, const Eigen::Vector3d& g, double rest, Eigen::Matrix3d& by_e,
                 Eigen::Matrix3d& by_g)
{
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    by_e.col(axis) =
        (CurvatureBinormal(e + step, g, rest).value - CurvatureBinormal(e - step, g, rest).value) / (2.0 * kStep);
    by_g.col(axis) =
        (CurvatureBinormal(e, g + step, rest).value - CurvatureBinormal(e, g - step, rest).value) / (2.0 * kStep);
  }
}

class Bending : public testing::Test
{
protected:
  void SetUp() override
  {
    e = Eigen::Vector3d(1.0, 0.2, 0.1) + 0.3 * randomVector(random);
    g = Eigen::Vector3d(0.9, -0.3, 0.2) + 0.3 * randomVector(random);
    rest = 0.8;
    differences(e, g, rest, by_e, by_g);
  }

  std::mt19937 random{4};
  Eigen::Vector3d e, g;
  double rest = 1.0;
  Eigen::Matrix3d by_e, by_g;
};

TEST_F(Bending, CurvatureBinormalIsTwiceTheTangentOfHalfTheTurningAngle)
{
  const double angle = 0.7;
  const Eigen::Vector3d before(2.0, 0.0, 0.0);
  const Eigen::Vector3d after = 3.0 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
  const Eigen::Vector3d kb = CurvatureBinormal(before, after, 6.0).value;
  EXPECT_NEAR(kb.z(), 2.0 * std::tan(0.5 * angle), 1e-15);
  EXPECT_NEAR(kb.head<2>().norm(), 0.0, 1e-15);
}

TEST_F(Bending, TransposedJacobiansEqualFiniteDifferences)
{
  const CurvatureBinormal kb(e, g, rest);
  const Eigen::Vector3d r = randomVector(random);
  EXPECT_LT((kb.transposeBefore(r) - by_e.transpose() * r).norm(), 1e-9);
  EXPECT_LT((kb.transposeAfter(r) - by_g.transpose() * r).norm(), 1e-9);
}

TEST_F(Bending, GaussNewtonBlocksEqualTheProductsOfFiniteDifferenceJacobians)
{
  const double scale = 1.7;
  const BendingHessian hessian(CurvatureBinormal(e, g, rest), scale);
  EXPECT_LT((hessian.before_before - scale * by_e.transpose() * by_e).norm(), 1e-8);
  EXPECT_LT((hessian.before_after - scale * by_e.transpose() * by_g).norm(), 1e-8);
  EXPECT_LT((hessian.after_after - scale * by_g.transpose() * by_g).norm(), 1e-8);
}

TEST_F(Bending, GradientHasNoResultantForceOrMoment)
{
  // About the node itself: forces −∂E/∂e, ∂E/∂e − ∂E/∂g, ∂E/∂g at −e, 0, g; a straight wire's energy has no frame.
  const CurvatureBinormal kb(e, g, rest);
  const Eigen::Vector3d by_before = kb.transposeBefore(kb.value);
  const Eigen::Vector3d by_after = kb.transposeAfter(kb.value);
  EXPECT_LT((e.cross(by_before) + g.cross(by_after)).norm(), 1e-14);
}

}  // namespace
}  // namespace endovascular_sim::rod
