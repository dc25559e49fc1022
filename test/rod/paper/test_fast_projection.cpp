#include "rod/paper/fast_projection.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr int kNodes = 12;

class FastProjectionTest : public testing::Test
{
protected:
  void SetUp() override
  {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < kNodes; ++i)
    {
      // Braces: the order of the random numbers is that of the list, with every compiler.
      x.push_back({0.01 * i + 0.001 * uniform(random), 0.002 * uniform(random), 0.002 * uniform(random)});
      inverse_mass.push_back((1.5 + uniform(random)) / rod.mass[i]);
    }
  }

  double strain(int edge) const { return (x[edge + 1] - x[edge]).norm() / rod.rest_length[edge] - 1.0; }

  Discretisation rod = discretiseUniformly(uniformWire(0.11, 1e-4, 2e-4, 8000.0), kNodes);
  std::vector<double> inverse_mass;
  std::vector<Eigen::Vector3d> x;
  FastProjection projection;
};

TEST_F(FastProjectionTest, RestoresTheLengthOfEveryEdgeAndKeepsTheCentreOfMass)
{
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int i = 0; i < kNodes; ++i)
    moment += x[i] / inverse_mass[i];
  ASSERT_TRUE(projection.project(rod, 0, inverse_mass, 1e-12, x));
  EXPECT_LT(projection.iterations(), 8);
  for (int j = 0; j + 1 < kNodes; ++j)
    EXPECT_NEAR(strain(j), 0.0, 1e-12);
  for (int i = 0; i < kNodes; ++i)
    moment -= x[i] / inverse_mass[i];
  EXPECT_LT(moment.norm(), 1e-16);
}

TEST_F(FastProjectionTest, KeepsHeldNodesAndTheEdgesBetweenThem)
{
  inverse_mass[0] = inverse_mass[1] = inverse_mass[kNodes - 1] = 0.0;
  // The held nodes are closer than the length of the edges between them, whatever the random numbers: a solution
  // exists.
  x[kNodes - 1].x() -= 3e-3;
  const std::vector<Eigen::Vector3d> before = x;
  const double held_strain = strain(0);
  ASSERT_TRUE(projection.project(rod, 0, inverse_mass, 1e-10, x));
  EXPECT_EQ(x[0], before[0]);
  EXPECT_EQ(x[1], before[1]);
  EXPECT_EQ(x[kNodes - 1], before[kNodes - 1]);
  EXPECT_EQ(strain(0), held_strain);
  for (int j = 1; j + 1 < kNodes; ++j)
    EXPECT_NEAR(strain(j), 0.0, 1e-10);
}

TEST_F(FastProjectionTest, OneIterationIsTheDenseSolutionOfEquation12)
{
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(kNodes - 1, 3 * kNodes);
  Eigen::VectorXd constraint(kNodes - 1);
  Eigen::VectorXd weight(3 * kNodes);
  for (int i = 0; i < kNodes; ++i)
    weight.segment<3>(3 * i).setConstant(inverse_mass[i]);
  for (int j = 0; j + 1 < kNodes; ++j)
  {
    const Eigen::Vector3d e = x[j + 1] - x[j];
    jacobian.block<1, 3>(j, 3 * j) = -2.0 * e.transpose();
    jacobian.block<1, 3>(j, 3 * j + 3) = 2.0 * e.transpose();
    constraint[j] = e.squaredNorm() - rod.rest_length[j] * rod.rest_length[j];
  }
  const Eigen::MatrixXd matrix = jacobian * weight.asDiagonal() * jacobian.transpose();
  const Eigen::VectorXd move = -(weight.asDiagonal() * jacobian.transpose() * matrix.fullPivLu().solve(constraint));
  std::vector<Eigen::Vector3d> projected = x;
  projection.project(rod, 0, inverse_mass, 1e9, projected);
  ASSERT_EQ(projection.iterations(), 1);
  for (int i = 0; i < kNodes; ++i)
    EXPECT_LT((projected[i] - x[i] - move.segment<3>(3 * i)).norm(), 1e-15);
}

TEST_F(FastProjectionTest, ReportsEdgesWhoseLengthsCannotBeRestored)
{
  inverse_mass[0] = inverse_mass[kNodes - 1] = 0.0;
  x[kNodes - 1] = x[0] + Eigen::Vector3d(0.2, 0.0, 0.0);
  EXPECT_FALSE(projection.project(rod, 0, inverse_mass, 1e-6, x));
  x[4].x() = std::nan("");
  EXPECT_FALSE(projection.project(rod, 0, inverse_mass, 1e-6, x));
}

}  // namespace
}  // namespace endovascular_sim::rod
