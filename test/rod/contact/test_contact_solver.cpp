#include "rod/contact/contact_solver.h"

#include <vector>

#include <gtest/gtest.h>

#include "rod/mixed/mixed_stepper.h"
#include "test/rod/contact/wire_over_a_floor.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kEi = 4.9469e-5;
constexpr double kRadius = 1.8e-4;
constexpr double kFriction = 0.2;

/** A wire that falls on a floor. */
struct Bench
{
  PlaneWall floor{kFriction};
  MixedStepper stepper;
  State state;
  PhaseTimer timer;

  static Boundary freeBoundary(double height)
  {
    Boundary boundary;
    boundary.introducer = false;
    boundary.origin = Vector3d(0.0, 0.0, height);
    return boundary;
  }

  static Environment gravity()
  {
    Environment environment;
    environment.gravity = Vector3d(0.0, 0.0, -9.81);
    return environment;
  }

  explicit Bench(double height)
    : stepper(uniformWire(0.1, kEi, kRadius, 7900.0), discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), 21),
              freeBoundary(height), gravity(), StepperSettings()),
      state(stepper.initialState(0.0, 0.0))
  {
  }

  void run(double dt, int steps)
  {
    for (int k = 0; k < steps; ++k)
    {
      std::uint32_t pass = 0;
      StepInput input;
      input.step = static_cast<std::uint64_t>(k);
      ASSERT_TRUE(stepper.step(state, input, dt, pass, &floor, timer).solved);
    }
  }

  double weight() const
  {
    double sum = 0.0;
    for (const double mass : stepper.discretisation().mass)
      sum += 9.81 * mass;
    return sum;
  }
};

TEST(ContactSolver, SupportsTheWeightOfAFallenWire)
{
  Bench bench(2e-3);
  bench.run(1e-3, 400);
  Vector3d force = Vector3d::Zero();
  for (std::size_t i = 0; i < bench.state.position.size(); ++i)
  {
    force += bench.state.wall_force[i];
    EXPECT_GT(bench.state.position[i].z(), kRadius - 1e-6);
    EXPECT_LT(bench.state.position[i].z(), kRadius + 1e-6);
  }
  EXPECT_NEAR(force.z(), bench.weight(), 1e-6 * bench.weight());
}

TEST(ContactSolver, StopsAFastWireAtTheWall)
{
  Bench bench(20e-3);
  for (Vector3d& velocity : bench.state.velocity)
    velocity = Vector3d(0.0, 0.0, -20.0);  // 20 mm per step
  bench.run(1e-3, 50);
  for (const Vector3d& position : bench.state.position)
    EXPECT_GT(position.z(), kRadius - 1e-5);
}

TEST(ContactSolver, BrakesASlidingWireByCoulombFriction)
{
  Bench bench(kRadius);
  bench.run(1e-3, 50);
  for (Vector3d& velocity : bench.state.velocity)
    velocity = Vector3d(0.2, 0.1, 0.0);
  const double before = bench.state.velocity[10].norm();
  bench.run(1e-3, 40);
  EXPECT_NEAR(bench.state.velocity[10].norm(), before - kFriction * 9.81 * 0.04, 1e-3);
  bench.run(1e-3, 200);
  EXPECT_LT(bench.state.velocity[10].norm(), 1e-4);
}

class ContactSolverOverAFloor : public WireOverAFloor
{
protected:
  /** Gaps of the springs after the growth of a balloon. */
  std::vector<double> gapsAfterGrowth(bool detected_again)
  {
    ContactSolver contacts(rod_, boundary_, settings_);
    std::vector<double> radii(kNodes, 0.0);
    contacts.beginStep(StepInput(), &floor_, passes_, timer_);
    contacts.setRadii(radii);
    for (Vector3d& position : state_.position)
      position.z() = kRadius + 0.05e-3;
    contacts.refresh(state_, report_);
    for (int i = 4; i < 9; ++i)
      radii[i] = kRadius + 0.03e-3 * (i - 3);
    contacts.setRadii(radii);
    if (detected_again)
      contacts.invalidate();
    contacts.refresh(state_, report_);
    contacts.prepare(state_, 1e-3);
    std::vector<double> gaps;
    for (std::size_t c = 0; c < contacts.count(); ++c)
      gaps.push_back(contacts.spring(c).gap);
    return gaps;
  }
};

TEST_F(ContactSolverOverAFloor, ReducesGapsByTheGrowthOfABalloonAsADetectionWould)
{
  const std::vector<double> grown = gapsAfterGrowth(false);
  const std::vector<double> detected = gapsAfterGrowth(true);
  ASSERT_EQ(grown.size(), detected.size());
  EXPECT_GT(grown.size(), static_cast<std::size_t>(kNodes));  // with stiff layers
  for (std::size_t c = 0; c < grown.size(); ++c)
    EXPECT_NEAR(grown[c], detected[c], 1e-12);
}

TEST_F(ContactSolverOverAFloor, ReplacesAStaleAnswerByTheEarlierContactsAsPlanes)
{
  place(0.05e-3, 0.05e-3);
  const std::size_t count = contacts_.set().features.size();
  floor_.stale = true;
  for (Vector3d& position : state_.position)
    position.z() -= 0.01e-3;
  contacts_.detect(state_, report_);
  EXPECT_TRUE(contacts_.set().stale);
  ASSERT_EQ(contacts_.set().features.size(), count);
  for (const contact::Feature& feature : contacts_.set().features)
    EXPECT_NEAR(feature.gap, 0.04e-3, 1e-12);
}

TEST_F(ContactSolverOverAFloor, FindsADeepContactThatTheLastSolveDidNotResist)
{
  place(1e-3, 1e-3);
  contacts_.prepare(state_, 1e-3);
  state_.position[7].z() = kRadius - 2.0 * settings_.penetration_tolerance;
  contacts_.detect(state_, report_);
  EXPECT_TRUE(contacts_.foundUnknown(state_));
  contacts_.prepare(state_, 1e-3);  // the spring at node 7 is active
  contacts_.detect(state_, report_);
  EXPECT_FALSE(contacts_.foundUnknown(state_));
}

/** A rigid ridge below one edge that detection can miss. */
class ElusiveRidge : public contact::ContactSource
{
public:
  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    set.stale = false;
    set.first_edge = query.first_node;
    set.free_distance.assign(query.nodes.size() - 1, 0.0);
    set.features.clear();
    contact::Feature feature;
    feature.edge = 8;
    feature.parameter = parameter;
    const Vector3d axis = (1.0 - parameter) * query.nodes[8] + parameter * query.nodes[9];
    feature.point = axis - query.radius[8] * Vector3d::UnitZ();
    feature.point.z() = 0.0;
    feature.normal = Vector3d::UnitZ();
    feature.gap = axis.z() - query.radius[8];
    feature.id = 4;
    if (found)
      set.features.push_back(feature);
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override { detect(query, set); }

  bool found = true;
  double parameter = 0.4;
};

TEST_F(ContactSolverOverAFloor, RetainsActiveContactsBetweenNodesUntilTheyAreReleased)
{
  ElusiveRidge ridge;
  for (Vector3d& position : state_.position)
    position.z() = kRadius - 5e-6;
  for (const bool between : {true, false})
  {
    ridge.found = true;
    ridge.parameter = between ? 0.4 : 0.0;
    contacts_.beginStep(StepInput(), &ridge, passes_, timer_);
    contacts_.detect(state_, report_);
    contacts_.prepare(state_, 1e-3);
    ridge.found = false;
    contacts_.detect(state_, report_);
    contacts_.retainActiveContacts(state_);
    EXPECT_EQ(contacts_.set().features.size(), between ? 1U : 0U);
    contacts_.releaseRetained();
    EXPECT_TRUE(contacts_.set().features.empty());
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
