#include "visualization/wire_refinement.h"

#include <gtest/gtest.h>

#include <cmath>

namespace endovascular_sim::visualization
{
namespace
{

constexpr double kRadius = 0.02;  // of an arc [m]

/** Quarter of a circle about the origin, in nodes of equal angle. */
WireState quarterCircle(int nodes)
{
  WireState state;
  for (int i = 0; i < nodes; ++i)
  {
    const double angle = 0.5 * M_PI * i / (nodes - 1);
    state.nodes.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), 0.0);
    state.radii.push_back(1e-3 * i);
    state.forces.push_back(0.1 * i);
  }
  state.insertions = {0.03};
  return state;
}

double largestTurn(const std::vector<Eigen::Vector3d>& points)
{
  double largest = 0.0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    largest = std::max(
        largest, std::acos((points[i] - points[i - 1]).normalized().dot((points[i + 1] - points[i]).normalized())));
  return largest;
}

TEST(WireRefinement, OfAnArcLiesOnItAndTurnsByLessThanTheLimit)
{
  const WireState state = quarterCircle(7);
  WireState refined;
  refineWire(state, 0.06, refined);
  ASSERT_EQ(refined.nodes.size(), refined.radii.size());
  ASSERT_EQ(refined.nodes.size(), refined.forces.size());
  EXPECT_EQ(refined.insertions, state.insertions);
  EXPECT_GT(largestTurn(state.nodes), 0.25);
  EXPECT_LT(largestTurn(refined.nodes), 0.07);
  for (std::size_t i = 0; i < refined.nodes.size(); ++i)
  {
    EXPECT_NEAR(refined.nodes[i].norm(), kRadius, 5e-6) << "the sagitta of a segment is 0.17 mm";
    EXPECT_NEAR(refined.forces[i], 100.0 * refined.radii[i], 1e-12);
  }
}

TEST(WireRefinement, ConvergesToTheArc)
{
  double last = 1.0;
  for (const int nodes : {5, 9, 17})
  {
    WireState refined;
    refineWire(quarterCircle(nodes), 0.01, refined);
    double error = 0.0;
    for (const Eigen::Vector3d& node : refined.nodes)
      error = std::max(error, std::abs(node.norm() - kRadius));
    EXPECT_LT(error, last / 6.0) << nodes;  // at least third order
    last = error;
  }
}

TEST(WireRefinement, KeepsAStraightWireAndAllNodes)
{
  WireState straight;
  for (int i = 0; i < 4; ++i)
  {
    straight.nodes.emplace_back(0.0, 0.0, 0.01 * i);
    straight.radii.push_back(1e-3);
  }
  WireState refined;
  refineWire(straight, 0.06, refined);
  EXPECT_EQ(refined.nodes, straight.nodes);
  EXPECT_TRUE(refined.forces.empty());
}

TEST(WireRefinement, AcceptsCoincidingNodesAndKinks)
{
  WireState state = quarterCircle(4);
  state.nodes[2] = state.nodes[1];
  state.nodes[3] = state.nodes[0];  // back
  WireState refined;
  refineWire(state, 0.06, refined);
  for (const Eigen::Vector3d& node : refined.nodes)
    EXPECT_TRUE(node.allFinite());
}

}  // namespace
}  // namespace endovascular_sim::visualization
