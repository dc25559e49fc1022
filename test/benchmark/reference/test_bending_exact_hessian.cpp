#include "benchmark/reference/bending_exact_hessian.h"

#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

Eigen::Vector3d randomVector(std::mt19937& random)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return {uniform(random), uniform(random), uniform(random)};
}

class BendingExactHessianTest : public testing::Test
{
protected:
  void SetUp() override
  {
    e = Eigen::Vector3d(1.0, 0.2, 0.1) + 0.3 * randomVector(random);
    g = Eigen::Vector3d(0.9, -0.3, 0.2) + 0.3 * randomVector(random);
  }

  std::mt19937 random{4};
  Eigen::Vector3d e, g;
  double rest = 0.8;
};

TEST_F(BendingExactHessianTest, GradientWithRestCurvatureIsTheDerivativeOfTheEnergy)
{
  const Eigen::Vector3d rest_binormal = 0.4 * randomVector(random);
  const double weight = 1.3;
  constexpr double kStep = 1e-6;
  const auto energy = [&](const Eigen::Vector3d& before, const Eigen::Vector3d& after)
  { return bendingEnergy(rod::CurvatureBinormal(before, after, rest), rest_binormal, weight); };
  const rod::CurvatureBinormal kb(e, g, rest);
  const Eigen::Vector3d by_before = weight * kb.transposeBefore(kb.value - rest_binormal);
  const Eigen::Vector3d by_after = weight * kb.transposeAfter(kb.value - rest_binormal);
  for (int axis = 0; axis < 3; ++axis)
  {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    EXPECT_NEAR((energy(e + step, g) - energy(e - step, g)) / (2.0 * kStep), by_before[axis], 1e-8);
    EXPECT_NEAR((energy(e, g + step) - energy(e, g - step)) / (2.0 * kStep), by_after[axis], 1e-8);
  }
}

TEST_F(BendingExactHessianTest, EqualsFiniteDifferencesOfTheGradientWithRestCurvature)
{
  constexpr double kStep = 1e-6;
  constexpr double kScale = 1.7;
  for (int sample = 0; sample < 20; ++sample)
  {
    SetUp();
    const Eigen::Vector3d rest_binormal = 0.4 * randomVector(random);
    const auto before = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b)
    {
      const rod::CurvatureBinormal kb(a, b, rest);
      return Eigen::Vector3d(kScale * kb.transposeBefore(kb.value - rest_binormal));
    };
    const auto after = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b)
    {
      const rod::CurvatureBinormal kb(a, b, rest);
      return Eigen::Vector3d(kScale * kb.transposeAfter(kb.value - rest_binormal));
    };
    const BendingExactHessian hessian(rod::CurvatureBinormal(e, g, rest), rest_binormal, kScale);
    for (int axis = 0; axis < 3; ++axis)
    {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const double inverse = 0.5 / kStep;
      EXPECT_LT((inverse * (before(e + step, g) - before(e - step, g)) - hessian.before_before.col(axis)).norm(), 1e-7);
      EXPECT_LT((inverse * (before(e, g + step) - before(e, g - step)) - hessian.before_after.col(axis)).norm(), 1e-7);
      EXPECT_LT((inverse * (after(e, g + step) - after(e, g - step)) - hessian.after_after.col(axis)).norm(), 1e-7);
    }
  }
}

TEST_F(BendingExactHessianTest, EqualsTheGaussNewtonBlocksForZeroStrain)
{
  const rod::CurvatureBinormal kb(e, g, rest);
  const rod::BendingHessian gauss_newton(kb, 1.0);
  const BendingExactHessian exact(kb, kb.value, 1.0);
  EXPECT_LT((gauss_newton.before_before - exact.before_before).norm(), 1e-14);
  EXPECT_LT((gauss_newton.before_after - exact.before_after).norm(), 1e-14);
  EXPECT_LT((gauss_newton.after_after - exact.after_after).norm(), 1e-14);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
