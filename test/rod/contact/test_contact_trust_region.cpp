// How far a solve may move the wire: src/rod/nodal_contacts_trust_region.cpp.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rod/contact/contact_solver_state.h"
#include "rod/kkt/kkt_stepper.h"
#include "test/rod/plane_wall.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kEi = 4.9469e-5;
constexpr double kRadius = 1.8e-4;
constexpr double kFriction = 0.2;

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

  /** A solve that would take a node of a wire at a height far aside, after which it is fast. */
  void snap(int node, double height)
  {
    place(height, height);
    ContactSolver::Motion motion(kNodes, Vector3d::Zero());
    motion[node] = Vector3d(3e-3, 0.0, 0.0);
    contacts_.truncation(state_, motion, 1.0, report_);
    contacts_.detect(state_, report_);
    ASSERT_GT(contacts_.marginOf(node), settings_.contact_margin);
  }

  double radius(int node) const { return std::max(kRadius, radii_[node]); }
  double gap(int node) const { return state_.position[node].z() - radius(node); }

  /** The least margin of a node and of those beside it. */
  double margin(int node) const
  {
    const double widest =
        std::max({radius(std::max(0, node - 1)), radius(node), radius(std::min(node + 1, kNodes - 1))});
    return marginOf(widest);
  }

  /** Margin of a slow node. */
  double marginOf(double radius) const
  {
    MarginRule rule = contacts_.marginRule();
    rule.snap = {};
    return rule.at(0, radius);
  }

  double expected(const ContactSolver::Motion& motion) const
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

  ContactSolver::Motion randomMotion(double size)
  {
    std::uniform_real_distribution<double> uniform(-size, size);
    ContactSolver::Motion motion(kNodes);
    for (Vector3d& of_node : motion)
      of_node = Vector3d(uniform(random_), uniform(random_), uniform(random_));
    return motion;
  }

  static Boundary free()
  {
    Boundary boundary;
    boundary.introducer = false;
    return boundary;
  }

  static constexpr int kNodes = 21;
  const Discretisation rod_ = discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), kNodes);
  const Boundary boundary_ = free();
  const StepperSettings settings_;
  ContactSolver contacts_{rod_, boundary_, settings_};
  PlaneWall floor_{kFriction};
  State state_ = KktStepper(rod_, boundary_, Environment(), StepperSettings()).initialState(0.0, 0.0);
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
    const ContactSolver::Motion motion = randomMotion(1e-3 * (1 + trial % 10));
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
    ContactSolver::Motion motion(kNodes, Vector3d::Zero());
    motion[moved] = Vector3d(0.9 * settings_.contact_margin, 0.0, 0.0);
    const double wide_margin = marginOf(kWide);
    ASSERT_LT(wide_margin, 0.5 * settings_.contact_margin);
    const double margin = std::abs(moved - kMiddle) <= 1 ? wide_margin : settings_.contact_margin;
    EXPECT_NEAR(contacts_.truncation(state_, motion, 1.0, report_), std::min(1.0, margin / motion[moved].norm()), 1e-12)
        << moved;
  }
  place(20e-3, 20e-3);
  EXPECT_EQ(contacts_.truncation(state_, ContactSolver::Motion(kNodes, Vector3d(1e-3, 0.0, 0.0)), 1.0, report_), 1.0);
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
    ContactSolver::Motion motion(kNodes, Vector3d::Zero());
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
    ContactSolver::Motion motion(kNodes, Vector3d::Zero());
    motion[5] = Vector3d(distance, 0.0, 0.0);
    contacts_.truncation(state_, motion, 1.0, report_);
    place(20e-3, 20e-3);
    return contacts_.marginRule().widest_margin;
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
    ContactSolver::Motion motion(kNodes, Vector3d::Zero());
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
      ContactSolver::Motion motion(kNodes, Vector3d::Zero());
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

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override { detect(query, set); }

  static constexpr int kEdge = 8;
  double gap = 0.0;  ///< [m]
};

TEST_F(TruncationOverAFloor, ACrossingOnATaperBoundsFastNodesByItsGapAndTheEdgesLeastRadius)
{
  Discretisation tapered = rod_;
  for (int i = OneCrossing::kEdge + 1; i < kNodes; ++i)
    tapered.radius[i] = 0.4 * kRadius;
  ContactSolver contacts(tapered, boundary_, settings_);
  OneCrossing wall;
  const double usual = settings_.contact_margin;
  for (const double gap : {0.0, 0.2e-3, 0.4e-3})
  {
    wall.gap = gap;
    contacts.beginStep(StepInput(), &wall, passes_, timer_);
    contacts.invalidate();
    contacts.refresh(state_, report_);
    ContactSolver::Motion motion(kNodes, Vector3d::Zero());
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
  snap(8, 0.2e-3);
  const double free = contacts_.marginOf(8);
  ContactSolver::Motion motion(kNodes, Vector3d::Zero());
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
  snap(9, 0.1e-3);
  const double before = contacts_.marginOf(9);
  ASSERT_EQ(contacts_.marginOf(12), settings_.contact_margin);
  Discretisation longer = rod_;
  longer.position.insert(longer.position.begin(), 2, -1.0);
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
    ContactSolver::Motion motion(kNodes, Vector3d::Zero());
    motion[5] = Vector3d(1e-3, 0.0, 0.0);
    return 1e-3 * contacts_.truncation(state_, motion, 1.0, report_);
  };
  for (int still = 0; still < 40; ++still)
  {
    radii_[5] = 1.08e-3;
    contacts_.setRadii(radii_);
    place(20e-3, 20e-3);
    contacts_.truncation(state_, ContactSolver::Motion(kNodes, Vector3d::Zero()), 1.0, report_);
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
    ContactSolver contacts(rod_, boundary_, settings_);
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

}  // namespace
}  // namespace endovascular_sim::rod
