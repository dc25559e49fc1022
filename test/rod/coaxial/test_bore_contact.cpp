#include <gtest/gtest.h>

#include <cmath>

#include "rod/coaxial/bore_contact.h"

// Wire in a bore around a given centreline.

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector2d;

constexpr double kEdge = 1e-3;
constexpr double kStiffness = 4e-5;

/** Nodes whose wire is as bent as the centreline. */
std::vector<BoreNode> nodesOf(int count, double tension, double clearance)
{
  std::vector<BoreNode> nodes(static_cast<std::size_t>(count));
  for (BoreNode& node : nodes)
  {
    node.cell = node.edge = kEdge;
    node.stiffness = kStiffness;
    node.clearance = clearance;
    node.wall = 1.0;
    node.tension = tension;
  }
  return nodes;
}

void bendCentreline(std::vector<BoreNode>& nodes, std::size_t begin, std::size_t end, const Vector2d& curvature)
{
  for (std::size_t i = begin; i < end; ++i)
  {
    nodes[i].curvature = curvature;
    nodes[i].moment = kStiffness * curvature;
  }
}

double sumOf(const std::vector<double>& load)
{
  double sum = 0.0;
  for (const double value : load)
    sum += value * kEdge;
  return sum;
}

TEST(BoreContact, AWireUnderTensionBearsOnTheInnerSideOfABendWithTensionTimesCurvature)
{
  std::vector<BoreNode> nodes = nodesOf(120, 0.5, 3e-4);
  const Vector2d curvature(0.0, 1.0 / 0.03);
  bendCentreline(nodes, 30, 90, curvature);
  BoreContact bore;
  for (int k = 0; k < 20; ++k)
    bore.solve(nodes);
  EXPECT_NEAR(bore.load()[60], 0.5 / 0.03, 0.01 * 0.5 / 0.03);
  EXPECT_GT(nodes[60].shift.y(), 3e-4);
  EXPECT_NEAR(nodes[60].shift.x(), 0.0, 1e-12);
}

TEST(BoreContact, AWireWithoutTensionBearsOnTheInnerSideInsideABendAndOnTheOuterSideBeforeIt)
{
  std::vector<BoreNode> nodes = nodesOf(160, 0.0, 3e-4);
  bendCentreline(nodes, 60, 100, Vector2d(0.0, 1.0 / 0.03));
  BoreContact bore;
  for (int k = 0; k < 200; ++k)
    bore.solve(nodes);
  double inside = 0.0;
  double before = 0.0;
  for (std::size_t i = 60; i < 100; ++i)
    inside = std::max(inside, nodes[i].shift.y());
  for (std::size_t i = 2; i < 60; ++i)
    before = std::min(before, nodes[i].shift.y());
  EXPECT_GT(inside, 3e-4);   // towards the centre of the bend
  EXPECT_LT(before, -3e-4);  // away from it
  EXPECT_GT(sumOf(bore.load()), 0.0);
}

/** Cantilever from the first two nodes with a lateral force of tension and curvature at its end, within the bore. */
TEST(BoreContact, AWireThatTouchesNothingBendsAsACantilever)
{
  constexpr int kNodes = 42;
  constexpr double kForce = 1e-3;
  std::vector<BoreNode> nodes = nodesOf(kNodes, 0.0, 1.0);
  nodes[kNodes - 2].tension = 1.0;  // beyond the last node: half of it acts at this node
  nodes[kNodes - 2].curvature = Vector2d(kForce / (0.5 * kEdge), 0.0);
  BoreContact bore;
  for (int k = 0; k < 3000; ++k)
    bore.solve(nodes);
  // The clamp acts in the middle of the edge between the held nodes.
  const double length = (kNodes - 2 - 0.5) * kEdge;
  EXPECT_NEAR(nodes[kNodes - 2].shift.x(), kForce * std::pow(length, 3) / (3.0 * kStiffness),
              1e-2 * kForce * std::pow(length, 3) / (3.0 * kStiffness));
  EXPECT_EQ(sumOf(bore.load()), 0.0);
}

TEST(BoreContact, TheForcesOfTheBoreBalanceThoseOfTheWire)
{
  std::vector<BoreNode> nodes = nodesOf(140, 0.3, 2e-4);
  bendCentreline(nodes, 50, 90, Vector2d(10.0, 1.0 / 0.04));
  BoreContact bore;
  for (int k = 0; k < 500; ++k)
    bore.solve(nodes);
  // Every node away from the ends: (M + B u″)″ − T (κ + u″) and the wall, which pushes back to the centreline.
  const auto moment = [&](std::size_t i) -> Vector2d
  { return nodes[i].moment + kStiffness * BoreContact::bend(nodes, i); };
  double largest = 0.0;
  for (std::size_t i = 4; i + 4 < nodes.size(); ++i)
  {
    Vector2d force = (2.0 * moment(i) - moment(i - 1) - moment(i + 1)) / (kEdge * kEdge) +
                     0.3 * (nodes[i].curvature + BoreContact::bend(nodes, i));
    if (bore.load()[i] > 0.0)
      force -= bore.load()[i] * nodes[i].shift.normalized();
    largest = std::max(largest, force.norm());
  }
  EXPECT_LT(largest, 0.02);  // N/m; the loads reach several 10 N/m
}

TEST(BoreContact, ASmallChangeOfTheTensionChangesTheLoadsLittle)
{
  double before = 0.0;
  for (int step = 0; step <= 40; ++step)
  {
    std::vector<BoreNode> nodes = nodesOf(120, 0.01 * step, 3e-4);
    bendCentreline(nodes, 30, 90, Vector2d(0.0, 1.0 / 0.03));
    BoreContact bore;
    for (int k = 0; k < 100; ++k)
      bore.solve(nodes);
    const double sum = sumOf(bore.load());
    if (step > 0)
    {
      EXPECT_LT(std::abs(sum - before), 0.03) << step;  // N: T times the angle of 2 rad changes by 0.02 N
    }
    before = sum;
  }
}

TEST(BoreContact, TheSolutionConvergesInAFewIterations)
{
  std::vector<BoreNode> nodes = nodesOf(200, 0.4, 3e-4);
  bendCentreline(nodes, 60, 120, Vector2d(0.0, 1.0 / 0.03));
  BoreContact bore;
  bore.solve(nodes);
  for (int k = 0; k < 5; ++k)
    bore.solve(nodes);
  EXPECT_LE(bore.iterations(), 4);
}

}  // namespace
}  // namespace endovascular_sim::rod
