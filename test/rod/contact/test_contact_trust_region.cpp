#include "rod/contact/contact_trust_region.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "test/rod/contact/wire_over_a_floor.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

class TrustRegionOverAFloor : public WireOverAFloor
{
protected:
  /** Least margin of a node and its neighbours. */
  double margin(int node) const
  {
    return marginOf(std::max({radius(std::max(0, node - 1)), radius(node), radius(std::min(node + 1, kNodes - 1))}));
  }

  double expected(const NodalMotion& motion) const
  {
    double factor = 1.0;
    for (int i = 0; i + 1 < kNodes; ++i)
    {
      const double margins = std::min(margin(i) / motion[i].norm(), margin(i + 1) / motion[i + 1].norm());
      const double free =
          std::max(0.0, std::min(gap(i), gap(i + 1))) / std::max(motion[i].norm(), motion[i + 1].norm());
      factor = std::min(factor, std::max(margins, free));
    }
    for (int i = 0; i < kNodes; ++i)  // a contact within the margin limits the nodes of its edges to their margins
      for (int k = std::max(0, i - 1); k <= std::min(i + 1, kNodes - 1); ++k)
        if (gap(i) <= marginOf(radius(i)))
          factor = std::min(factor, margin(k) / motion[k].norm());
    return factor;
  }
};

TEST_F(TrustRegionOverAFloor, TruncatesMotionByTheSmallestBoundOfContactsAndFreeDistances)
{
  int queries = 0;
  for (int trial = 0; trial < 200; ++trial)
  {
    beginStep();
    place(trial % 2 == 0 ? 0.1e-3 : 0.5e-3, 20e-3);
    const NodalMotion motion = randomMotion(1e-3 * (1 + trial % 10));
    EXPECT_NEAR(truncation(motion), expected(motion), 1e-9) << trial;
    queries += static_cast<int>(passes_);
    if (trial % 20 == 19)  // place the balloon at other nodes
    {
      least_radius_.assign(kNodes, 0.0);
      for (int i = trial / 20; i < trial / 20 + 5; ++i)
        least_radius_[i] = 1.3e-3;
      contacts_.setRadii(least_radius_);
    }
  }
  EXPECT_GT(queries, 0);
}

TEST_F(TrustRegionOverAFloor, IsTighterAtAWideBodyAndItsNeighbours)
{
  constexpr int kMiddle = 10;
  constexpr double kWide = 1.5e-3;
  setBalloon(kMiddle, kWide);
  for (int moved = 0; moved < kNodes; ++moved)
  {
    beginStep();
    place(0.1e-3, 0.1e-3);
    const double distance = 0.9 * settings_.contact_margin;
    const double wide_margin = marginOf(kWide);
    ASSERT_LT(wide_margin, 0.5 * settings_.contact_margin);
    const double margin = std::abs(moved - kMiddle) <= 1 ? wide_margin : settings_.contact_margin;
    EXPECT_NEAR(truncation(motionOf(moved, distance)), std::min(1.0, margin / distance), 1e-12) << moved;
  }
  place(20e-3, 20e-3);
  EXPECT_EQ(truncation(NodalMotion(kNodes, Vector3d(1e-3, 0.0, 0.0))), 1.0);
}

TEST_F(TrustRegionOverAFloor, ReducesTheBoundOfAStaleSetByTheMotionSinceTheLastFreshOne)
{
  setBalloon(5, 1.2e-3);
  for (const double before : {0.0, 0.3, 1.0})
  {
    floor_.stale = false;
    place(0.1e-3, 0.1e-3);
    const double narrow = marginOf(1.2e-3);
    ASSERT_LT(narrow, settings_.contact_margin);
    EXPECT_EQ(truncation(motionOf(5, before * narrow)), 1.0);
    floor_.stale = true;
    contacts_.detect(state_, report_);
    EXPECT_NEAR(truncation(motionOf(5, 2.0 * narrow)), 0.5 * (1.0 - before), 1e-12) << before;
    EXPECT_NEAR(truncation(motionOf(5, 2.0 * narrow)), 0.0, 1e-12);
    beginStep();  // the next step may query again
  }
}

TEST_F(TrustRegionOverAFloor, BoundsASnapThroughByTheAxisClearanceAndByTheWidenedMargin)
{
  const double usual = settings_.contact_margin;
  for (const double gap : {-0.05e-3, 0.0, 0.2e-3, 0.6e-3, 2e-3})
    for (const int moved : {3, 8, 10})
    {
      beginStep();
      place(gap, gap);
      truncation(motionOf(moved, 3e-3));
      contacts_.detect(state_, report_);
      const double free = 3e-3 * truncation(motionOf(moved, 3e-3));
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

TEST_F(TrustRegionOverAFloor, BoundsASnapThroughOnATaperByTheGapAndTheLeastRadiusOfTheEdge)
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
    contacts.truncation(state_, motionOf(OneCrossing::kEdge, 3e-3), 1.0, report_);
    contacts.detect(state_, report_);
    const double clearance = gap + 0.4 * kRadius;
    for (const int node : {OneCrossing::kEdge, OneCrossing::kEdge + 1})
    {
      EXPECT_LE(contacts.marginOf(node), std::max(usual, clearance)) << gap;
      EXPECT_GE(contacts.marginOf(node), std::max(usual, 0.9 * clearance) - 1e-12) << gap;
    }
  }
}

TEST_F(TrustRegionOverAFloor, RetainsTheWidenedMarginOfASnapThroughWhileTheNextSetIsStale)
{
  snap(8, 0.2e-3);
  const double free = contacts_.marginOf(8);
  EXPECT_EQ(truncation(motionOf(8, 0.25 * free)), 1.0);
  floor_.stale = true;
  contacts_.detect(state_, report_);
  EXPECT_NEAR(truncation(motionOf(8, free)), 0.75, 1e-12);
  EXPECT_NEAR(truncation(motionOf(8, free)), 0.0, 1e-12);
}

TEST_F(TrustRegionOverAFloor, ShiftsTheWidenedMarginWhenNodesAreAddedBeforeTheQueriedOnes)
{
  snap(9, 0.1e-3);
  const double before = contacts_.marginOf(9);
  ASSERT_EQ(contacts_.marginOf(12), settings_.contact_margin);
  Discretisation longer = rod_;
  longer.position.insert(longer.position.begin(), {-0.01, -0.005});
  longer.rest_length.insert(longer.rest_length.begin(), 2, 0.005);
  for (std::vector<double>* values : {&longer.cell_length, &longer.mass, &longer.radius, &longer.friction})
    values->insert(values->begin(), 2, values->front());
  contacts_.resample(longer);
  rod_ = longer;
  EXPECT_EQ(contacts_.marginOf(11), before);
  EXPECT_EQ(contacts_.marginOf(14), settings_.contact_margin);
  contacts_.resample(discretiseUniformly(uniformWire(0.2, kEi, kRadius, 7900.0), kNodes));
  EXPECT_EQ(contacts_.marginOf(11), settings_.contact_margin);  // a new discretisation resets the margins
}

TEST_F(TrustRegionOverAFloor, QueriesNoFreeDistancesWhereContactsDetermineTheBound)
{
  place(0.0, 0.1e-3);
  truncation(randomMotion(5e-3));
  EXPECT_EQ(passes_, 0U);
  place(1e-3, 2e-3);
  truncation(randomMotion(5e-3));
  EXPECT_EQ(passes_, 1U);
}

TEST_F(TrustRegionOverAFloor, SubtractsTheGrowthOfABalloonAndIgnoresItsShrinking)
{
  for (int still = 0; still < 40; ++still)
  {
    setBalloon(5, 1.08e-3);
    place(20e-3, 20e-3);
    truncation(NodalMotion(kNodes, Vector3d::Zero()));
  }
  const double listed = marginOf(1.08e-3);
  ASSERT_LT(listed, 20e-6);
  EXPECT_NEAR(contacts_.marginOf(5), listed, 1e-12);
  place(0.1e-3, 0.1e-3);
  setBalloon(5, 1.05e-3);
  EXPECT_LE(1e-3 * truncation(motionOf(5, 1e-3)), listed + 1e-12);  // less than the margin at a radius of 1.05 mm
  setBalloon(5, 1.08e-3);
  place(0.1e-3, 0.1e-3);
  const double before = contacts_.marginOf(5);
  setBalloon(5, 1.08e-3 + 0.25 * before);
  EXPECT_NEAR(contacts_.marginOf(5), 0.75 * before, 1e-12);
  setBalloon(5, 1.08e-3 + 1.25 * before);
  EXPECT_GT(contacts_.marginOf(5), 0.0);
}

/** A trust region without a contact solver. */
TEST_F(TrustRegionOverAFloor, TruncatesMotionWithinTheReachOnAStaleSetOnly)
{
  const WireSurface surface(rod_);
  ContactQueryBuilder query(rod_, boundary_, settings_, surface);
  ContactTrustRegion region(rod_, settings_, surface, query);
  contact::ContactSet set;
  query.beginStep(StepInput(), &floor_, passes_, timer_);
  query.detect(state_, set, report_);
  region.update(set.features);
  EXPECT_EQ(region.reach(4), settings_.contact_margin);
  EXPECT_EQ(region.truncation(state_, motionOf(4, 0.99 * settings_.contact_margin), 1.0, set, report_), 1.0);
  EXPECT_EQ(region.truncation(state_, motionOf(4, 0.99 * settings_.contact_margin), 0.5, set, report_), 0.5);
  set.stale = true;
  region.setStaleBudget(0.25);
  EXPECT_NEAR(region.truncation(state_, motionOf(4, settings_.contact_margin), 1.0, set, report_), 0.25, 1e-12);
}

}  // namespace
}  // namespace endovascular_sim::rod
