#include "benchmark/reference/twist_of_centreline.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr int kNodes = 7;
constexpr double kStep = 1e-5;
using Chain = std::vector<Eigen::Vector3d>;

Chain bentChain()
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-0.35, 0.35);
  Chain x;
  for (int i = 0; i < kNodes; ++i)
    x.emplace_back(i + uniform(random), uniform(random), uniform(random));
  return x;
}

/** Twist of a wire whose end edges are held: angle from the first director, transported along the wire, to a fixed
 *  director at the last edge. */
double heldTwist(const Chain& x)
{
  const Eigen::Vector3d last = (x[kNodes - 1] - x[kNodes - 2]).normalized();
  Eigen::Vector3d tangent = (x[1] - x[0]).normalized();
  Eigen::Vector3d director = tangent.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d held = last.cross(Eigen::Vector3d::UnitY()).normalized();
  for (int i = 1; i + 1 < kNodes; ++i)
  {
    const Eigen::Vector3d next = (x[i + 1] - x[i]).normalized();
    director = parallelTransport(director, tangent, next);
    tangent = next;
  }
  return std::atan2(director.cross(held).dot(tangent), director.dot(held));
}

/** Sum of ∂m/∂x over all nodes by TwistOfCentreline. */
Chain twistGradient(const Chain& x)
{
  Chain gradient(kNodes, Eigen::Vector3d::Zero());
  for (int i = 1; i + 1 < kNodes; ++i)
  {
    const TwistOfCentreline twist(x[i] - x[i - 1], x[i + 1] - x[i]);
    gradient[i - 1] -= twist.by_before;
    gradient[i] += twist.by_before - twist.by_after;
    gradient[i + 1] += twist.by_after;
  }
  return gradient;
}

/** Block (row, col) of the summed second derivatives. */
Eigen::Matrix3d twistHessianBlock(const Chain& x, int row, int col)
{
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 1; i + 1 < kNodes; ++i)
  {
    const TwistOfCentreline twist(x[i] - x[i - 1], x[i + 1] - x[i]);
    // Share of a node in the edges before and after node i.
    const auto before = [i](int node) { return node == i ? 1.0 : (node == i - 1 ? -1.0 : 0.0); };
    const auto after = [i](int node) { return node == i + 1 ? 1.0 : (node == i ? -1.0 : 0.0); };
    sum += before(row) * before(col) * twist.before_before + after(row) * after(col) * twist.after_after +
           before(row) * after(col) * twist.before_after + after(row) * before(col) * twist.before_after.transpose();
  }
  return sum;
}

TEST(TwistOfCentreline, GradientByTheCentrelineIsTheDerivativeOfTheTwistOfAHeldWire)
{
  const Chain x = bentChain();
  const Chain gradient = twistGradient(x);
  for (int i = 2; i + 2 < kNodes; ++i)
    for (int axis = 0; axis < 3; ++axis)
    {
      Chain up = x;
      Chain down = x;
      up[i][axis] += kStep;
      down[i][axis] -= kStep;
      EXPECT_NEAR((heldTwist(up) - heldTwist(down)) / (2.0 * kStep), gradient[i][axis], 1e-9);
    }
}

TEST(TwistOfCentreline, HessianOfTheHolonomyEqualsFiniteDifferencesOfItsGradient)
{
  const Chain x = bentChain();
  for (int col = 2; col + 2 < kNodes; ++col)
    for (int axis = 0; axis < 3; ++axis)
    {
      Chain up = x;
      Chain down = x;
      up[col][axis] += kStep;
      down[col][axis] -= kStep;
      const Chain above = twistGradient(up);
      const Chain below = twistGradient(down);
      for (int row = 2; row + 2 < kNodes; ++row)
        EXPECT_LT(((above[row] - below[row]) / (2.0 * kStep) - twistHessianBlock(x, row, col).col(axis)).norm(), 1e-8);
    }
}

TEST(TwistOfCentreline, TransportKeepsLengthsAndAngles)
{
  const Eigen::Vector3d t = Eigen::Vector3d(1.0, 0.4, -0.2).normalized();
  const Eigen::Vector3d u = Eigen::Vector3d(0.3, 1.0, 0.5).normalized();
  const Eigen::Vector3d v(0.2, -0.7, 0.4);
  EXPECT_LT((parallelTransport(t, t, u) - u).norm(), 1e-15);
  EXPECT_NEAR(parallelTransport(v, t, u).norm(), v.norm(), 1e-15);
  EXPECT_NEAR(parallelTransport(v, t, u).dot(u), v.dot(t), 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
