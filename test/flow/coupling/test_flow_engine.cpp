#include "flow/coupling/flow_engine.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "common/archive.h"
#include "flow/coupling/flow_places.h"
#include "test/flow/body/natural_anatomy.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kStep = 5e-3;

const Circulation& adult()
{
  static const Circulation circulation = readCirculation(PROJECT_DIR "/config/hemodynamics/adult.yaml");
  return circulation;
}

FlowEngine engineOf(const vessel::CentrelineTree& centreline)
{
  return FlowEngine(centreline, {}, adult(), kStep, {{0.0, 15.0, 0.3}});
}

/** Request at rest, with a pressure line in the root. */
FlowRequest requestAtRest()
{
  FlowRequest request;
  request.controls = {adult().heart.rate, adult().mean_pressure, false};
  request.probes = {{0, 0.01}};
  return request;
}

FlowAnswer next(FlowEngine& engine, FlowRequest& request)
{
  FlowAnswer answer;
  engine.step(request, answer);
  request.state = answer.state;
  ++request.step;
  return answer;
}

TEST(FlowEngine, StepsAsAFunctionOfItsRequestAlone)
{
  FlowEngine of_two_runs = engineOf(naturalCentreline()), of_one_run = engineOf(naturalCentreline());
  FlowRequest first = requestAtRest(), other = requestAtRest(), alone = requestAtRest();
  other.controls.heart_rate = 2.0;
  other.instruments = {{0, 0.0, 0.1, 2e-3}};
  for (int k = 0; k < 100; ++k)
  {
    const FlowAnswer mixed = next(of_two_runs, first);
    next(of_two_runs, other);
    const FlowAnswer pure = next(of_one_run, alone);
    ASSERT_EQ(mixed.state, pure.state) << "step " << k;
    ASSERT_EQ(mixed.field.pressures, pure.field.pressures);
    ASSERT_EQ(mixed.field.readings, pure.field.readings);
  }
  EXPECT_NE(first.state, other.state);
}

TEST(FlowEngine, GivesMeanPressuresOfEachBeat)
{
  FlowEngine engine = engineOf(naturalCentreline());
  FlowRequest request = requestAtRest();
  FlowAnswer answer;
  double sum = 0.0;
  int samples = 0;
  std::uint32_t beats = 0;
  for (int k = 0; k < 800; ++k)
  {
    answer = next(engine, request);
    if (k > 0 && answer.field.beats != beats && samples > 100)
    {
      EXPECT_NEAR(answer.field.means.root, sum / samples, 1e-9 * sum / samples);
      sum = 0.0;
      samples = 0;
    }
    else if (answer.field.beats != beats)
      sum = samples = 0;
    beats = answer.field.beats;
    sum += answer.field.pressures[0];
    ++samples;
  }
  EXPECT_NEAR(answer.field.means.root, adult().mean_pressure, 0.02 * adult().mean_pressure);
  EXPECT_NEAR(answer.field.means.readings[0], answer.field.means.root, 0.02 * answer.field.means.root);
}

TEST(FlowEngine, RefusesAStateOfAnotherVessel)
{
  vessel::CentrelineTree centreline = naturalCentreline();
  FlowEngine whole = engineOf(centreline);
  centreline.branches.resize(1);
  FlowEngine trunk = engineOf(centreline);
  FlowRequest request = requestAtRest();
  next(whole, request);
  FlowAnswer answer;
  EXPECT_THROW(trunk.step(request, answer), ArchiveError);
}

TEST(FlowEngine, RefusesARequestWithoutThePlacesOfItsLines)
{
  FlowEngine engine = engineOf(naturalCentreline());
  FlowRequest request = requestAtRest();
  request.probes.clear();
  FlowAnswer answer;
  EXPECT_THROW(engine.step(request, answer), std::invalid_argument);
}

TEST(FlowControls, AreRefusedOutsideOfWhatAPersonCanHave)
{
  EXPECT_EQ(refusalOf({0.0, 12e3, false}), "");
  EXPECT_EQ(refusalOf({3.7, 12e3, true}), "");
  EXPECT_NE(refusalOf({0.1, 12e3, false}).find("heart_rate"), std::string::npos);
  EXPECT_NE(refusalOf({400.0 / 60.0, 12e3, false}).find("heart_rate"), std::string::npos);
  EXPECT_NE(refusalOf({1.0, 1e3, false}).find("mean_pressure"), std::string::npos);
  EXPECT_NE(refusalOf({std::nan(""), 12e3, false}).find("heart_rate"), std::string::npos);
  EXPECT_NE(refusalOf({1.0, std::nan(""), false}).find("mean_pressure"), std::string::npos);
}

TEST(FlowPlaces, FindTheCellOfAPlaceAsTheCirculationDoes)
{
  const vessel::CentrelineTree centreline = naturalCentreline();
  const FlowEngine engine = engineOf(centreline);
  const FlowPlaces places(engine.body().vessel(), centreline.branches.size());
  for (std::size_t branch = 0; branch < centreline.branches.size(); ++branch)
    for (const double arc : {0.0, 0.005, 0.02, 0.05, 0.3})
    {
      const int found = places.cellAt({static_cast<int>(branch), arc});
      if (found < 0)
        continue;
      EXPECT_EQ(static_cast<std::size_t>(found), engine.body().cellAt(static_cast<int>(branch), arc));
    }
}

}  // namespace
}  // namespace endovascular_sim::flow
