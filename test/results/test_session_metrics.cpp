#include "results/session_metrics.h"

#include <cstdint>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/metrics_files.h"
#include "results/metrics_page.h"
#include "test/procedure/procedure_fixtures.h"

namespace endovascular_sim::results
{
namespace
{

/** Session with a wire and a catheter whose tips move on prescribed paths. */
class Session
{
public:
  explicit Session(const std::string& steps =
                       "    - {advance: wire, until: {tip_in: goal}}\n    - {advance: catheter, "
                       "until: {by: 0.1}}\n")
    : Session(procedure::sceneWith(steps))
  {
  }

  explicit Session(const scene::Scene& scene) : metrics(scene, procedure::forkedTree(), {0, 0, 0.001}) {}

  /** Moves all tips and handles linearly to new positions over a duration. */
  void move(double seconds, const std::vector<Eigen::Vector3d>& tips, const std::vector<double>& insertions,
            double at_tip = 0.0)
  {
    const std::vector<Eigen::Vector3d> from = tips_;
    const std::vector<double> inserted = insertions_;
    const int samples = static_cast<int>(seconds * SessionMetrics::kRate + 0.5);
    for (int i = 1; i <= samples; ++i)
    {
      Sample sample;
      time_ += 1.0 / SessionMetrics::kRate;
      sample.observation.time = time_;
      sample.peaks.wall.at_tip = at_tip;
      sample.peaks.hand_force = {peak_hand_force, 0.0};
      for (std::size_t k = 0; k < 2; ++k)
      {
        const double share = static_cast<double>(i) / samples;
        procedure::InstrumentView view;
        tips_[k] = from[k] + share * (tips[k] - from[k]);
        insertions_[k] = inserted[k] + share * (insertions[k] - inserted[k]);
        view.tip = tips_[k];
        view.hand.insertion = insertions_[k];
        view.hand.force = k == 0 ? hand_force : 0.0;
        if (insertions_[k] > 0.0)
          view.branch_position = metrics.locator().at(view.tip);
        sample.observation.instruments.push_back(view);
      }
      procedure::markCovered(sample.observation);
      sample.faults.stale_steps = std::exchange(stale_steps, 0);
      metrics.add(sample);
    }
  }

  nlohmann::ordered_json json() const { return metrics.json(); }
  double time() const { return time_; }

  SessionMetrics metrics;
  std::uint64_t stale_steps = 0;  ///< before the next sample [1]
  double peak_hand_force = 0.0;   ///< of the wire, in all steps between two samples [N]
  double hand_force = 0.1;        ///< of the wire; a push is positive [N]

private:
  double time_ = 0.0;
  std::vector<Eigen::Vector3d> tips_{{0, 0, 0}, {0, 0, 0}};
  std::vector<double> insertions_{0.0, -0.1};
};

const Eigen::Vector3d kStart(0, 0, 0);

TEST(SessionMetrics, CountsVisitsOfWrongBranches)
{
  Session session;
  session.move(2.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.move(1.0, {{0.04, 0, 0.1}, kStart}, {0.14, -0.1});  // the side branch
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.move(1.0, {{0, 0, 0.15}, kStart}, {0.15, -0.1});
  session.move(1.0, {{-0.04, 0, 0.15}, kStart}, {0.19, -0.1});  // the goal
  const nlohmann::ordered_json json = session.json();
  ASSERT_EQ(json["wrong_branches"].size(), 1U);
  EXPECT_EQ(json["wrong_branches"][0]["branch"], "side");
  EXPECT_EQ(json["wrong_branches"][0]["instrument"], "wire");
  EXPECT_NEAR(json["wrong_branches"][0]["deepest"], 0.030, 0.001);
  // The visit begins 3 mm beyond the ostium at 10 mm, reaches 40 mm, and ends at 7 mm, where the trunk is closer. The
  // speed is 40 mm/s.
  EXPECT_NEAR(json["instruments"][0]["wrong_branch_time"], (0.027 + 0.033) / 0.04, 0.1);
  EXPECT_EQ(json["instruments"][0]["wrong_branch_entries"], 1);
}

/** Step of the operator from a time on. */
procedure::StepRecord recordOf(std::size_t step, double begin, double end,
                               procedure::Progress outcome = procedure::Progress::kDone)
{
  procedure::StepRecord record;
  record.step = step;
  record.begin = begin;
  record.end = end;
  record.outcome = outcome;
  return record;
}

TEST(SessionMetrics, CountsABranchThatIsTheGoalOfAnotherStep)
{
  Session session(
      "    - {advance: wire, until: {tip_in: side}}\n    - {withdraw: wire, until: {insertion: 0.1}}\n"
      "    - {advance: wire, until: {tip_in: goal}}\n");
  session.move(2.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.move(1.0, {{0.04, 0, 0.1}, kStart}, {0.14, -0.1});  // the side branch, as the first step wants
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  const double third = session.time();
  session.move(1.0, {{0.04, 0, 0.1}, kStart}, {0.14, -0.1});  // again, although the third step wants the goal
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.metrics.setSteps({recordOf(0, 0.0, 2.5), recordOf(1, 2.55, third),
                            recordOf(2, third + 0.05, session.time(), procedure::Progress::kRunning)},
                           "");
  const nlohmann::ordered_json json = session.json();
  ASSERT_EQ(json["wrong_branches"].size(), 1U);
  EXPECT_GT(json["wrong_branches"][0]["begin"], third);
  EXPECT_EQ(json["steps"][0]["wrong_branches"], 0);
  EXPECT_EQ(json["steps"][2]["wrong_branches"], 1);
  EXPECT_EQ(json["instruments"][0]["wrong_branch_entries"], 1);
}

TEST(SessionMetrics, DoesNotCountABranchThatWasRightWhenTheTipEnteredIt)
{
  Session session("    - {advance: wire, until: {tip_in: side}}\n    - {advance: wire, until: {tip_in: goal}}\n");
  session.move(2.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.move(1.0, {{0.04, 0, 0.1}, kStart}, {0.14, -0.1});
  const double second = session.time();
  session.move(1.0, {{0.05, 0, 0.1}, kStart}, {0.15, -0.1});
  session.metrics.setSteps(
      {recordOf(0, 0.0, second), recordOf(1, second + 0.05, session.time(), procedure::Progress::kRunning)}, "");
  EXPECT_TRUE(session.json()["wrong_branches"].empty());
}

TEST(SessionMetrics, OfAHandAreThoseOfEveryStep)
{
  Session session;
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.peak_hand_force = -4.5;  // between two samples, whose own force is 0
  session.move(0.05, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.peak_hand_force = 1.0;
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  EXPECT_EQ(session.metrics.peakHandForce(0), 4.5);
  EXPECT_EQ(session.json()["instruments"][0]["peak_hand_force"], 4.5);
  EXPECT_NE(metricsPage(session.metrics).find("4.50"), std::string::npos);
  EXPECT_NE(instrumentsCsv(session.metrics).find(",-4.5,"), std::string::npos);
}

TEST(SessionMetrics, HoldTheForcesAfterTheLastSampleUnlessTheProcedureIsOver)
{
  Peaks tail;
  tail.addHands({-3.0, 0.0}, {0.0, 0.0});
  for (const procedure::Progress outcome : {procedure::Progress::kRunning, procedure::Progress::kDone})
  {
    Session session;
    session.peak_hand_force = 1.0;
    session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
    session.metrics.setSteps({recordOf(0, 0.0, 1.0, outcome)}, "");
    session.metrics.addTail(tail);
    EXPECT_EQ(session.metrics.peakHandForce(0), outcome == procedure::Progress::kRunning ? 3.0 : 1.0);
  }
}

TEST(SessionMetrics, IgnoresTheBranchOfACoveredTip)
{
  Session session;
  session.move(2.0, {{0, 0, 0.1}, {0, 0, 0.1}}, {0.1, 0.15});
  session.move(1.0, {{0.04, 0, 0.1}, {0.05, 0, 0.1}}, {0.14, 0.15});
  EXPECT_TRUE(session.json()["wrong_branches"].empty());
}

TEST(SessionMetrics, AllowsAllBranchesToAnInstrumentWithoutAGoal)
{
  Session session;
  session.move(1.0, {kStart, {0, 0, 0.1}}, {0.0, 0.1});
  session.move(1.0, {kStart, {0.04, 0, 0.1}}, {0.0, 0.14});
  EXPECT_TRUE(session.json()["wrong_branches"].empty());
}

TEST(SessionMetrics, MeasuresThePathsOfTheTips)
{
  Session session;
  session.move(2.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.move(1.0, {{0, 0, 0.06}, kStart}, {0.06, -0.1});
  // The first sample is one sampling period after the start.
  EXPECT_NEAR(session.json()["instruments"][0]["tip_path"], 0.14, 0.1 / 2.0 / SessionMetrics::kRate + 1e-9);
  EXPECT_EQ(session.json()["instruments"][1]["tip_path"], 0.0);
}

TEST(SessionMetrics, CountsExchanges)
{
  Session session;
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  session.move(1.0, {kStart, kStart}, {-0.05, -0.1});
  EXPECT_EQ(session.json()["instrument_exchanges"], 0) << "no instrument has replaced it yet";
  session.move(1.0, {kStart, {0, 0, 0.1}}, {-0.05, 0.1});
  EXPECT_EQ(session.json()["instrument_exchanges"], 1);
  EXPECT_EQ(session.json()["instruments"][1]["insertions"], 1);
}

TEST(SessionMetrics, ReportsARiskOfPerforationOncePerEpisode)
{
  scene::Scene scene = procedure::sceneWith("    - {wait: 1}\n");
  scene.errors.emplace();
  scene.errors->tip_force = 1.0;
  Session session(scene);
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.2);
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.8);
  session.move(2.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.2);
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.6);
  session.move(2.0, {{0, 0, 0.1}, {0, 0, 0.12}}, {0.1, 0.12}, 0.2);
  session.move(1.0, {{0, 0, 0.1}, {0, 0, 0.12}}, {0.1, 0.12}, 0.9);  // the catheter is foremost now
  const nlohmann::ordered_json json = session.json();
  ASSERT_EQ(json["errors"].size(), 2U);
  EXPECT_EQ(json["errors"][0]["error"], "risk of perforation");
  EXPECT_EQ(json["errors"][0]["instrument"], "wire");
  EXPECT_NEAR(json["errors"][0]["value"], 0.8, 1e-12);
}

TEST(SessionMetrics, ReportATipThatPushesOnAgainstTheWall)
{
  Session session;
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.05);
  session.move(0.9, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.3);  // shorter than a second
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.05);
  EXPECT_TRUE(session.metrics.errors().empty());
  const double begin = session.time();
  session.move(3.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.3);
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.4);
  session.move(0.5, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.05);
  session.move(0.5, {{0, 0, 0.1}, {0, 0, 0.12}}, {0.1, 0.12}, 0.05);
  session.move(2.0, {{0, 0, 0.1}, {0, 0, 0.12}}, {0.1, 0.12}, 0.4);  // the blunt tip of the catheter
  const std::vector<SessionError>& errors = session.metrics.errors();
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].kind, "sustained force of a tip");
  EXPECT_EQ(errors[0].instrument, 0);
  EXPECT_NEAR(errors[0].time, begin, 1.5 / SessionMetrics::kRate);
  EXPECT_EQ(errors[0].value, 0.4);
}

TEST(SessionMetrics, DoNotReportATipThatPressesByItsShapeWithoutAPush)
{
  Session session;
  session.hand_force = -0.4;
  session.move(3.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.3);
  EXPECT_TRUE(session.metrics.errors().empty());
  session.hand_force = 0.1;
  session.move(2.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.3);
  EXPECT_EQ(session.metrics.errors().size(), 1U);
}

TEST(SessionMetrics, DoNotJoinThePushesBeforeAndAfterAFaultOfTheSimulator)
{
  Session session;
  session.move(0.7, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.3);
  session.stale_steps = 1;
  session.move(0.7, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.3);
  EXPECT_TRUE(session.metrics.errors().empty());
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.3);
  EXPECT_EQ(session.metrics.errors().size(), 1U);
}

TEST(SessionMetrics, OfTheForcesOfATipHaveTheLimitsOfTheScene)
{
  scene::Scene scene = procedure::sceneWith("    - {wait: 1}\n");
  scene.errors.emplace();
  scene.errors->tip_force = 0.35;
  scene.errors->perforation_force = 0.2;
  Session session(scene);
  session.move(3.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.3);
  ASSERT_EQ(session.metrics.errors().size(), 1U);
  EXPECT_EQ(session.metrics.errors()[0].kind, "risk of perforation");
}

constexpr double kLong = 3.0;  // longer than ErrorLimits::support_time [s]

/** Session whose catheter rests in the goal branch, with its wire ahead. */
Session engaged()
{
  Session session;
  session.move(1.0, {{0, 0, 0.15}, {0, 0, 0.1}}, {0.15, 0.1});
  session.move(1.0, {{-0.05, 0, 0.15}, {-0.02, 0, 0.15}}, {0.2, 0.17});
  session.move(kLong, {{-0.05, 0, 0.15}, {-0.02, 0, 0.15}}, {0.2, 0.17});
  return session;
}

TEST(SessionMetrics, ReportCatheterAndWireThatLeaveAnOstiumTogether)
{
  Session session = engaged();
  session.move(0.5, {{0, 0, 0.12}, {0, 0, 0.1}}, {0.2, 0.17});  // the handles rest
  EXPECT_TRUE(session.metrics.errors().empty()) << "it may come back";
  session.move(kLong, {{0, 0, 0.12}, {0, 0, 0.1}}, {0.2, 0.17});
  ASSERT_EQ(session.metrics.errors().size(), 1U);
  EXPECT_EQ(session.metrics.errors()[0].kind, "support lost");
  EXPECT_EQ(session.metrics.errors()[0].instrument, 1);
}

TEST(SessionMetrics, DoNotReportACatheterWhoseWireStaysInTheBranch)
{
  Session session = engaged();
  session.move(0.5, {{-0.05, 0, 0.15}, {0, 0, 0.1}}, {0.2, 0.17});
  session.move(kLong, {{-0.05, 0, 0.15}, {0, 0, 0.1}}, {0.2, 0.17});
  EXPECT_TRUE(session.metrics.errors().empty());
}

TEST(SessionMetrics, DoNotReportACatheterThatIsWithdrawn)
{
  Session session = engaged();
  session.move(1.0, {{0, 0, 0.15}, {0, 0, 0.1}}, {0.15, 0.1});
  session.move(kLong, {{0, 0, 0.15}, {0, 0, 0.1}}, {0.15, 0.1});
  EXPECT_TRUE(session.metrics.errors().empty());
}

TEST(SessionMetrics, DoNotReportACatheterWithoutAWireAhead)
{
  Session session = engaged();
  session.move(1.0, {{0, 0, 0.05}, {-0.02, 0, 0.15}}, {0.05, 0.17});
  session.move(1.0, {{0, 0, 0.05}, {0, 0, 0.1}}, {0.05, 0.17});
  session.move(kLong, {{0, 0, 0.05}, {0, 0, 0.1}}, {0.05, 0.17});
  EXPECT_TRUE(session.metrics.errors().empty());
}

TEST(SessionMetrics, AttributesOnlyNearbyContactsToTheForemostTip)
{
  const Eigen::Vector3d tip(0, 0, 0.1);
  WallLoad load;
  load.add({0, 0, 0.104}, 0.3, tip);
  load.add({0, 0.004, 0.1}, 0.2, tip);
  load.add({0, 0, 0.0}, 0.7, tip);  // at the tip of another instrument
  EXPECT_NEAR(load.at_tip, 0.5, 1e-12);
  EXPECT_NEAR(load.sum, 1.2, 1e-12);
  EXPECT_EQ(load.largest, 0.7);
}

TEST(SessionMetrics, ReportsAllTreatmentEventsExceptAPlacedStentAsErrors)
{
  Session session;
  session.metrics.addEvent("stent_placed", 1, 3.0);
  session.metrics.addEvent("above_rated", 1, 4.0);
  const nlohmann::ordered_json json = session.json();
  ASSERT_EQ(json["errors"].size(), 1U);
  EXPECT_EQ(json["errors"][0]["error"], "above_rated");
}

TEST(SessionMetrics, IgnoresASecondSampleOfAnInterval)
{
  Session session;
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1});
  const std::size_t before = session.metrics.samples().size();
  Sample sample = session.metrics.samples().back();
  session.metrics.add(sample);
  EXPECT_EQ(session.metrics.samples().size(), before);
  sample.observation.time += 1.0 / SessionMetrics::kRate;
  session.metrics.add(sample);
  EXPECT_EQ(session.metrics.samples().size(), before + 1);
}

TEST(SessionMetrics, ReportsTheOutcomeOfALesion)
{
  Session session;
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.8);
  LesionOutcome lesion;
  lesion.branch = "goal";
  lesion.before.stenosis = 0.6;
  lesion.after.stenosis = 0.1;
  lesion.after.stented = true;
  lesion.after.coverage = 0.97;
  session.metrics.setLesions({lesion});
  const auto json = session.metrics.json();
  EXPECT_EQ(json["lesions"][0]["branch"], "goal");
  EXPECT_EQ(json["lesions"][0]["before"]["stenosis"], 0.6);
  EXPECT_EQ(json["lesions"][0]["after"]["coverage"], 0.97);
  EXPECT_FALSE(json["lesions"][0]["before"].contains("coverage")) << "there was no stent before";
  EXPECT_NE(metricsPage(session.metrics).find("97"), std::string::npos);
}

TEST(MetricsPage, IsSelfContained)
{
  Session session;
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.8);
  session.metrics.setSteps({{"advance wire until its tip is in goal", "Wire & goal <1>", "", 0.0, 1.0, 0, 0,
                             procedure::Progress::kFailed, 0, ""}},
                           "step 1: because");
  const std::string page = metricsPage(session.metrics);
  for (const char* reference : {"http", "src=", "href=", "url(", "@import"})
    EXPECT_EQ(page.find(reference), std::string::npos) << reference;
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("Wire &amp; goal &lt;1&gt;"), std::string::npos) << "names are escaped";
  EXPECT_NE(page.find("step 1: because"), std::string::npos);
  EXPECT_NE(page.find("risk of perforation"), std::string::npos);
}

TEST(MetricsPage, ReportsForcesInAVesselWithoutBranchNames)
{
  Session session;
  session.move(1.0, {{0, 0, 0.1}, kStart}, {0.1, -0.1}, 0.8);
  WallForceSummary forces;
  forces.whole.peak = 1.25;
  forces.whole.peak_region = 0;
  forces.regions = {forces.whole};
  forces.regions[0].region = 0;
  session.metrics.setWallForces(forces);
  const std::string page = metricsPage(session.metrics);
  EXPECT_NE(page.find("1.25 N at 0.0 s<"), std::string::npos) << page;
}

}  // namespace
}  // namespace endovascular_sim::results
