#include "results/report.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace endovascular_sim::results
{
namespace
{

using nlohmann::json;

SessionReport reportOfSteps(std::uint64_t count)
{
  SessionIdentity identity;
  identity.scene_name = "test";
  identity.scene_hash = 0xabcdef;
  identity.time_step = 1e-3;
  SessionReport report(identity);
  for (std::uint64_t step = 0; step < count; ++step)
    report.addStep(step, 100.0 + 2e-3 * static_cast<double>(step), false, step + 7);
  return report;
}

json parsed(const SessionReport& report, const std::string& error = "")
{
  return json::parse(report.json(RecordingOutcome(), error));
}

TEST(RunningValue, HasAbsoluteMaximumAndMeanAndSignedLatestValue)
{
  RunningValue value;
  for (const double sample : {1.0, -4.0, 2.0, -1.0})
    value.add(sample);
  EXPECT_EQ(value.max(), 4.0);
  EXPECT_EQ(value.mean(), 2.0);
  EXPECT_EQ(value.final(), -1.0);
}

TEST(RunningValue, IgnoresNonFiniteSamples)
{
  RunningValue value;
  value.add(3.0);
  value.add(std::numeric_limits<double>::quiet_NaN());
  value.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(value.count(), 1U);
  EXPECT_EQ(value.max(), 3.0);
}

TEST(SessionReport, ComparesSimulatedWithElapsedTime)
{
  const SessionReport report = reportOfSteps(1001);
  EXPECT_NEAR(report.simulatedTime(), 1.001, 1e-12);
  EXPECT_NEAR(report.wallTime(), 2.0, 1e-9);
  ASSERT_TRUE(report.realTimeFactor().has_value());
  EXPECT_NEAR(*report.realTimeFactor(), 0.5, 1e-9);
}

TEST(SessionReport, CountsMissingSteps)
{
  SessionReport report = reportOfSteps(0);
  report.addStep(3, 0.0, false, 0);  // steps 0, 1 and 2 precede the subscription
  report.addStep(4, 0.1, true, 0);
  report.addStep(4, 0.1, true, 0);
  report.addStep(7, 0.2, false, 9);
  const json result = parsed(report);
  EXPECT_EQ(result["steps"], 3);
  EXPECT_EQ(result["steps_missing_from_recording"], 5);
  EXPECT_EQ(result["steps_repeated"], 1);
  EXPECT_EQ(result["steps_with_stale_contacts"], 1);
  EXPECT_EQ(result["last_state_hash"], "0000000000000009");
}

TEST(SessionReport, ReportsTheShareOfStepsOnTimeOnlyWithDiagnostics)
{
  SessionReport report = reportOfSteps(1000);
  EXPECT_TRUE(parsed(report)["on_time_percent"].is_null());
  report.addDiagnostic("rod_dynamics", "steps", "500");
  report.addDiagnostic("rod_dynamics", "deadline misses", "5");
  EXPECT_NEAR(parsed(report)["on_time_percent"].get<double>(), 99.0, 1e-12);
  report.addDiagnostic("rod_dynamics", "deadline misses", "many");
  EXPECT_TRUE(parsed(report)["on_time_percent"].is_null());
}

TEST(SessionReport, HoldsTheLastFiniteTip)
{
  SessionReport report = reportOfSteps(1);
  report.addTip({0, 0, 0}, 0.01, 10);
  report.addTip({3, 4, 0}, 0.02, 11);
  report.addTip({std::nan(""), 0, 0}, 0.5, 12);
  report.addTip({3, 4, 1}, 0.03, 13);
  const json result = parsed(report);
  EXPECT_EQ(result["tip_position"], json::array({3.0, 4.0, 1.0}));
  EXPECT_EQ(result["nodes"], 13);
  EXPECT_EQ(result["inserted_length"], 0.03);
}

TEST(SessionReport, ReportsTheBoundingBoxOfTheVesselIfThereIsOne)
{
  SessionReport report = reportOfSteps(1);
  EXPECT_TRUE(parsed(report)["vessel_box"].is_null());
  report.addVesselPoint({1, -2, 3});
  report.addVesselPoint({-1, 2, 3});
  EXPECT_EQ(parsed(report)["vessel_box"]["min"], json::array({-1.0, -2.0, 3.0}));
  EXPECT_EQ(parsed(report)["vessel_box"]["max"], json::array({1.0, 2.0, 3.0}));
}

TEST(SessionReport, ReportsWallForcesOnlyWithAVessel)
{
  SessionReport report = reportOfSteps(1);
  EXPECT_TRUE(parsed(report)["wall_forces"].is_null());
  WallForceSummary summary;
  summary.whole.peak = 0.1;
  report.setWallForces(summary, 1);
  summary.time = 2.0;
  summary.whole.peak = 0.25;
  report.setWallForces(summary, 3);
  EXPECT_EQ(parsed(report)["wall_forces"]["peak"], 0.25);
  EXPECT_EQ(parsed(report)["wall_forces"]["time"], 2.0);
  EXPECT_EQ(parsed(report)["wall_forces"]["triangles"], 3);
}

TEST(SessionReport, IsValidJsonWithoutStepsAndWithInvalidText)
{
  SessionReport report = reportOfSteps(0);
  report.addDiagnostic("node", "quote \" and \xff byte", "back\\slash\n");
  const json result = parsed(report, "no \"step\"");
  EXPECT_TRUE(result["real_time_factor"].is_null());
  EXPECT_TRUE(result["tip_position"].is_null());
  EXPECT_EQ(result["error"], "no \"step\"");
  EXPECT_EQ(result["scene"]["hash"], "0000000000abcdef");
}

}  // namespace
}  // namespace endovascular_sim::results
