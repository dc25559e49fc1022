#include "contact/rollers.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kMargin = 0.25e-3;

Query queryOf(const std::vector<Eigen::Vector3d>& nodes, double radius = 4e-4, double margin = kMargin)
{
  Query query;
  query.step = 3;
  query.pass = 2;
  query.first_node = 5;
  query.nodes = nodes;
  query.radius.assign(nodes.size(), radius);
  query.margin.assign(nodes.size(), margin);
  return query;
}

Rollers oneRoller(const Eigen::Vector3d& position, double radius = 6e-3)
{
  return Rollers({{position, Eigen::Vector3d::UnitZ(), radius, 0.0}});
}

ContactSet detected(Rollers rollers, const Query& query)
{
  ContactSet set;
  rollers.detect(query, set);
  return set;
}

TEST(Rollers, TouchAWireInsideAnEdge)
{
  const ContactSet set = detected(oneRoller({2.5e-3, -6.5e-3, 0.0}), queryOf({{0, 0, 0}, {2e-3, 0, 0}, {4e-3, 0, 0}}));
  ASSERT_EQ(set.features.size(), 1U);
  const Feature& feature = set.features[0];
  EXPECT_EQ(feature.edge, 6);
  EXPECT_NEAR(feature.parameter, 0.25, 1e-12);
  EXPECT_NEAR(feature.gap, 1e-4, 1e-15);
  EXPECT_TRUE(feature.normal.isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(feature.point.isApprox(Eigen::Vector3d(2.5e-3, -5e-4, 0.0)));
  EXPECT_EQ(set.step, 3U);
  EXPECT_EQ(set.pass, 2U);
  EXPECT_EQ(set.first_edge, 5);
  ASSERT_EQ(set.free_distance.size(), 2U);
  EXPECT_EQ(set.free_distance[0], kMargin);
}

TEST(Rollers, TouchAWireThatBulgesTowardsThemAtANode)
{
  const ContactSet set = detected(oneRoller({0, -6.4e-3, 0}), queryOf({{-2e-3, 2e-4, 0}, {0, 0, 0}, {2e-3, 2e-4, 0}}));
  ASSERT_EQ(set.features.size(), 1U);
  EXPECT_EQ(set.features[0].edge + set.features[0].parameter, 6.0);
  EXPECT_NEAR(set.features[0].gap, 0.0, 1e-15);
}

TEST(Rollers, TouchBothEdgesOfAWireThatBendsAroundThem)
{
  const ContactSet set = detected(oneRoller({0, 6.4e-3, 0}), queryOf({{-2e-3, 2e-4, 0}, {0, 0, 0}, {2e-3, 2e-4, 0}}));
  ASSERT_EQ(set.features.size(), 2U);
  EXPECT_EQ(set.features[0].edge, 5);
  EXPECT_EQ(set.features[1].edge, 6);
  EXPECT_NEAR(set.features[0].gap, set.features[1].gap, 1e-15);
  EXPECT_LT(set.features[0].normal.y(), 0.0);
}

TEST(Rollers, BeyondTheMarginAreNotListed)
{
  EXPECT_TRUE(
      detected(oneRoller({0, -6.4e-3 - 2 * kMargin, 0}), queryOf({{-2e-3, 0, 0}, {2e-3, 0, 0}})).features.empty());
}

TEST(Rollers, FollowTheirMovement)
{
  Rollers rollers = oneRoller({0, -8e-3, 0});
  rollers.moveTo(0, {0, -6.4e-3, 0});
  EXPECT_EQ(detected(rollers, queryOf({{-2e-3, 0, 0}, {2e-3, 0, 0}})).features.size(), 1U);
}

/** Least distance of an edge from the axis by samples. */
double sampledDistance(const Roller& roller, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  double least = 1e9;
  for (int k = 0; k <= 2000; ++k)
    least = std::min(least, distanceFromAxis(roller, a + k / 2000.0 * (b - a)));
  return least;
}

TEST(Rollers, AgreeWithBruteForceForRandomWiresAndAxes)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
  int found = 0;
  for (int run = 0; run < 300; ++run)
  {
    const Roller roller{2e-3 * vector(), vector().normalized(), 1e-3, 0.0};
    std::vector<Eigen::Vector3d> nodes = {4e-3 * vector()};
    for (int k = 0; k < 6; ++k)
      nodes.push_back(nodes.back() + 1.5e-3 * vector());
    const Query query = queryOf(nodes, 1e-4, 1e-3);
    Rollers rollers({roller});
    const ContactSet set = detected(rollers, query);
    ContactSet free;
    rollers.freeDistances(query, 5e-3, free);
    double nearest = 1e9;
    for (std::size_t j = 0; j + 1 < nodes.size(); ++j)
    {
      const double gap = sampledDistance(roller, nodes[j], nodes[j + 1]) - roller.radius - 1e-4;
      nearest = std::min(nearest, gap);
      EXPECT_LE(free.free_distance[j], std::max(gap, 1e-3) + 1e-9);
    }
    double listed = 1e9;
    for (const Feature& feature : set.features)
    {
      const std::size_t j = static_cast<std::size_t>(feature.edge - query.first_node);
      const Eigen::Vector3d on_wire = nodes[j] + feature.parameter * (nodes[j + 1] - nodes[j]);
      EXPECT_NEAR(feature.gap, feature.normal.dot(on_wire - feature.point) - 1e-4, 1e-12);
      EXPECT_NEAR(distanceFromAxis(roller, feature.point), roller.radius, 1e-12);
      listed = std::min(listed, feature.gap);
    }
    if (nearest < 1e-3 - 1e-6)
    {
      ++found;
      EXPECT_NEAR(listed, nearest, 1e-6) << run;
    }
  }
  EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace endovascular_sim::contact
