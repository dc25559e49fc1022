#include "contact/contract/contact_set_validation.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::contact
{
namespace
{

/** Three nodes along x, 1 mm apart, beginning at node 5; the wall is the plane z = −0.5 mm. */
Query query()
{
  Query query;
  query.step = 7;
  query.substep = 1;
  query.pass = 3;
  query.first_node = 5;
  query.nodes = {{0.0, 0.0, 0.0}, {1e-3, 0.0, 0.0}, {2e-3, 0.0, 0.0}};
  query.radius = {0.3e-3, 0.3e-3, 0.1e-3};
  return query;
}

ContactSet answer()
{
  ContactSet set;
  set.step = 7;
  set.substep = 1;
  set.pass = 3;
  set.first_edge = 5;
  set.free_distance = {0.2e-3, std::numeric_limits<double>::infinity()};
  Feature feature;
  feature.edge = 6;
  feature.parameter = 0.5;
  feature.point = {1.5e-3, 0.0, -0.5e-3};
  feature.normal = Eigen::Vector3d::UnitZ();
  feature.gap = 0.3e-3;
  feature.friction = 0.1;
  set.features = {feature};
  return set;
}

TEST(ContactSetValidation, AcceptsAnAnswerToTheQuery)
{
  EXPECT_TRUE(isValidAnswer(query(), answer()));
}

TEST(ContactSetValidation, RejectsEveryCorruptedField)
{
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<const char*, std::function<void(ContactSet&)>>> faults = {
      {"an older step", [](ContactSet& set) { --set.step; }},
      {"a later step", [](ContactSet& set) { ++set.step; }},
      {"another sub-step", [](ContactSet& set) { set.substep = 0; }},
      {"another pass", [](ContactSet& set) { set.pass = 2; }},
      {"other edges", [](ContactSet& set) { set.first_edge = 4; }},
      {"one edge too few", [](ContactSet& set) { set.free_distance.pop_back(); }},
      {"one edge too many", [](ContactSet& set) { set.free_distance.push_back(0.0); }},
      {"no edges", [](ContactSet& set) { set.free_distance.clear(); }},
      {"a free distance that is NaN", [=](ContactSet& set) { set.free_distance[0] = nan; }},
      {"a negative free distance", [](ContactSet& set) { set.free_distance[0] = -1e-3; }},
      {"a negative edge", [](ContactSet& set) { set.features[0].edge = -1; }},
      {"the most negative edge", [](ContactSet& set) { set.features[0].edge = std::numeric_limits<int>::min(); }},
      {"an edge before the first", [](ContactSet& set) { set.features[0].edge = 4; }},
      {"an edge after the last", [](ContactSet& set) { set.features[0].edge = 7; }},
      {"a parameter beyond the edge", [](ContactSet& set) { set.features[0].parameter = 1.5; }},
      {"a parameter that is NaN", [=](ContactSet& set) { set.features[0].parameter = nan; }},
      {"a point that is NaN", [=](ContactSet& set) { set.features[0].point.y() = nan; }},
      {"a normal that is NaN", [=](ContactSet& set) { set.features[0].normal.y() = nan; }},
      {"a normal of another length", [](ContactSet& set) { set.features[0].normal *= 1.01; }},
      {"a gap that is NaN", [=](ContactSet& set) { set.features[0].gap = nan; }},
      {"an infinite gap", [=](ContactSet& set) { set.features[0].gap = -infinity; }},
      {"a gap that is not the plane's", [](ContactSet& set) { set.features[0].gap = -0.3e-3; }},
      {"another wire's radius", [](ContactSet& set) { set.features[0].gap += 0.1e-3; }},
      {"a negative friction", [](ContactSet& set) { set.features[0].friction = -0.1; }},
      {"an infinite friction", [=](ContactSet& set) { set.features[0].friction = infinity; }},
      {"no stiffness", [](ContactSet& set) { set.features[0].stiffness = 0.0; }},
      {"a stiffness that is NaN", [=](ContactSet& set) { set.features[0].stiffness = nan; }},
      {"a clearance that is NaN", [=](ContactSet& set) { set.features[0].clearance_radius = nan; }},
  };
  for (const auto& [name, corrupt] : faults)
  {
    ContactSet set = answer();
    corrupt(set);
    EXPECT_FALSE(isValidAnswer(query(), set)) << name;
  }
}

TEST(ContactSetValidation, AcceptsAnEmptySetForAWireWithoutEdges)
{
  Query nothing;
  EXPECT_TRUE(isValidAnswer(nothing, ContactSet()));
}

}  // namespace
}  // namespace endovascular_sim::contact
