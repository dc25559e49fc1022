#include "rod/contact/contact_springs.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "rod/kkt/kkt_stepper.h"
#include "test/rod/ridge_wall.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kEi = 4.9469e-5;
constexpr double kRadius = 1.8e-4;

/** Penetration depth at the ridge of a stiff wire that is pressed on a compliant roof over its whole length [m]. */
double indentation(int nodes, double ridge, double load)
{
  constexpr double kLength = 0.1;
  constexpr double kStiffness = 1e4;  // N/m²
  Boundary boundary;
  boundary.introducer = false;
  boundary.origin = Vector3d(0.0, 0.0, kRadius);
  Environment environment;
  environment.damping = 100.0;
  KktStepper stepper(discretiseUniformly(uniformWire(kLength, 1.0, kRadius, 7900.0), nodes), boundary, environment,
                     StepperSettings());
  RidgeWall wall(ridge, 1e-3, kStiffness);
  State state = stepper.initialState(0.0, 0.0);
  PhaseTimer timer;
  StepInput input;
  for (int i = 0; i < nodes; ++i)
    input.forces.push_back({i, Vector3d(0.0, 0.0, -load * stepper.discretisation().cell_length[i] / kLength)});
  for (int k = 0; k < 500; ++k)
  {
    input.step = static_cast<std::uint64_t>(k);
    std::uint32_t pass = 0;
    EXPECT_TRUE(stepper.step(state, input, 1e-3, pass, &wall, timer).solved);
  }
  double depth = 0.0;
  for (int i = 0; i + 1 < nodes; ++i)
  {
    const double t = (ridge - state.position[i].x()) / (state.position[i + 1].x() - state.position[i].x());
    if (t >= 0.0 && t <= 1.0)
      depth = kRadius - ((1.0 - t) * state.position[i].z() + t * state.position[i + 1].z());
  }
  return depth;
}

TEST(ContactSprings, OfACompliantRidgeYieldTheSameDepthForAnySampling)
{
  // A rigid wire in contact over its whole length: F = k ∫(depth − slope·|x|) dx about a ridge in its middle.
  constexpr double kLoad = 0.05;  // within the travel of the soft wall
  const double expected = kLoad / (1e4 * 0.1) + 1e-3 * 0.1 / 4.0;
  for (const int nodes : {20, 40, 80})
    EXPECT_NEAR(indentation(nodes, 0.05, kLoad), expected, 2e-3 * expected) << nodes;
  // The ridge crosses an edge at its middle, near its end, or at a node.
  const double off_centre = indentation(80, 0.0531, kLoad);
  for (const int nodes : {20, 21, 40, 41})
    EXPECT_NEAR(indentation(nodes, 0.0531, kLoad), off_centre, 1e-2 * off_centre) << nodes;
}

TEST(ContactSprings, HaveAContinuousForceWhereARidgePassesANode)
{
  const double ridge_at_node = 0.1 * 20 / 40;  // position of a node [m]
  const double before = indentation(41, ridge_at_node - 1e-7, 0.1);
  EXPECT_NEAR(indentation(41, ridge_at_node, 0.1), before, 1e-4 * before);
  EXPECT_NEAR(indentation(41, ridge_at_node + 1e-7, 0.1), before, 1e-4 * before);
}

/** Springs of a straight wire of 20 edges. */
class SpringsOfAWire : public testing::Test
{
protected:
  static constexpr int kNodes = 21;
  static constexpr double kEdge = 0.1 / (kNodes - 1);
  static constexpr double kWallStiffness = 1e4;  // N/m²

  SpringsOfAWire()
  {
    state_.position.assign(kNodes, Vector3d::Zero());
    state_.velocity.assign(kNodes, Vector3d::Zero());
    state_.wall_force.assign(kNodes, Vector3d::Zero());
    state_.friction_coefficient.assign(kNodes, 0.0);
    state_.wall_offset.assign(kNodes, 0.0);
  }

  contact::Feature& addFeature(int edge, double parameter, double gap)
  {
    contact::Feature feature;
    feature.edge = edge;
    feature.parameter = parameter;
    feature.normal = Vector3d::UnitZ();
    feature.gap = gap;
    feature.id = static_cast<std::int64_t>(3 * contacts_.set.features.size());
    contacts_.set.features.push_back(feature);
    return contacts_.set.features.back();
  }

  /** Two planes at node 10. @param angle between their normals [rad] */
  void touchGroove(double angle, double first_gap, double second_gap)
  {
    contacts_ = {};
    for (int k = 0; k < 2; ++k)
    {
      contact::Feature& feature = addFeature(10, 0.0, k == 0 ? first_gap : second_gap);
      feature.normal = Vector3d(0.0, (k == 0 ? 1.0 : -1.0) * std::sin(0.5 * angle), std::cos(0.5 * angle));
      feature.stiffness = kWallStiffness;
    }
    springs_.prepare(state_, 1e-3, contacts_);
  }

  /** Stiffness of the node in compression over that of the wall. */
  Eigen::Matrix3d relativeStiffness() const
  {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t c = 0; c < contacts_.springs.size(); ++c)
    {
      const Vector3d& normal = contacts_.set.features[c].normal;
      if (contacts_.springs[c].gap < 0.0)
        sum += contacts_.springs[c].stiffness * normal * normal.transpose();
    }
    return sum / (kWallStiffness * kEdge);
  }

  const Discretisation rod_ = discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), kNodes);
  const StepperSettings settings_{};
  ContactSprings springs_{rod_, settings_};
  ContactList contacts_;
  State state_;
};

TEST_F(SpringsOfAWire, OfTwoFacetsAtANodeAreAsStiffAsOneWall)
{
  for (const double angle : {0.0, 0.02, 0.3, 0.5 * M_PI})
  {
    touchGroove(angle, -2e-5, -2e-5);
    const Vector3d values = relativeStiffness().selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_NEAR(values.maxCoeff(), 1.0, 1e-9) << angle;
  }
}

TEST_F(SpringsOfAWire, OfASecondFacetTakeTheirShareGraduallyWithItsDepth)
{
  touchGroove(0.05, -2e-5, 1e-9);
  const Eigen::Matrix3d before = relativeStiffness();
  touchGroove(0.05, -2e-5, -1e-9);
  const Eigen::Matrix3d after = relativeStiffness();
  EXPECT_NEAR(before(2, 2), std::pow(std::cos(0.025), 2), 1e-9);
  // The stiffness that the second facet adds at once acts over a negligible depth.
  const Vector3d first(0.0, std::sin(0.025), std::cos(0.025));
  const Vector3d across(0.0, -std::sin(0.025), std::cos(0.025));
  const double own = after(2, 2) / (first.z() * first.z()) - 0.5;
  EXPECT_NEAR(own, 1.0, 1e-3);
  EXPECT_LT((after - before - 0.5 * across * across.transpose()).norm(), 1e-2);
}

TEST_F(SpringsOfAWire, HaveTributaryLengthsThatAddUpToTheWires)
{
  for (int edge = 0; edge < kNodes - 1; ++edge)
    addFeature(edge, 0.0, 1e-6).stiffness = kWallStiffness;
  addFeature(kNodes - 2, 1.0, 1e-6).stiffness = kWallStiffness;
  for (const double parameter : {0.2, 0.7})
    addFeature(12, parameter, 1e-6).stiffness = kWallStiffness;
  springs_.prepare(state_, 1e-3, contacts_);
  double sum = 0.0;
  for (const ContactSpring& spring : contacts_.springs)
    sum += spring.stiffness / kWallStiffness;
  EXPECT_NEAR(sum, 0.1, 1e-12);
  // Neighbours at 0 and 0.7 of the edge.
  EXPECT_NEAR(contacts_.springs[kNodes].stiffness, 0.35 * kEdge * kWallStiffness, 1e-9);
}

TEST_F(SpringsOfAWire, OmitRetainedContactsOutOfCompressionFromTributaryLengths)
{
  addFeature(12, 0.2, 1e-6).stiffness = kWallStiffness;
  addFeature(12, 0.7, 1e-6).stiffness = kWallStiffness;
  contacts_.retained = 1;
  springs_.prepare(state_, 1e-3, contacts_);
  EXPECT_NEAR(contacts_.springs[0].stiffness, 0.5 * kEdge * kWallStiffness, 1e-9);
  contacts_.set.features[1].gap = -1e-6;
  springs_.prepare(state_, 1e-3, contacts_);
  EXPECT_NEAR(contacts_.springs[0].stiffness, 0.35 * kEdge * kWallStiffness, 1e-9);
}

TEST_F(SpringsOfAWire, HaveThePenaltyStiffnessOfARigidWallAndAHundredTimesItInTheStiffLayer)
{
  addFeature(4, 0.5, -1e-6);
  addFeature(4, 0.5, -1e-6).id = -2;
  springs_.prepare(state_, 1e-3, contacts_);
  EXPECT_EQ(contacts_.springs[0].stiffness, settings_.contact_stiffness);
  EXPECT_EQ(contacts_.springs[1].stiffness, 100.0 * settings_.contact_stiffness);
}

TEST_F(SpringsOfAWire, AreActiveWhereTheVelocityClosesTheGapWithinTheStep)
{
  addFeature(4, 0.5, 10e-6);
  state_.velocity[4].z() = state_.velocity[5].z() = -9e-3;
  springs_.prepare(state_, 1e-3, contacts_);
  EXPECT_FALSE(contacts_.springs[0].active);
  state_.velocity[5].z() = -12e-3;
  springs_.prepare(state_, 1e-3, contacts_);
  EXPECT_TRUE(contacts_.springs[0].active);
  state_.wall_offset[4] = 5e-6;
  springs_.prepare(state_, 1e-3, contacts_);
  EXPECT_NEAR(contacts_.springs[0].gap, 12.5e-6, 1e-15);
}

TEST_F(SpringsOfAWire, ExertTheirForceOnBothNodesOfTheEdgeAndNeverPull)
{
  addFeature(4, 0.25, -10e-6).friction = 0.3;
  addFeature(8, 0.25, -10e-6);
  springs_.prepare(state_, 1e-3, contacts_);
  NodalMotion motion(kNodes, Vector3d::Zero());
  motion[4].z() = motion[5].z() = 4e-6;
  motion[8].z() = motion[9].z() = 11e-6;
  springs_.exertForces(contacts_, motion, state_);
  const double force = 6e-6 * settings_.contact_stiffness;
  EXPECT_NEAR(contacts_.springs[0].force, force, 1e-9);
  EXPECT_NEAR(state_.wall_force[4].z(), 0.75 * force, 1e-9);
  EXPECT_NEAR(state_.wall_force[5].z(), 0.25 * force, 1e-9);
  EXPECT_GT(state_.friction_coefficient[4], 0.0);
  EXPECT_EQ(contacts_.springs[1].force, 0.0);
  EXPECT_TRUE(state_.wall_force[8].isZero(0.0));
}

}  // namespace
}  // namespace endovascular_sim::rod
