#include "rod/boundary/boundary_conditions.h"

#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

class BoundaryConditionsInAnIntroducer : public testing::Test
{
protected:
  Discretisation rod = discretiseUniformly(uniformWire(0.1, 1e-4, 2e-4, 8000.0), 51);
  Boundary boundary;
};

TEST_F(BoundaryConditionsInAnIntroducer, SimulatesTwoPrescribedNodesAndAllBeyondThem)
{
  const BoundaryConditions held(rod, boundary);
  const State state = held.initialState(0.03, 0.2);
  EXPECT_TRUE(held.isPrescribed(state.first_node, state));
  EXPECT_TRUE(held.isPrescribed(state.first_node + 1, state));
  EXPECT_FALSE(held.isPrescribed(state.first_node + 2, state));
  EXPECT_NEAR(state.position.back().x(), 0.03, 1e-15);
  EXPECT_EQ(state.twist_angle.back(), 0.2);
}

TEST_F(BoundaryConditionsInAnIntroducer, AddsNodesAtTheHandlesSpeedWhileTheWireIsPushedAndRemovesThemAgain)
{
  const BoundaryConditions held(rod, boundary);
  State state = held.initialState(0.03, 0.0);
  const int first = state.first_node;
  held.placePrescribedNodes(state, 0.036, 0.1);
  EXPECT_EQ(state.first_node, first - 3);
  for (int i = state.first_node; i < first; ++i)
  {
    EXPECT_NEAR(state.position[i].x(), held.bodyPosition(i, 0.036), 1e-15);
    EXPECT_NEAR(state.velocity[i].x(), 0.06, 1e-12);
  }
  held.placePrescribedNodes(state, 0.03, 0.1);
  EXPECT_EQ(state.first_node, first);
  EXPECT_NEAR(state.velocity[first].x(), -0.06, 1e-12);
}

TEST_F(BoundaryConditionsInAnIntroducer, QueriesContactsBeyondTheMouthOnly)
{
  const BoundaryConditions held(rod, boundary);
  const State state = held.initialState(0.03, 0.0);
  contact::Query query;
  held.describe(state, query);
  EXPECT_GE(held.bodyPosition(query.first_node, 0.03), 0.0);
  EXPECT_LT(held.bodyPosition(query.first_node - 1, 0.03), 0.0);
  EXPECT_EQ(query.nodes.size(), static_cast<std::size_t>(rod.nodes() - query.first_node));
  EXPECT_EQ(query.nodes.back(), state.position.back());
}

TEST(BoundaryConditionsOnABench, PrescribesTheNodesOfItsEnds)
{
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, 1e-4, 2e-4, 8000.0), 11);
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = EndHold::kClamped;
  boundary.distal = EndHold::kPinned;
  const BoundaryConditions held(rod, boundary);
  const State state = held.initialState(0.0, 0.0);
  EXPECT_EQ(state.first_node, 0);
  for (int i = 0; i < 11; ++i)
    EXPECT_EQ(held.isPrescribed(i, state), i < 2 || i == 10) << i;
}

TEST(BoundaryConditionsOnABench, EnergyOfAnArcIsItsCurvatureSquared)
{
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, 1e-4, 2e-4, 8000.0), 101);
  Boundary boundary;
  boundary.introducer = false;
  State state = BoundaryConditions(rod, boundary).initialState(0.0, 0.0);
  const double radius = 0.05;
  for (int i = 0; i < 101; ++i)
    state.position[i] = radius * Eigen::Vector3d(std::sin(1e-3 * i / radius), 1.0 - std::cos(1e-3 * i / radius), 0.0);
  const Energy energy = elasticEnergy(rod, state, nullptr);
  EXPECT_NEAR(energy.bending, 0.5 * 1e-4 / (radius * radius) * 0.099, 1e-3 * energy.bending);
  EXPECT_EQ(energy.twist, 0.0);
}

}  // namespace
}  // namespace endovascular_sim::rod
