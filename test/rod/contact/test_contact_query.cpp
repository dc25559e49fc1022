#include "rod/contact/contact_query.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "test/rod/contact/wire_over_a_floor.h"

namespace endovascular_sim::rod
{
namespace
{

TEST(ContactMargins, FallWithTheFourthPowerOfTheRadiusBeyondAThinCatheter)
{
  EXPECT_EQ(marginShare(0.2e-3), 1.0);
  EXPECT_EQ(marginShare(0.9e-3), 1.0);
  EXPECT_NEAR(marginShare(1.0e-3), std::pow(0.9, 4), 1e-12);
  EXPECT_EQ(marginShare(4e-3), 0.25);
  EXPECT_FALSE(isWide(1.07e-3));
  EXPECT_TRUE(isWide(1.08e-3));
}

TEST(ContactMargins, AreLargerInASnapThroughAndBoundedForWideBodies)
{
  MarginRule rule = uniformMargin(0.2e-3);
  rule.widest_margin = 10e-6;
  rule.snap_margin = 0.6e-3;
  rule.snap = {3, 5};
  EXPECT_EQ(rule.at(2, 0.2e-3), 0.2e-3);
  EXPECT_EQ(rule.at(3, 0.2e-3), 0.6e-3);
  EXPECT_EQ(rule.at(5, 0.2e-3), 0.2e-3);
  EXPECT_EQ(rule.at(3, 2e-3), 10e-6);
  rule.snap_margin = 0.1e-3;
  EXPECT_EQ(rule.at(3, 0.2e-3), 0.2e-3);
}

/** A query builder without a contact solver. */
class QueriesOverAFloor : public WireOverAFloor
{
protected:
  std::vector<double> margins()
  {
    contact::ContactSet set;
    query_.detect(state_, set, report_);
    return floor_.margins;
  }

  void nextStep() { query_.beginStep(StepInput(), &floor_, passes_, timer_); }

  WireSurface surface_{rod_};
  ContactQueryBuilder query_{rod_, boundary_, settings_, surface_};
};

TEST_F(QueriesOverAFloor, HaveThreeMarginsAtASnapThroughInItsStepAndTheNext)
{
  const double usual = settings_.contact_margin;
  nextStep();
  query_.noteSnapThrough(motionOf(9, 0.5 * usual), 0);
  for (const double margin : margins())
    EXPECT_EQ(margin, usual);
  query_.noteSnapThrough(motionOf(9, 4.0 * usual), 0);
  query_.noteSnapThrough(motionOf(10, 4.0 * usual), 0);
  const std::vector<double> snapping = margins();
  for (int i = 0; i < kNodes; ++i)
    EXPECT_EQ(snapping[i], (i >= 7 && i <= 12 ? 3.0 : 1.0) * usual) << i;
  nextStep();
  EXPECT_EQ(margins()[9], 3.0 * usual);
  nextStep();
  EXPECT_EQ(margins()[9], usual);
}

TEST_F(QueriesOverAFloor, BoundTheMarginOfAFilledBalloonByItsRecentMotion)
{
  const auto bound = [this](double motion)
  {
    nextStep();
    query_.noteWideMotion(motion);
    margins();
    return query_.marginRule().widest_margin;
  };
  EXPECT_TRUE(std::isinf(bound(10e-6)));  // no balloon
  least_radius_[5] = 1.5e-3;
  surface_.setLeastRadius(least_radius_);
  EXPECT_NEAR(bound(10e-6), 5e-6 + 4.0 * 10e-6, 1e-12);
  EXPECT_NEAR(bound(0.0), 5e-6 + 4.0 * 5e-6, 1e-12);
  query_.noteWideGrowth(20e-6);
  EXPECT_NEAR(bound(0.0), 5e-6 + 4.0 * 10e-6, 1e-12);
}

TEST_F(QueriesOverAFloor, ContainTheRadiiOfBalloons)
{
  nextStep();
  least_radius_[5] = 1.5e-3;
  surface_.setLeastRadius(least_radius_);
  query_.describe(state_);
  EXPECT_EQ(query_.query().radius[5], 1.5e-3);
  EXPECT_EQ(query_.query().radius[6], kRadius);
}

TEST_F(QueriesOverAFloor, ForFreeDistancesOmitTheEdgesBeforeTheFirst)
{
  nextStep();
  EXPECT_EQ(query_.describe(state_), 0);
  contact::ContactSet set;
  query_.freeDistances(4, 1e-3, set, report_);
  EXPECT_EQ(set.first_edge, 4);
  EXPECT_EQ(set.free_distance.size(), static_cast<std::size_t>(kNodes - 5));
  EXPECT_EQ(query_.query().margin.size(), static_cast<std::size_t>(kNodes - 4));
  EXPECT_EQ(passes_, 1U);
}

TEST_F(QueriesOverAFloor, AreNotSentAfterAMissingAnswerUntilTheNextStep)
{
  nextStep();
  floor_.stale = true;
  contact::ContactSet set;
  query_.detect(state_, set, report_);
  EXPECT_TRUE(set.stale);
  EXPECT_EQ(report_.first_stale_pass, 0U);
  floor_.stale = false;
  query_.detect(state_, set, report_);
  EXPECT_TRUE(set.stale);
  EXPECT_EQ(report_.first_stale_pass, 0U);
  nextStep();
  query_.detect(state_, set, report_);
  EXPECT_FALSE(set.stale);
}

TEST_F(QueriesOverAFloor, RenumberTheNodesOfASnapThrough)
{
  nextStep();
  query_.noteSnapThrough(motionOf(9, 3e-3), 0);
  Discretisation longer = rod_;
  longer.position.insert(longer.position.begin(), 2, -1.0);
  query_.resample(NodeRenumbering(rod_, longer, 0));
  EXPECT_EQ(margins()[9], 3.0 * settings_.contact_margin);
  EXPECT_EQ(margins()[13], 3.0 * settings_.contact_margin);
  EXPECT_EQ(margins()[8], settings_.contact_margin);
}

TEST(QueriesInTheIntroducersMouth, HaveParametersOfTheWholeEdge)
{
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, 5e-5, 1.8e-4, 7900.0), 21);
  const Boundary boundary{};
  const StepperSettings settings{};
  const WireSurface surface(rod);
  ContactQueryBuilder query(rod, boundary, settings, surface);
  const State state = KktStepper(rod, boundary, Environment(), settings).initialState(0.042, 0.0);
  PlaneWall floor(0.0);
  PhaseTimer timer;
  StepReport report;
  std::uint32_t passes = 0;
  contact::ContactSet set;
  query.beginStep(StepInput(), &floor, passes, timer);
  query.detect(state, set, report);
  ASSERT_FALSE(set.features.empty());
  EXPECT_EQ(query.mouthEdge(), query.query().first_node);
  EXPECT_NEAR(query.mouth(), 0.6, 1e-9);  // 42 mm are 8.4 edges of 5 mm
  EXPECT_EQ(set.features.front().edge, query.mouthEdge());
  EXPECT_NEAR(set.features.front().parameter, query.mouth(), 1e-12);
}

}  // namespace
}  // namespace endovascular_sim::rod
