#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "flow/body/body_flow.h"
#include "test/flow/body/natural_anatomy.h"

namespace endovascular_sim::flow
{
namespace
{

/** Steps of the flow: 20,000, or the environment variable FLOW_STEPS. */
int steps()
{
  const char* text = std::getenv("FLOW_STEPS");
  return text != nullptr ? std::max(1, std::atoi(text)) : 20000;
}

/** Random events in the natural anatomy, each of some seconds. */
class ExtremeFlow : public testing::Test
{
protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  bool happens(double probability) { return uniform(0.0, 1.0) < probability; }
  std::size_t anyCell() { return static_cast<std::size_t>(uniform(0.0, static_cast<double>(cells.size()))); }

  double healthyRadius(std::size_t cell) const { return std::sqrt(cells[cell].wall.area / M_PI); }

  /** Stenosis of 95 % of the diameter over a cell. */
  LumenProfile stenosis(std::size_t cell) const
  {
    const CellPlace& place = body.vessel().places[cell];
    const double middle = 0.5 * (place.begin + place.end), healthy = cells[cell].wall.area;
    return {place.branch, {place.begin, middle, place.end}, {healthy, 0.05 * 0.05 * healthy, healthy}};
  }

  /** New rate, lesion, closures and resistances. */
  void change()
  {
    const double rates[] = {30.0, 70.0, 220.0, 0.0};  // per minute
    body.heart().setRate(rates[static_cast<std::size_t>(uniform(0.0, 4.0))] / 60.0);
    if (happens(0.2))
      body.setHyperaemia(!body.isHyperaemic());
    if (happens(0.2))
      body.setMeanPressure(uniform(4e3, 2.4e4));
    lumens.clear();
    spans.clear();
    if (happens(0.7))
    {
      const std::size_t cell = anyCell();
      lumens.push_back(stenosis(cell));
      const CellPlace& place = body.vessel().places[cell];
      if (happens(0.5))  // a full balloon
        spans.push_back({place.branch, place.begin - 0.01, place.end + 0.01, healthyRadius(cell)});
    }
    for (int k = 0; k < 3; ++k)
    {
      const std::size_t cell = anyCell();
      const CellPlace& place = body.vessel().places[cell];
      if (happens(0.5))
        spans.push_back({place.branch, place.begin - 0.05, place.end, uniform(0.1, 1.1) * healthyRadius(cell)});
    }
  }

  void expectPossibleValues(int step) const
  {
    const FlowNetwork& network = body.network();
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
    {
      ASSERT_TRUE(std::isfinite(network.flow(cell))) << step << ", cell " << cell;
      ASSERT_GT(network.area(cell), 0.0) << step << ", cell " << cell;
    }
    for (std::size_t node = 0; node <= cells.size(); ++node)
    {
      ASSERT_TRUE(std::isfinite(network.pressure(node))) << step << ", node " << node;
      ASSERT_GT(network.volume(node), 0.0) << step << ", node " << node;
    }
    for (const InstrumentSpan& span : spans)
      ASSERT_TRUE(std::isfinite(body.pressureAt(span.branch, span.end))) << step;
  }

  const vessel::CentrelineTree tree = naturalCentreline();
  BodyFlow body{tree, readCirculation(PROJECT_DIR "/config/hemodynamics/adult.yaml"), 5e-3,
                std::vector<bool>(tree.branches.size(), false)};
  const std::vector<FlowCell>& cells = body.vessel().tree.cells;
  std::vector<LumenProfile> lumens;
  std::vector<InstrumentSpan> spans;
  std::mt19937 random{11};
};

TEST_F(ExtremeFlow, HasFiniteValuesAndPositiveAreasAndConservesBlood)
{
  const FlowNetwork& network = body.network();
  const double initial = network.totalVolume() - network.entered() - network.supplied() + network.left();
  const int count = steps();
  for (int k = 0; k < count; ++k)
  {
    if (k % 250 == 0)
      change();
    for (InstrumentSpan& span : spans)
      span.end += uniform(-1e-3, 1e-3);
    body.setObstruction(lumens, spans);
    body.step();
    expectPossibleValues(k);
    if (HasFatalFailure())
      return;
  }
  const double present = network.totalVolume() - network.entered() - network.supplied() + network.left();
  EXPECT_LT(std::abs(present - initial), 1e-9 * network.entered());
  EXPECT_LT(network.supplied(), 0.02 * network.entered());
  // The circulation returns to rest.
  body.setObstruction({}, {});
  body.setHyperaemia(false);
  body.setMeanPressure(body.circulation().mean_pressure);
  body.heart().setRate(body.circulation().heart.rate);
  const unsigned begin = body.heart().beats() + 20;
  double sum = 0.0;
  int samples = 0;
  while (body.heart().beats() <= begin)
  {
    body.step();
    sum += body.heart().beats() == begin ? body.rootPressure() : 0.0;
    samples += body.heart().beats() == begin ? 1 : 0;
  }
  EXPECT_NEAR(sum / samples, body.circulation().mean_pressure, 0.01 * body.circulation().mean_pressure);
}

}  // namespace
}  // namespace endovascular_sim::flow
