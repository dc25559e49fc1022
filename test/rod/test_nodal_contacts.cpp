#include "rod/nodal_contacts.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "plane_wall.h"
#include "ridge_wall.h"
#include "rod/kkt_stepper.h"
#include "rod/mixed_stepper.h"
#include "rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kEi = 4.9469e-5;
constexpr double kRadius = 1.8e-4;
constexpr double kFriction = 0.2;

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

TEST(NodalContacts, AFallenWireLiesOnTheFloorWhichCarriesItsWeight)
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

TEST(NodalContacts, AFastWireDoesNotTunnel)
{
  Bench bench(20e-3);
  for (Vector3d& velocity : bench.state.velocity)
    velocity = Vector3d(0.0, 0.0, -20.0);  // 20 mm per step
  bench.run(1e-3, 50);
  for (const Vector3d& position : bench.state.position)
    EXPECT_GT(position.z(), kRadius - 1e-5);
}

TEST(NodalContacts, ASlidingWireIsBrakedByCoulombFriction)
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

/** Depth at the ridge of a stiff wire that is pressed on a compliant roof all along [m]. */
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

TEST(NodalContacts, ACompliantWallGivesWayByTheSameForAnySamplingWhereTheWireCrossesARidge)
{
  // A rigid wire in touch all along: F = k ∫(depth − slope·|x|) dx about a ridge in its middle.
  constexpr double kLoad = 0.05;  // less than the travel after which a soft wall is rigid
  const double expected = kLoad / (1e4 * 0.1) + 1e-3 * 0.1 / 4.0;
  for (const int nodes : {20, 40, 80})
    EXPECT_NEAR(indentation(nodes, 0.05, kLoad), expected, 2e-3 * expected) << nodes;
  // Wherever the ridge meets an edge: at its middle, near its end, and on a node.
  const double off_centre = indentation(80, 0.0531, kLoad);
  for (const int nodes : {20, 21, 40, 41})
    EXPECT_NEAR(indentation(nodes, 0.0531, kLoad), off_centre, 1e-2 * off_centre) << nodes;
}

TEST(NodalContacts, ForceOfACompliantWallIsContinuousWhereARidgePassesANode)
{
  const double place = 0.1 * 20 / 40;  // of a node
  const double before = indentation(41, place - 1e-7, 0.1);
  EXPECT_NEAR(indentation(41, place, 0.1), before, 1e-4 * before);
  EXPECT_NEAR(indentation(41, place + 1e-7, 0.1), before, 1e-4 * before);
}

/** Two planes that one node touches. */
class Groove : public contact::ContactSource
{
public:
  double angle = 0.0;           ///< between their normals [rad]
  double gaps[2] = {0.0, 0.0};  ///< [m]

  void detect(const contact::Query&, contact::ContactSet& set) override
  {
    set.features.clear();
    set.stale = false;
    for (int k = 0; k < 2; ++k)
    {
      contact::Feature feature;
      feature.edge = 10;
      feature.normal = Vector3d(0.0, (k == 0 ? 1.0 : -1.0) * std::sin(0.5 * angle), std::cos(0.5 * angle));
      feature.gap = gaps[k];
      feature.stiffness = 1e4;
      feature.id = 3 * k;
      set.features.push_back(feature);
    }
  }
};

/** The springs of a node in a groove, as its stiffness over the wall's. */
Eigen::Matrix3d stiffnessInGroove(Groove& groove)
{
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), 21);
  const Boundary boundary = Bench::freeBoundary(0.0);
  const StepperSettings settings;
  NodalContacts contacts(rod, boundary, settings);
  const State state = Bench(0.0).state;
  PhaseTimer timer;
  StepReport report;
  std::uint32_t asked = 0;
  contacts.beginStep(StepInput(), &groove, asked, timer);
  contacts.refresh(state, report);
  contacts.prepare(state, 1e-3);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t c = 0; c < contacts.count(); ++c)
    if (contacts.spring(c).gap < 0.0)
      sum += contacts.spring(c).stiffness * contacts.feature(c).normal * contacts.feature(c).normal.transpose();
  return sum / (1e4 * 0.1 / 20);
}

TEST(NodalContacts, FacetsThatANodeTouchesAtOnceGiveWayLikeOneWall)
{
  Groove groove;
  groove.gaps[0] = groove.gaps[1] = -2e-5;
  for (const double angle : {0.0, 0.02, 0.3, 0.5 * M_PI})
  {
    groove.angle = angle;
    const Eigen::Vector3d values = stiffnessInGroove(groove).selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_NEAR(values.maxCoeff(), 1.0, 1e-9) << angle;
  }
}

TEST(NodalContacts, ASecondFacetTakesItsShareGraduallyAsItIsPressedIn)
{
  Groove groove;
  groove.angle = 0.05;
  groove.gaps[0] = -2e-5;
  groove.gaps[1] = 1e-9;
  const Eigen::Matrix3d before = stiffnessInGroove(groove);
  groove.gaps[1] = -1e-9;
  const Eigen::Matrix3d after = stiffnessInGroove(groove);
  EXPECT_NEAR(before(2, 2), std::pow(std::cos(0.025), 2), 1e-9);
  // What the second one adds at once acts over next to no depth.
  const Eigen::Vector3d first(0.0, std::sin(0.025), std::cos(0.025));
  const Eigen::Vector3d across(0.0, -std::sin(0.025), std::cos(0.025));
  const double own = after(2, 2) / (first.z() * first.z()) - 0.5;
  EXPECT_NEAR(own, 1.0, 1e-3);
  EXPECT_LT((after - before - 0.5 * across * across.transpose()).norm(), 1e-2);
}

/** A wall of one plane per node but the last, each with a direction and distance of its own. */
class RandomWall : public contact::ContactSource
{
public:
  std::vector<Vector3d> normals;
  std::vector<double> gaps;

  void detect(const contact::Query&, contact::ContactSet& set) override
  {
    set.features.clear();
    for (int i = 0; i < static_cast<int>(normals.size()); ++i)
    {
      contact::Feature feature;
      feature.edge = i;
      feature.normal = normals[i];
      feature.gap = gaps[i];
      feature.id = 3 * i;
      set.features.push_back(feature);
    }
    set.stale = false;
  }
};

/** Passes that the active set takes on a stiff random quadratic problem, until it is that of the solution. */
int passesOnRandomProblem(unsigned seed)
{
  constexpr int kNodes = 21;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), kNodes);
  const Boundary boundary = Bench::freeBoundary(0.0);
  const StepperSettings settings;
  const State state = Bench(0.0).state;
  RandomWall wall;
  const int size = 3 * kNodes;
  Eigen::MatrixXd root(size, size);
  Eigen::VectorXd load(size);
  for (int k = 0; k < size; ++k)
  {
    load[k] = 0.05 * uniform(random);
    for (int j = 0; j < size; ++j)
      root(k, j) = uniform(random);
  }
  for (int i = 0; i + 1 < kNodes; ++i)
  {
    wall.normals.push_back(Vector3d(uniform(random), uniform(random), uniform(random)).normalized());
    wall.gaps.push_back(1e-6 * uniform(random));
  }
  const Eigen::MatrixXd rest = 1e3 * root * root.transpose() + 10.0 * Eigen::MatrixXd::Identity(size, size);

  NodalContacts contacts(rod, boundary, settings);
  PhaseTimer timer;
  StepReport report;
  std::uint32_t asked = 0;
  contacts.beginStep(StepInput(), &wall, asked, timer);
  contacts.refresh(state, report);
  contacts.prepare(state, 1e-3);
  NodalContacts::Motion motion(kNodes);
  for (int pass = 0; pass < 12; ++pass)
  {
    Eigen::MatrixXd matrix = rest;
    Eigen::VectorXd right = load;
    for (std::size_t c = 0; c < contacts.count(); ++c)
    {
      const NodalContacts::Spring& spring = contacts.spring(c);
      if (!spring.active)
        continue;
      const Vector3d& normal = contacts.feature(c).normal;
      matrix.block<3, 3>(3 * spring.node, 3 * spring.node) += spring.stiffness * normal * normal.transpose();
      right.segment<3>(3 * spring.node) -= spring.stiffness * spring.gap * normal;
    }
    const Eigen::VectorXd solution = matrix.llt().solve(right);
    for (int i = 0; i < kNodes; ++i)
      motion[i] = solution.segment<3>(3 * i);
    if (!contacts.updateActiveSet(motion, pass, pass > 0))
      return pass + 1;
  }
  return 13;
}

/** Share of random motions that is left, and how often the wall was asked for free distances. */
class TruncationOverAFloor : public testing::Test
{
protected:
  /** A wire that rises evenly from the floor. */
  void place(double lowest, double highest)
  {
    for (int i = 0; i < kNodes; ++i)
      state_.position[i].z() = kRadius + lowest + (highest - lowest) * i / (kNodes - 1);
    contacts_.beginStep(StepInput(), &floor_, passes_, timer_);
    contacts_.invalidate();
    contacts_.refresh(state_, report_);
    passes_ = 0;
  }

  /** A step in which nothing moves. */
  void rest() { contacts_.beginStep(StepInput(), &floor_, passes_, timer_); }

  double radius(int node) const { return std::max(kRadius, radii_[node]); }
  double gap(int node) const { return state_.position[node].z() - radius(node); }

  /** The least margin of a node and of those beside it. */
  double margin(int node) const
  {
    const double widest =
        std::max({radius(std::max(0, node - 1)), radius(node), radius(std::min(node + 1, kNodes - 1))});
    return marginOf(widest);
  }

  double marginOf(double radius) const
  {
    return contact::listingMargin(settings_.contact_margin, floor_.wide_margin, radius);
  }

  double expected(const NodalContacts::Motion& motion) const
  {
    double factor = 1.0;
    for (int i = 0; i + 1 < kNodes; ++i)
    {
      const double margins = std::min(margin(i) / motion[i].norm(), margin(i + 1) / motion[i + 1].norm());
      const double free =
          std::max(0.0, std::min(gap(i), gap(i + 1))) / std::max(motion[i].norm(), motion[i + 1].norm());
      factor = std::min(factor, std::max(margins, free));
    }
    for (int i = 0; i < kNodes; ++i)  // nodes of edges with a listed contact keep to their margins
      for (int k = std::max(0, i - 1); k <= std::min(i + 1, kNodes - 1); ++k)
        if (gap(i) <= marginOf(radius(i)))
          factor = std::min(factor, margin(k) / motion[k].norm());
    return factor;
  }

  NodalContacts::Motion randomMotion(double size)
  {
    std::uniform_real_distribution<double> uniform(-size, size);
    NodalContacts::Motion motion(kNodes);
    for (Vector3d& of_node : motion)
      of_node = Vector3d(uniform(random_), uniform(random_), uniform(random_));
    return motion;
  }

  static constexpr int kNodes = 21;
  const Discretisation rod_ = discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), kNodes);
  const Boundary boundary_ = Bench::freeBoundary(0.0);
  const StepperSettings settings_;
  NodalContacts contacts_{rod_, boundary_, settings_};
  PlaneWall floor_{kFriction};
  State state_ = Bench(0.0).state;
  PhaseTimer timer_;
  StepReport report_;
  std::uint32_t passes_ = 0;
  std::mt19937 random_{3};
  std::vector<double> radii_ = std::vector<double>(kNodes, 0.0);  // least ones of what the wire carries
};

TEST_F(TruncationOverAFloor, IsThatOfTheTightestEdgeWhetherItsContactIsListedOrItsFreeDistanceAskedFor)
{
  int asked = 0;
  for (int trial = 0; trial < 200; ++trial)
  {
    rest();
    place(trial % 2 == 0 ? 0.1e-3 : 0.5e-3, 20e-3);
    const NodalContacts::Motion motion = randomMotion(1e-3 * (1 + trial % 10));
    EXPECT_NEAR(contacts_.truncation(state_, motion, 1.0, report_), expected(motion), 1e-9) << trial;
    asked += static_cast<int>(passes_);
    if (trial % 20 == 19)  // something wide elsewhere
    {
      radii_.assign(kNodes, 0.0);
      for (int i = trial / 20; i < trial / 20 + 5; ++i)
        radii_[i] = 1.3e-3;
      contacts_.setRadii(radii_);
    }
  }
  EXPECT_GT(asked, 0);
}

TEST_F(TruncationOverAFloor, IsTighterWhereTheWireCarriesAWideBodyAndAtTheNodesBeside)
{
  constexpr int kMiddle = 10;
  constexpr double kWide = 1.5e-3;
  radii_[kMiddle] = kWide;
  contacts_.setRadii(radii_);
  for (int moved = 0; moved < kNodes; ++moved)
  {
    rest();
    place(0.1e-3, 0.1e-3);
    NodalContacts::Motion motion(kNodes, Vector3d::Zero());
    motion[moved] = Vector3d(0.9 * settings_.contact_margin, 0.0, 0.0);
    const double wide_margin = marginOf(kWide);
    ASSERT_LT(wide_margin, 0.5 * settings_.contact_margin);
    const double margin = std::abs(moved - kMiddle) <= 1 ? wide_margin : settings_.contact_margin;
    EXPECT_NEAR(contacts_.truncation(state_, motion, 1.0, report_), std::min(1.0, margin / motion[moved].norm()), 1e-12)
        << moved;
  }
  place(20e-3, 20e-3);
  EXPECT_EQ(contacts_.truncation(state_, NodalContacts::Motion(kNodes, Vector3d(1e-3, 0.0, 0.0)), 1.0, report_), 1.0);
}

TEST_F(TruncationOverAFloor, CountsTheMotionThatWasMadeOnTheLastSetBeforeTheNextOneFailsToCome)
{
  radii_[5] = 1.2e-3;
  contacts_.setRadii(radii_);
  for (const double before : {0.0, 0.3, 1.0})
  {
    floor_.stale = false;
    place(0.1e-3, 0.1e-3);
    const double narrow = marginOf(1.2e-3);
    ASSERT_LT(narrow, settings_.contact_margin);
    NodalContacts::Motion motion(kNodes, Vector3d::Zero());
    motion[5] = Vector3d(before * narrow, 0.0, 0.0);
    EXPECT_EQ(contacts_.truncation(state_, motion, 1.0, report_), 1.0);
    floor_.stale = true;
    contacts_.detect(state_, report_);
    motion[5] = Vector3d(2.0 * narrow, 0.0, 0.0);
    EXPECT_NEAR(contacts_.truncation(state_, motion, 1.0, report_), 0.5 * (1.0 - before), 1e-12) << before;
    EXPECT_NEAR(contacts_.truncation(state_, motion, 1.0, report_), 0.0, 1e-12);  // all is spent
    contacts_.beginStep(StepInput(), &floor_, passes_, timer_);                   // the next step may ask again
  }
}

TEST_F(TruncationOverAFloor, LeavesAFilledBalloonAsMuchAsItMaySoonMove)
{
  const auto moveBalloon = [&](double distance)
  {
    place(20e-3, 20e-3);
    NodalContacts::Motion motion(kNodes, Vector3d::Zero());
    motion[5] = Vector3d(distance, 0.0, 0.0);
    contacts_.truncation(state_, motion, 1.0, report_);
    place(20e-3, 20e-3);
    return floor_.wide_margin;
  };
  EXPECT_TRUE(std::isinf(moveBalloon(1e-5)));  // nothing wide yet
  radii_[5] = 1.5e-3;
  contacts_.setRadii(radii_);
  const double moving = moveBalloon(1e-5);
  EXPECT_GT(moving, 2e-5);
  EXPECT_LT(moving, 1e-4);
  EXPECT_GT(moveBalloon(0.0), 0.2 * moving);  // it may go on
  for (int still = 0; still < 20; ++still)
    moveBalloon(0.0);
  EXPECT_GT(moveBalloon(0.0), 1e-6);
  EXPECT_LT(moveBalloon(0.0), 1e-5);
  EXPECT_GT(moveBalloon(1e-5), 2e-5);
}

TEST_F(TruncationOverAFloor, AsksFartherOffWhereASnapIsUnderWayAndForgetsItAfterAStepWithoutOne)
{
  const auto askedAfter = [&](double distance)
  {
    place(0.1e-3, 0.1e-3);
    NodalContacts::Motion motion(kNodes, Vector3d::Zero());
    motion[9] = motion[10] = Vector3d(distance, 0.0, 0.0);
    contacts_.truncation(state_, motion, 1.0, report_);
    contacts_.detect(state_, report_);
    return floor_.margins;
  };
  const double usual = settings_.contact_margin;
  for (const double margin : askedAfter(0.5 * usual))
    EXPECT_EQ(margin, usual);
  const std::vector<double> fast = askedAfter(4.0 * usual);
  for (int i = 0; i < kNodes; ++i)
    EXPECT_EQ(fast[i], (i >= 7 && i <= 12 ? 3.0 : 1.0) * usual) << i;
  EXPECT_EQ(askedAfter(0.0)[9], 3.0 * usual);  // the last step's snap may go on
  EXPECT_EQ(askedAfter(0.0)[9], usual);
}

TEST_F(TruncationOverAFloor, NoFastNodeMovesFartherThanItsAxisIsFromTheWallNorThanWhatIsListed)
{
  const double usual = settings_.contact_margin;
  for (const double gap : {-0.05e-3, 0.0, 0.2e-3, 0.6e-3, 2e-3})
    for (const int moved : {3, 8, 10})
    {
      rest();
      place(gap, gap);
      NodalContacts::Motion motion(kNodes, Vector3d::Zero());
      motion[moved] = Vector3d(3e-3, 0.0, 0.0);
      contacts_.truncation(state_, motion, 1.0, report_);
      contacts_.detect(state_, report_);
      const double free = 3e-3 * contacts_.truncation(state_, motion, 1.0, report_);
      EXPECT_LE(free, std::max({usual, std::min(3.0 * usual, kRadius + gap), gap}) + 1e-12) << gap;
      EXPECT_GE(free, std::min(3.0 * usual, 0.9 * (kRadius + gap)) - 1e-12) << gap;
      EXPECT_GE(free, usual - 1e-12) << gap;
    }
}

/** A wall that touches one edge between its nodes. */
class OneCrossing : public contact::ContactSource
{
public:
  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    set.stale = false;
    set.first_edge = query.first_node;
    set.free_distance.assign(query.nodes.size() - 1, 0.0);
    contact::Feature feature;
    feature.edge = kEdge;
    feature.parameter = 0.4;
    feature.point = Vector3d(0.0, 0.0, -1.0);
    feature.normal = Vector3d::UnitZ();
    feature.gap = gap;
    feature.id = 4;
    set.features.assign(1, feature);
  }

  static constexpr int kEdge = 8;
  double gap = 0.0;  ///< [m]
};

TEST_F(TruncationOverAFloor, ACrossingOnATaperBoundsFastNodesByItsGapAndTheEdgesLeastRadius)
{
  Discretisation tapered = rod_;
  for (int i = OneCrossing::kEdge + 1; i < kNodes; ++i)
    tapered.radius[i] = 0.4 * kRadius;
  NodalContacts contacts(tapered, boundary_, settings_);
  OneCrossing wall;
  const double usual = settings_.contact_margin;
  for (const double gap : {0.0, 0.2e-3, 0.4e-3})
  {
    wall.gap = gap;
    contacts.beginStep(StepInput(), &wall, passes_, timer_);
    contacts.invalidate();
    contacts.refresh(state_, report_);
    NodalContacts::Motion motion(kNodes, Vector3d::Zero());
    motion[OneCrossing::kEdge] = Vector3d(3e-3, 0.0, 0.0);
    contacts.truncation(state_, motion, 1.0, report_);
    contacts.detect(state_, report_);
    const double clear = gap + 0.4 * kRadius;
    for (const int node : {OneCrossing::kEdge, OneCrossing::kEdge + 1})
    {
      EXPECT_LE(contacts.marginOf(node), std::max(usual, clear)) << gap;
      EXPECT_GE(contacts.marginOf(node), std::max(usual, 0.9 * clear) - 1e-12) << gap;
    }
  }
}

TEST_F(TruncationOverAFloor, WhatIsPressedInAtOneNodeIsNoLeaveForAnother)
{
  constexpr double kTolerated = 80e-6;  // m
  const auto pressIn = [&](double at_three, double at_nine)
  {
    place(1e-3, 1e-3);
    state_.position[3].z() = kRadius - at_three;
    state_.position[9].z() = kRadius - at_nine;
    contacts_.detect(state_, report_);
  };
  ASSERT_GT(kRadius, 1.3 * kTolerated);
  pressIn(1.2 * kTolerated, 0.0);
  contacts_.noteDepths();
  pressIn(1.2 * kTolerated, 0.9 * kTolerated);
  EXPECT_FALSE(contacts_.isDeeper());
  pressIn(1.2 * kTolerated, 1.1 * kTolerated);
  EXPECT_TRUE(contacts_.isDeeper());
  pressIn(1.1 * kTolerated, 0.0);
  EXPECT_FALSE(contacts_.isDeeper());
  pressIn(1.3 * kTolerated, 0.0);
  EXPECT_TRUE(contacts_.isDeeper());
}

TEST_F(TruncationOverAFloor, FastNodesKeepWhatTheyMayMoveWhereTheNextSetFailsToCome)
{
  place(0.2e-3, 0.2e-3);
  NodalContacts::Motion motion(kNodes, Vector3d::Zero());
  motion[8] = Vector3d(3e-3, 0.0, 0.0);
  contacts_.truncation(state_, motion, 1.0, report_);
  contacts_.detect(state_, report_);
  const double free = contacts_.marginOf(8);
  ASSERT_GT(free, settings_.contact_margin);
  motion[8] = Vector3d(0.25 * free, 0.0, 0.0);
  EXPECT_EQ(contacts_.truncation(state_, motion, 1.0, report_), 1.0);
  floor_.stale = true;
  contacts_.detect(state_, report_);
  motion[8] = Vector3d(free, 0.0, 0.0);
  EXPECT_NEAR(contacts_.truncation(state_, motion, 1.0, report_), 0.75, 1e-12);
  EXPECT_NEAR(contacts_.truncation(state_, motion, 1.0, report_), 0.0, 1e-12);
}

TEST_F(TruncationOverAFloor, FastNodesGoWithTheirNumbersWhenNodesComeBeforeThem)
{
  place(0.1e-3, 0.1e-3);
  NodalContacts::Motion motion(kNodes, Vector3d::Zero());
  motion[9] = Vector3d(1e-3, 0.0, 0.0);
  contacts_.truncation(state_, motion, 1.0, report_);
  contacts_.detect(state_, report_);
  const double before = contacts_.marginOf(9);
  ASSERT_GT(before, settings_.contact_margin);
  ASSERT_EQ(contacts_.marginOf(12), settings_.contact_margin);
  Discretisation longer = rod_;
  for (const int node : {0, 0})
  {
    longer.position.insert(longer.position.begin(), -1.0 - node);
    longer.mass.insert(longer.mass.begin(), longer.mass.front());
  }
  contacts_.resample(longer);
  EXPECT_EQ(contacts_.marginOf(11), before);
  EXPECT_EQ(contacts_.marginOf(14), settings_.contact_margin);
  contacts_.resample(discretiseUniformly(uniformWire(0.2, kEi, kRadius, 7900.0), kNodes));
  EXPECT_EQ(contacts_.marginOf(11), settings_.contact_margin);  // of another wire nothing is known
}

TEST_F(TruncationOverAFloor, AsksForNoFreeDistancesWhereListedContactsSettleIt)
{
  place(0.0, 0.1e-3);
  contacts_.truncation(state_, randomMotion(5e-3), 1.0, report_);
  EXPECT_EQ(passes_, 0U);
  place(1e-3, 2e-3);
  contacts_.truncation(state_, randomMotion(5e-3), 1.0, report_);
  EXPECT_EQ(passes_, 1U);
}

TEST_F(TruncationOverAFloor, CountsWhatABalloonGrowsAndNotWhatItShrinks)
{
  const auto left = [&](double radius)
  {
    place(0.1e-3, 0.1e-3);
    radii_[5] = radius;
    contacts_.setRadii(radii_);
    NodalContacts::Motion motion(kNodes, Vector3d::Zero());
    motion[5] = Vector3d(1e-3, 0.0, 0.0);
    return 1e-3 * contacts_.truncation(state_, motion, 1.0, report_);
  };
  for (int still = 0; still < 40; ++still)
  {
    radii_[5] = 1.08e-3;
    contacts_.setRadii(radii_);
    place(20e-3, 20e-3);
    contacts_.truncation(state_, NodalContacts::Motion(kNodes, Vector3d::Zero()), 1.0, report_);
  }
  const double listed = marginOf(1.08e-3);
  ASSERT_LT(listed, 20e-6);
  EXPECT_NEAR(contacts_.marginOf(5), listed, 1e-12);
  EXPECT_LE(left(1.05e-3), listed + 1e-12);  // wires of that radius have more
  radii_[5] = 1.08e-3;
  contacts_.setRadii(radii_);
  const double before = (place(0.1e-3, 0.1e-3), contacts_.marginOf(5));
  radii_[5] = 1.08e-3 + 0.25 * before;
  contacts_.setRadii(radii_);
  EXPECT_NEAR(contacts_.marginOf(5), 0.75 * before, 1e-12);
  radii_[5] += before;
  contacts_.setRadii(radii_);
  EXPECT_GT(contacts_.marginOf(5), 0.0);
}

TEST_F(TruncationOverAFloor, ContactsComeCloserByAsMuchAsABalloonGrowsAsIfTheyWereAskedForAnew)
{
  const auto grown = [&](bool anew)
  {
    NodalContacts contacts(rod_, boundary_, settings_);
    std::vector<double> radii(kNodes, 0.0);
    contacts.beginStep(StepInput(), &floor_, passes_, timer_);
    contacts.setRadii(radii);
    for (int i = 0; i < kNodes; ++i)
      state_.position[i].z() = kRadius + 0.05e-3;
    contacts.refresh(state_, report_);
    for (int i = 4; i < 9; ++i)
      radii[i] = kRadius + 0.03e-3 * (i - 3);
    contacts.setRadii(radii);
    if (anew)
      contacts.invalidate();
    contacts.refresh(state_, report_);
    contacts.prepare(state_, 1e-3);
    std::vector<double> gaps;
    for (std::size_t c = 0; c < contacts.count(); ++c)
      gaps.push_back(contacts.spring(c).gap);
    return gaps;
  };
  const std::vector<double> gaps = grown(false);
  const std::vector<double> anew = grown(true);
  ASSERT_EQ(gaps.size(), anew.size());
  EXPECT_GT(gaps.size(), static_cast<std::size_t>(kNodes));  // with what is behind the wall
  for (std::size_t c = 0; c < gaps.size(); ++c)
    EXPECT_NEAR(gaps[c], anew[c], 1e-12);
}

TEST(NodalContacts, TheActiveSetOfAConvexProblemIsFoundBeforeContactsAreOnlyAdded)
{
  int most = 0;
  for (unsigned seed = 1; seed <= 200; ++seed)
  {
    const int passes = passesOnRandomProblem(seed);
    EXPECT_LE(passes, 12) << seed;
    most = std::max(most, passes);
  }
  EXPECT_GT(most, 2);  // else the problems are too easy to tell
}

}  // namespace
}  // namespace endovascular_sim::rod
