#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

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

/** Largest force per length that remains at a node with the shifts of a solution [N/m].
 *  @param before the nodes before the solution */
double imbalance(const std::vector<BoreNode>& before, const std::vector<BoreNode>& nodes,
                 const std::vector<double>& load)
{
  constexpr double kRestoring = 2e3;  // N/m², of bore_contact.cpp
  const std::size_t last = nodes.size() - 2;
  std::vector<Vector2d> force(nodes.size(), Vector2d::Zero());
  for (std::size_t i = 1; i <= last + 1; ++i)
  {
    const Vector2d moment = nodes[i].moment + nodes[i].stiffness * BoreContact::bend(nodes, i);
    force[i - 1] -= moment / nodes[i - 1].edge;
    force[i] += moment / nodes[i - 1].edge;
    if (i > last)
      continue;
    force[i] += moment / nodes[i].edge;
    force[i + 1] -= moment / nodes[i].edge;
  }
  double largest = 0.0;
  for (std::size_t i = 2; i <= last; ++i)
  {
    const double tension = 0.5 * (nodes[i - 1].tension + nodes[i].tension);
    force[i] += tension * nodes[i].cell * nodes[i].curvature;
    force[i] -= kRestoring * nodes[i].cell * (nodes[i].shift - before[i].shift);
    const auto pull = [&](std::size_t edge) -> Vector2d
    {
      const double tension = std::max(0.0, nodes[edge].tension);  // compression has no part
      return tension / nodes[edge].edge * (nodes[edge + 1].shift - nodes[edge].shift);
    };
    force[i] += (i < last ? pull(i) : Vector2d::Zero().eval()) - pull(i - 1);
    force[i] -= load[i] * nodes[i].cell * nodes[i].shift.normalized();
    largest = std::max(largest, force[i].norm() / nodes[i].cell);
  }
  return largest;
}

/** Wire of random stiffness, tension, clearance and bends, with shifts that belong to none of them. */
std::vector<BoreNode> randomNodes(std::mt19937_64& engine)
{
  const auto between = [&engine](double low, double high)
  { return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1.0p-53; };
  std::vector<BoreNode> nodes(static_cast<std::size_t>(between(60, 260)));
  double edge = 1e-3;
  double stiffness = 1e-5;
  double tension = 0.0;
  double clearance = 3e-4;
  Vector2d curvature = Vector2d::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    if (i % 20 == 0)
    {
      edge = between(0.25e-3, 4e-3);
      stiffness = 1.6e-6 * std::pow(100.0, between(0.0, 1.0));
      tension = between(-0.1, 1.0);
      clearance = between(1e-4, 8e-4);
      curvature = Vector2d(between(-60.0, 60.0), between(-60.0, 60.0));
    }
    const double angle = between(0.0, 6.28);
    const Vector2d shift = between(0.0, 1.0) * clearance * Vector2d(std::cos(angle), std::sin(angle));
    const Vector2d moment = stiffness * between(0.7, 1.0) * curvature;
    nodes[i] = {edge, edge, stiffness, clearance, 1.0, tension, curvature, moment, shift};
  }
  nodes.back().shift.setZero();
  return nodes;
}

TEST(BoreContact, TheSolutionIsInEquilibriumFromAnyShiftsAtTheBeginning)
{
  std::mt19937_64 engine(5);
  for (int k = 0; k < 300; ++k)
  {
    const std::vector<BoreNode> before = randomNodes(engine);
    std::vector<BoreNode> nodes = before;
    BoreContact bore;
    bore.solve(nodes);
    EXPECT_LT(imbalance(before, nodes, bore.load()), 0.5) << k;  // N/m; the loads reach several 100 N/m
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
