#include "rod/sampling/sampling_tree.h"

#include <gtest/gtest.h>

namespace endovascular_sim::rod
{
namespace
{

SamplingSettings settings()
{
  SamplingSettings settings;
  settings.max_edge = 1.5e-3;
  settings.turn_per_edge = 0.1;
  settings.min_age = 3;
  return settings;
}

/** Demands for a curvature that depends on the arc length. */
template <typename Curvature>
std::vector<SamplingDemand> demands(const SamplingTree& tree, Curvature curvature)
{
  std::vector<SamplingDemand> demand;
  for (const SamplingLeaf& leaf : tree.leaves())
  {
    const double middle = 0.5 * (tree.position(leaf.begin) + tree.position(leaf.end()));
    demand.push_back({curvature(middle), tree.coarsestLevel(), settings().min_age});
  }
  return demand;
}

void expectFillsTheWire(const SamplingTree& tree, double length)
{
  std::int64_t reached = 0;
  for (const SamplingLeaf& leaf : tree.leaves())
  {
    ASSERT_EQ(leaf.begin, reached);
    ASSERT_EQ(leaf.begin % (std::int64_t{1} << leaf.level), 0);
    reached = leaf.end();
  }
  EXPECT_EQ(tree.position(reached), length);
}

int largestStep(const SamplingTree& tree)
{
  int largest = 0;
  for (std::size_t j = 1; j < tree.leaves().size(); ++j)
    largest = std::max(largest, std::abs(tree.leaves()[j].level - tree.leaves()[j - 1].level));
  return largest;
}

TEST(SamplingTree, HasThePublishedEdgeLengthsIfTheWireIsAMultipleOfTheRootLength)
{
  const SamplingTree tree(0.150, settings());
  EXPECT_EQ(tree.coarsestLevel(), 2);
  EXPECT_NEAR(tree.edge(0), 0.375e-3, 1e-15);
  EXPECT_NEAR(tree.edge(2), 1.5e-3, 1e-15);
  EXPECT_EQ(tree.nodes(), 101);
}

TEST(SamplingTree, ScalesItsEdgesToAnyLengthOfWire)
{
  for (const double length : {0.0031, 0.1234, 0.45, 1.1})
  {
    const SamplingTree tree(length, settings());
    expectFillsTheWire(tree, length);
    EXPECT_LE(tree.edge(tree.coarsestLevel()), 1.5e-3 * (1.0 + 1e-9));
    EXPECT_LE(tree.edge(tree.fineLevel()), 0.5e-3);
    EXPECT_GT(tree.edge(tree.fineLevel() + 1), 0.5e-3);
  }
}

TEST(SamplingTree, SplitsWhereItBendsAndKeepsNeighboursWithinOneLevel)
{
  SamplingTree tree(0.150, settings());
  const auto bend = [](double s) { return s > 0.070 && s < 0.073 ? 500.0 : 0.0; };
  while (tree.update(demands(tree, bend)))
    EXPECT_LE(largestStep(tree), 1);
  expectFillsTheWire(tree, 0.150);
  for (const SamplingLeaf& leaf : tree.leaves())
  {
    const double middle = 0.5 * (tree.position(leaf.begin) + tree.position(leaf.end()));
    if (bend(middle) > 0.0)
    {
      EXPECT_EQ(leaf.level, 0) << middle;
    }
    if (std::abs(middle - 0.0715) > 8e-3)
    {
      EXPECT_EQ(leaf.level, 2) << middle;
    }
  }
}

TEST(SamplingTree, ReturnsToItsFirstLeavesAfterTheBendIsGone)
{
  SamplingTree tree(0.150, settings());
  std::vector<double> before;
  std::vector<double> after;
  tree.positions(before);
  for (int k = 0; k < 20; ++k)
    tree.update(demands(tree, [](double s) { return s < 0.05 ? 300.0 : 0.0; }));
  EXPECT_GT(tree.nodes(), 150);
  for (int k = 0; k < 40; ++k)
    tree.update(demands(tree, [](double) { return 0.0; }));
  tree.positions(after);
  EXPECT_EQ(before, after);
}

TEST(SamplingTree, DoesNotAlternateWhereTheCurvatureVariesAboutTheThreshold)
{
  SamplingTree tree(0.150, settings());
  const double threshold = settings().turn_per_edge / 1.5e-3;
  int changes = 0;
  for (int k = 0; k < 200; ++k)
  {
    const double curvature = threshold * (k % 2 == 0 ? 1.05 : 0.8);
    changes += tree.update(demands(tree, [curvature](double) { return curvature; }));
  }
  EXPECT_EQ(changes, 1);
}

TEST(SamplingTree, MergesOnlyLeavesOfTheLeastAge)
{
  SamplingTree tree(0.150, settings());
  tree.update(demands(tree, [](double) { return 100.0; }));
  int updates = 1;
  while (!tree.update(demands(tree, [](double) { return 0.0; })))
    ++updates;
  EXPECT_EQ(updates, settings().min_age);
}

TEST(SamplingTree, RefinesBelowItsFineLevelOnDemandOnly)
{
  SamplingSettings with_extra = settings();
  with_extra.extra_levels = 2;
  SamplingTree tree(0.150, with_extra);
  std::vector<SamplingDemand> demand;
  const auto round = [&](int coarsest_of_first, double curvature)
  {
    demand.assign(tree.leaves().size(), {curvature, tree.coarsestLevel(), 0});
    demand[0].coarsest = coarsest_of_first;
    return tree.update(demand);
  };
  while (round(tree.coarsestLevel(), 1e5))
  {
  }
  for (const SamplingLeaf& leaf : tree.leaves())
    EXPECT_EQ(leaf.level, tree.fineLevel());
  while (round(0, 1e5))
  {
  }
  EXPECT_EQ(tree.leaves().front().level, 0);
  EXPECT_EQ(tree.leaves().back().level, tree.fineLevel());
  for (int k = 0; k < 10; ++k)
    round(tree.coarsestLevel(), 1e5);
  EXPECT_EQ(tree.leaves().front().level, tree.fineLevel());
}

}  // namespace
}  // namespace endovascular_sim::rod
