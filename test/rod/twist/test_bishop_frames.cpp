#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "rod/twist/bishop_frames.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

/** Straight along x, then an arc in a plane that is turned about x. */
State arc(const Discretisation& rod, int straight_edges, double edge_turn, double turn)
{
  State state;
  const Eigen::AngleAxisd about_x(turn, Eigen::Vector3d::UnitX());
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  state.position.push_back(position);
  for (int j = 0; j + 1 < rod.nodes(); ++j)
  {
    const double angle = edge_turn * std::max(0, j - straight_edges + 1);
    position += rod.rest_length[j] * (about_x * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
    state.position.push_back(position);
  }
  return state;
}

// An edge at an angle α to the handle's axis turns about its tangent by φ cos α only. Its Bishop frame, which is
// transported from the hold, turns by −φ (1 − cos α) against an edge that follows without turning.
TEST(FrameTurns, OfATipThatRotatesWithTheHandleAreMinusPhiTimesOneMinusTheCosine)
{
  const Discretisation rod = discretiseUniformly(uniformWire(0.03, 1e-4, 4e-4, 7000.0), 31);
  TwistBoundary boundary;
  const double edge_turn = 0.15;
  const int straight = 12;
  FrameTurns turns;
  turns.begin(rod, boundary, arc(rod, straight, edge_turn, 0.2), straight);
  for (const double phi : {1e-3, 0.02, -0.4})
  {
    const std::vector<double> found = turns.since(rod, boundary, arc(rod, straight, edge_turn, 0.2 + phi));
    ASSERT_EQ(found.size(), rod.rest_length.size());
    for (int j = straight; j + 1 < rod.nodes(); ++j)
    {
      const double alpha = edge_turn * (j - straight + 1);
      // Exact for small turns: a finite turn follows the shortest way.
      EXPECT_NEAR(found[j], -phi * (1.0 - std::cos(alpha)), 0.3 * std::pow(std::abs(phi), 3) + 1e-12) << j;
    }
    EXPECT_EQ(found[2], 0.0);
  }
}

TEST(FrameTurns, AreEmptyWhereTheyAreNeglected)
{
  const Discretisation rod = discretiseUniformly(uniformWire(0.03, 1e-4, 4e-4, 7000.0), 31);
  FrameTurns turns;
  turns.begin(rod, TwistBoundary(), arc(rod, 12, 0.1, 0.0), 12);
  turns.neglect();
  EXPECT_TRUE(turns.since(rod, TwistBoundary(), arc(rod, 12, 0.1, 0.1)).empty());
}

}  // namespace
}  // namespace endovascular_sim::rod
