#include "rod/contact/node_renumbering.h"

#include <vector>

#include <gtest/gtest.h>

namespace endovascular_sim::rod
{
namespace
{

Discretisation withNodesAt(const std::vector<double>& positions)
{
  Discretisation rod;
  rod.position = positions;
  rod.radius.assign(positions.size(), 1e-4);
  return rod;
}

TEST(NodeRange, IsTheSmallestRangeThatContainsAllAddedOnes)
{
  NodeRange range;
  EXPECT_TRUE(range.empty());
  range.add({7, 9});
  range.add({3, 4});
  range.add({});
  EXPECT_EQ(range.begin, 3);
  EXPECT_EQ(range.end, 9);
  EXPECT_TRUE(range.contains(8));
  EXPECT_FALSE(range.contains(9));
}

TEST(NodeRenumbering, IsAShiftWhereTheDistalNodesAreTheSame)
{
  const Discretisation from = withNodesAt({0.0, 0.2, 0.3, 0.4});
  const NodeRenumbering added(from, withNodesAt({0.0, 0.05, 0.1, 0.2, 0.3, 0.4}), 1);
  EXPECT_TRUE(added.isShift());
  EXPECT_EQ(added.shift(), 2);
  EXPECT_FALSE(NodeRenumbering(from, withNodesAt({0.0, 0.2, 0.35, 0.4}), 1).isShift());
  EXPECT_FALSE(NodeRenumbering(from, withNodesAt({0.3, 0.4}), 1).isShift());
  EXPECT_TRUE(NodeRenumbering(from, withNodesAt({0.3, 0.4}), 2).isShift());
}

TEST(NodeRenumbering, ShiftsValuesAndRangesOrDiscardsThem)
{
  const Discretisation from = withNodesAt({0.0, 0.2, 0.3, 0.4});
  const NodeRenumbering added(from, withNodesAt({0.0, 0.1, 0.2, 0.3, 0.4}), 1);
  const NodeRenumbering removed(from, withNodesAt({0.2, 0.3, 0.4}), 1);
  const NodeRenumbering changed(from, withNodesAt({0.0, 0.4}), 1);
  std::vector<double> values = {1.0, 2.0, 3.0, 4.0};
  added.apply(values);
  EXPECT_EQ(values, (std::vector<double>{1.0, 1.0, 2.0, 3.0, 4.0}));
  values = {1.0, 2.0, 3.0, 4.0};
  removed.apply(values);
  EXPECT_EQ(values, (std::vector<double>{2.0, 3.0, 4.0}));
  changed.apply(values);
  EXPECT_TRUE(values.empty());
  NodeRange range{0, 2};
  removed.apply(range);
  EXPECT_EQ(range.begin, 0);
  EXPECT_EQ(range.end, 1);
  changed.apply(range);
  EXPECT_TRUE(range.empty());
}

}  // namespace
}  // namespace endovascular_sim::rod
