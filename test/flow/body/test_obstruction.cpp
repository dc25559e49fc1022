#include "flow/body/obstruction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "test/flow/body/natural_anatomy.h"

namespace endovascular_sim::flow
{
namespace
{

TEST(Annulus, HasTheResistanceOfTheFormulaAndOfTwoPlatesWhereItIsNarrow)
{
  EXPECT_EQ(annulusFactor(0.0), 1.0);
  EXPECT_NEAR(annulusFactor(1e-4), 1.0, 0.15) << "a thin wire is felt, logarithmically";
  // Narrow gap h = R − a: Q = Δp π R h³/(6 µ L) for h → 0, relative to π R⁴/(8 µ L).
  const double gap = 1e-3;
  EXPECT_NEAR(annulusFactor(1.0 - gap) * std::pow(gap, 3) * 8.0 / 6.0, 1.0, 0.01);
  EXPECT_TRUE(std::isinf(annulusFactor(1.0)));
}

/** Obstacle of a cell with a jet of its own, from samples in the middle of 0.25 mm each. */
FlowObstacle sampledObstacle(const FlowCell& cell, const CellPlace& place, const FlowSettings& blood,
                             const std::vector<LumenProfile>& lumens, const std::vector<InstrumentSpan>& instruments)
{
  const int samples = std::max(2, static_cast<int>(std::ceil((place.end - place.begin) / 2.5e-4)));
  const double healthy = cell.wall.area;
  double extra = 0.0, narrowest = healthy, blocked = 0.0;
  for (int k = 0; k < samples; ++k)
  {
    const double arc = place.begin + (place.end - place.begin) * (k + 0.5) / samples;
    double lumen = healthy, radius = 0.0;
    for (const LumenProfile& profile : lumens)
      if (profile.branch == place.branch)
        lumen = profile.areaAt(arc, lumen);
    for (const InstrumentSpan& span : instruments)
      if (span.branch == place.branch && arc >= span.begin && arc <= span.end)
        radius = std::max(radius, span.radius);
    const double free = lumen - M_PI * radius * radius;
    if (free <= (radius > 0.0 ? 0.02 : 1e-3) * healthy)
      return {std::numeric_limits<double>::infinity(), 0.0, 0.0};
    narrowest = std::min(narrowest, free);
    const double ratio = radius / std::sqrt(lumen / M_PI);
    extra += (ratio < 1e-3 ? 1.0 : annulusFactor(ratio)) / (lumen * lumen) - 1.0 / (healthy * healthy);
    blocked += M_PI * radius * radius / samples;
  }
  const double jet = healthy / narrowest - 1.0, friction = 2.0 * (cell.profile + 2.0) * M_PI * blood.viscosity;
  return {std::min(blocked, 0.5 * healthy), std::max(friction * extra / samples * (place.end - place.begin), 0.0),
          1.52 * blood.density / (2.0 * healthy * healthy) * jet * jet};
}

std::vector<FlowObstacle> sampledObstacles(const VesselFlowTree& vessel, const FlowSettings& blood,
                                           const std::vector<LumenProfile>& lumens,
                                           const std::vector<InstrumentSpan>& instruments)
{
  std::vector<FlowObstacle> obstacles;
  for (std::size_t k = 0; k < vessel.places.size(); ++k)
    obstacles.push_back(sampledObstacle(vessel.tree.cells[k], vessel.places[k], blood, lumens, instruments));
  const std::vector<FlowObstacle> own = obstacles;
  for (std::size_t k = 0; k + 1 < own.size(); ++k)
    if (vessel.tree.cells[k].to == vessel.tree.cells[k + 1].from)
      obstacles[own[k].loss < own[k + 1].loss ? k : k + 1].loss = 0.0;
  return obstacles;
}

/** Natural anatomy with short cells in every third branch. */
class ObstructionOfCells : public testing::Test
{
protected:
  ObstructionOfCells()
  {
    std::vector<bool> fine;
    for (std::size_t b = 0; b < tree.branches.size(); ++b)
      fine.push_back(b % 3 == 0);
    vessel = vesselFlowTree(tree, Circulation(), {}, fine);
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  int anyBranch() { return std::uniform_int_distribution<int>(0, static_cast<int>(tree.branches.size()) - 1)(random); }

  /** Lumen of random areas. */
  LumenProfile anyLumen(int branch, double begin)
  {
    LumenProfile lumen;
    lumen.branch = branch;
    const CellRange& range = vessel.ranges[static_cast<std::size_t>(branch)];
    const double healthy = range.begin < range.end ? vessel.tree.cells[range.begin].wall.area : 1e-5;
    for (int k = 0; k < 20; ++k)
    {
      lumen.arcs.push_back(begin + 5e-4 * k);
      lumen.areas.push_back(healthy * uniform(0.1, 1.1));
    }
    return lumen;
  }

  const vessel::CentrelineTree tree = naturalCentreline();
  const FlowSettings blood;
  VesselFlowTree vessel;
  std::mt19937 random{7};
};

TEST_F(ObstructionOfCells, IsThatOfTheSamplesAndOfAFreshObjectAfterEachOfManyMoves)
{
  Obstruction moved(vessel, blood);
  std::vector<FlowObstacle> known(vessel.places.size());
  std::vector<LumenProfile> lumens;
  std::vector<InstrumentSpan> spans;
  int with_jet = 0, closed = 0;
  for (int move = 0; move < 500; ++move)
  {
    if (move % 25 == 0)
      lumens = {anyLumen(anyBranch(), 0.01), anyLumen(anyBranch(), 0.03)};
    if (move % 50 == 49)
      lumens.clear();
    if (move % 10 == 0)
    {
      spans.clear();
      for (int k = 0; k < 6; ++k)
        spans.push_back({anyBranch(), uniform(-0.01, 0.03), uniform(0.02, 0.2), uniform(1e-4, 2e-3)});
      for (const LumenProfile& lumen : lumens)
      {
        spans.push_back({lumen.branch, -0.01, uniform(0.005, 0.045), uniform(1e-4, 5e-4)});
        spans.push_back({lumen.branch, uniform(0.005, 0.045), 0.05, uniform(1e-4, 5e-4)});
      }
    }
    for (InstrumentSpan& span : spans)
    {
      span.begin += uniform(-1e-3, 1e-3);
      span.end += uniform(-1e-3, 1e-3);
    }
    for (const std::size_t cell : moved.update(lumens, spans))
      known[cell] = moved.obstacle(cell);
    Obstruction fresh(vessel, blood);
    fresh.update(lumens, spans);
    const std::vector<FlowObstacle> sampled = sampledObstacles(vessel, blood, lumens, spans);
    for (std::size_t cell = 0; cell < known.size(); ++cell)
    {
      ASSERT_TRUE(moved.obstacle(cell) == fresh.obstacle(cell)) << move << ", " << cell;
      ASSERT_TRUE(known[cell] == fresh.obstacle(cell)) << move << ", " << cell;
      ASSERT_EQ(fresh.obstacle(cell).blocked, sampled[cell].blocked) << move << ", " << cell;
      ASSERT_EQ(fresh.obstacle(cell).resistance, sampled[cell].resistance) << move << ", " << cell;
      ASSERT_EQ(fresh.obstacle(cell).loss, sampled[cell].loss) << move << ", " << cell;
      with_jet += sampled[cell].loss > 0.0 ? 1 : 0;
      closed += std::isinf(sampled[cell].blocked) ? 1 : 0;
    }
  }
  EXPECT_GT(with_jet, 1000);
  EXPECT_GT(closed, 100);
}

TEST_F(ObstructionOfCells, ChangesOnlyWhereSomethingMoved)
{
  Obstruction obstruction(vessel, blood);
  const LumenProfile lumen = anyLumen(0, 0.03);
  EXPECT_FALSE(obstruction.update({lumen}, {{0, 0.0, 0.06, 1e-3}, {0, 0.0, 0.08, 2e-4}}).empty());
  EXPECT_TRUE(obstruction.update({lumen}, {{0, 0.0, 0.06, 1e-3}, {0, 0.0, 0.08, 2e-4}}).empty());
  EXPECT_LE(obstruction.update({lumen}, {{0, 0.0, 0.0603, 1e-3}, {0, 0.0, 0.0803, 2e-4}}).size(), 4U);
  obstruction.update({}, {});
  for (std::size_t cell = 0; cell < vessel.places.size(); ++cell)
    EXPECT_TRUE(obstruction.obstacle(cell) == FlowObstacle());
}

TEST_F(ObstructionOfCells, HasItsDropAtTheInstrumentAndThatOfTheJetBehindIt)
{
  Obstruction obstruction(vessel, blood);
  const CellRange& range = vessel.ranges[0];
  const std::size_t cell = (range.begin + range.end) / 2;
  const CellPlace& place = vessel.places[cell];
  const double length = place.end - place.begin, area = vessel.tree.cells[cell].wall.area;
  const auto share = [&](double along, double flow)
  { return obstruction.dropUpTo(cell, place.begin + along * length, area, flow); };
  EXPECT_NEAR(share(0.3, 1e-4), 0.3, 1e-12) << "without an instrument";
  obstruction.update({}, {{0, place.begin + 0.25 * length, place.begin + 0.75 * length, std::sqrt(0.9 * area / M_PI)}});
  EXPECT_LT(share(0.2, 1e-9), 0.01);
  EXPECT_NEAR(share(0.5, 1e-9), 0.5, 0.01) << "viscous at a small flow";
  EXPECT_GT(share(0.8, 1e-9), 0.99);
  EXPECT_LT(share(0.6, 10.0), 0.01) << "the jet at a large flow";
  EXPECT_GT(share(0.8, 10.0), 0.99);
  EXPECT_LT(share(0.2, -10.0), 0.01);
  EXPECT_GT(share(0.4, -10.0), 0.99);
  for (const double flow : {-1e-4, 1e-4})
  {
    EXPECT_EQ(share(-1.0, flow), 0.0);
    EXPECT_NEAR(share(2.0, flow), 1.0, 1e-12);
    for (double along = 0.0; along < 1.0; along += 0.01)
      EXPECT_LE(share(along, flow), share(along + 0.01, flow));
  }
}

TEST_F(ObstructionOfCells, IsThatOfOneInstrumentForAnInstrumentInPieces)
{
  Obstruction whole(vessel, blood), pieces(vessel, blood);
  whole.update({}, {{0, 0.0, 0.05, 1e-3}});
  std::vector<InstrumentSpan> spans;
  for (int k = 0; k < 50; ++k)
    spans.push_back({0, 1e-3 * k, 1e-3 * (k + 1), 1e-3});
  pieces.update({}, spans);
  for (std::size_t cell = 0; cell < vessel.places.size(); ++cell)
    EXPECT_TRUE(whole.obstacle(cell) == pieces.obstacle(cell)) << cell;
}

TEST_F(ObstructionOfCells, IgnoresWhatIsNowhere)
{
  Obstruction obstruction(vessel, blood);
  const double nan = std::nan("");
  EXPECT_TRUE(obstruction
                  .update({LumenProfile(), {9999, {0.0, 1.0}, {1e-9, 1e-9}}}, {{-1, 0.0, 1.0, 1e-3},
                                                                               {9999, 0.0, 1.0, 1e-3},
                                                                               {0, 0.2, 0.1, 1e-3},
                                                                               {0, nan, 0.1, 1e-3},
                                                                               {0, 0.0, nan, 1e-3},
                                                                               {0, 0.0, 0.1, nan},
                                                                               {0, 0.0, 0.1, 0.0}})
                  .empty());
}

}  // namespace
}  // namespace endovascular_sim::flow
