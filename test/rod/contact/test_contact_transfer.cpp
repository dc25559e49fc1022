#include "rod/contact/contact_transfer.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

class TransferOfAWire : public testing::Test
{
protected:
  static Discretisation withNodes(int nodes)
  {
    return discretiseUniformly(uniformWire(0.1, 5e-5, 2e-4, 7900.0), nodes);
  }

  static ContactList contactAt(int edge, double parameter, double gap)
  {
    ContactList contacts;
    contact::Feature feature;
    feature.edge = edge;
    feature.parameter = parameter;
    feature.normal = Eigen::Vector3d::UnitZ();
    feature.gap = gap;
    feature.id = 12;
    contacts.set.features.push_back(feature);
    return contacts;
  }

  State stateOfFreshNode(int node) const
  {
    State state;
    state.wall_offset.assign(static_cast<std::size_t>(rod_.nodes()), 0.0);
    state.wall_offset[node] = std::numeric_limits<double>::quiet_NaN();
    return state;
  }

  const Discretisation rod_ = withNodes(21);
  const StepperSettings settings_{};
  ContactTransfer transfer_{rod_};
  ContactSprings springs_{rod_, settings_};
};

TEST_F(TransferOfAWire, MovesFeaturesToTheSamePositionAlongTheWire)
{
  const Discretisation fine = withNodes(41);
  std::vector<contact::Feature> features = contactAt(7, 0.75, 0.0).set.features;
  transfer_.moveFeatures(fine, NodeRenumbering(rod_, fine, 0), features);
  EXPECT_EQ(features[0].edge, 15);
  EXPECT_NEAR(features[0].parameter, 0.5, 1e-9);
}

TEST_F(TransferOfAWire, MovesFeaturesWithTheirEdgesWhereNodesAreOnlyAdded)
{
  Discretisation longer = rod_;
  longer.position.insert(longer.position.begin(), 2, -1.0);
  std::vector<contact::Feature> features = contactAt(7, 0.75, 0.0).set.features;
  transfer_.moveFeatures(longer, NodeRenumbering(rod_, longer, 0), features);
  EXPECT_EQ(features[0].edge, 9);
  EXPECT_EQ(features[0].parameter, 0.75);
}

TEST_F(TransferOfAWire, OffsetsTheWallAtAFreshNodeSoThatAContactKeepsItsForce)
{
  ContactList before = contactAt(7, 0.0, -1e-6);
  before.springs.push_back(springs_.springOf(before.set.features, 0));
  before.springs[0].force = 0.3;
  transfer_.storeForces(before);
  State state = stateOfFreshNode(7);
  transfer_.settle(contactAt(7, 0.0, -20e-6), springs_, state);
  // Force = stiffness × −(gap + offset).
  EXPECT_NEAR(settings_.contact_stiffness * (20e-6 - state.wall_offset[7]), 0.3, 1e-6);
}

TEST_F(TransferOfAWire, OffsetsTheWallSoThatANewContactAtAFreshNodeHasNoForce)
{
  State state = stateOfFreshNode(7);
  transfer_.settle(contactAt(7, 0.0, -20e-6), springs_, state);
  EXPECT_NEAR(state.wall_offset[7], 20e-6, 1e-12);
  state = stateOfFreshNode(7);
  transfer_.settle(contactAt(7, 0.0, 20e-6), springs_, state);
  EXPECT_EQ(state.wall_offset[7], 0.0);
}

TEST_F(TransferOfAWire, BoundsTheOffsetAndDoesNotChangeOldNodes)
{
  State state = stateOfFreshNode(7);
  transfer_.settle(contactAt(7, 0.5, -200e-6), springs_, state);
  EXPECT_NEAR(state.wall_offset[7], 50e-6, 1e-12);
  EXPECT_EQ(state.wall_offset[8], 0.0);
  state.wall_offset[7] = 0.0;
  transfer_.settle(contactAt(7, 0.0, -20e-6), springs_, state);
  EXPECT_EQ(state.wall_offset[7], 0.0);
}

}  // namespace
}  // namespace endovascular_sim::rod
