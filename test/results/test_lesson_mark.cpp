#include "results/lesson_mark.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/metrics_page.h"
#include "test/procedure/procedure_fixtures.h"

namespace endovascular_sim::results
{
namespace
{

SessionMetrics metricsWith(const std::string& pass)
{
  scene::Scene scene = procedure::sceneWith("    - {advance: wire, until: {tip_in: goal}}\n");
  scene.procedure->pass = scene::parseScene(
                              "vessel: {friction: 0.1, tube: {radius: 0.01, pieces: [{length: 0.3}]}}\n"
                              "instrument: {use: guidewire_035_j, name: wire}\ndrive: {source: procedure}\n"
                              "procedure: {pass: " +
                                  pass + ", steps: [{wait: 1}]}\n",
                              "marks")
                              .procedure->pass;
  return SessionMetrics(scene, procedure::forkedTree(), {0, 0, 0.001});
}

void finish(SessionMetrics& metrics, double time, procedure::Progress outcome = procedure::Progress::kDone)
{
  procedure::StepRecord step;
  step.end = time;
  step.outcome = outcome;
  metrics.setSteps({step}, "");
}

TEST(LessonMark, IsPassedWithinAllLimits)
{
  SessionMetrics metrics = metricsWith("{time: 90, wrong_branches: 0}");
  finish(metrics, 89.0);
  const std::vector<Mark> marks = lessonMarks(metrics);
  ASSERT_EQ(marks.size(), 3U);
  EXPECT_EQ(marks[0].name, "steps not done");
  EXPECT_EQ(marks[1].name, "time from the first motion");
  EXPECT_EQ(marks[1].value, 89.0);
  EXPECT_EQ(verdict(marks, 0), "lesson passed");
  EXPECT_EQ(metrics.json()["lesson"]["passed"], true);
  EXPECT_NE(metricsPage(metrics).find("lesson passed"), std::string::npos);
}

TEST(LessonMark, TimeBeforeTheFirstMotionDoesNotCount)
{
  SessionMetrics metrics = metricsWith("{time: 90}");
  const double rate = SessionMetrics::kRate;
  for (int k = 0; k < 40 * rate; ++k)
  {
    Sample sample;
    sample.observation.time = k / rate;
    sample.observation.instruments.resize(2);
    sample.observation.instruments[0].hand.insertion = 0.01;
    if (sample.observation.time > 30.01)
      sample.observation.instruments[0].hand.rotation = 0.1;
    metrics.add(sample);
  }
  finish(metrics, 100.0);
  EXPECT_NEAR(lessonMarks(metrics)[1].value, 70.0, 1.5 / rate);
  EXPECT_EQ(verdict(lessonMarks(metrics), stepsBefore(metrics)), "lesson passed");
}

TEST(LessonMark, NamesWhatIsNotPassed)
{
  SessionMetrics metrics = metricsWith("{time: 90, wall_force: 0.5}");
  finish(metrics, 95.0);
  WallForceSummary forces;
  forces.whole.peak = 0.75;
  metrics.setWallForces(forces);
  EXPECT_EQ(verdict(lessonMarks(metrics), stepsBefore(metrics)),
            "lesson not passed: time from the first motion 95.0 s, at most 90.0 s; largest force on the wall 0.75 N, "
            "at most 0.50 N");
  EXPECT_EQ(metrics.json()["lesson"]["passed"], false);
}

TEST(LessonMark, IsNotPassedBeforeAllStepsAreDone)
{
  SessionMetrics metrics = metricsWith("{time: 90}");
  EXPECT_EQ(verdict(lessonMarks(metrics), stepsBefore(metrics)), "lesson not passed: 1 steps not done");
  finish(metrics, 50.0, procedure::Progress::kRunning);
  EXPECT_FALSE(lessonMarks(metrics)[0].passed);
}

TEST(LessonMark, CountsForcesOfEveryStepAndStaysInWrongBranches)
{
  SessionMetrics metrics = metricsWith("{hand_force: 2, wrong_branches: 0}");
  for (int k = 0; k < 40; ++k)
  {
    Sample sample;
    sample.observation.time = k / SessionMetrics::kRate;
    sample.observation.instruments.resize(2);
    sample.observation.instruments[0].hand.insertion = 0.1 + 1e-3 * k;
    sample.observation.instruments[0].tip = {1e-3 * k, 0.0, 0.1};  // into the side branch
    sample.peaks.hand_force = {k == 7 ? 2.5 : 0.1, 0.0};
    metrics.add(sample);
  }
  finish(metrics, 2.0);
  EXPECT_EQ(verdict(lessonMarks(metrics), stepsBefore(metrics)),
            "lesson not passed: largest force on a handle 2.50 N, at most 2.00 N; wrong branches 1, at most 0");
}

TEST(LessonMark, NamesTheStepFromWhichTheRecordingBegins)
{
  SessionMetrics metrics = metricsWith("{wrong_branches: 2}");
  for (const double time : {20.0, 20.05})
  {
    Sample sample;
    sample.observation.time = time;
    sample.observation.instruments.resize(2);
    metrics.add(sample);
  }
  procedure::StepRecord before;
  before.outcome = procedure::Progress::kDone;
  before.end = 19.95;
  procedure::StepRecord recorded = before;
  recorded.begin = 20.0;
  recorded.end = 30.0;
  metrics.setSteps({before, recorded}, "");
  EXPECT_EQ(stepsBefore(metrics), 1U);
  EXPECT_EQ(verdict(lessonMarks(metrics), stepsBefore(metrics)), "lesson passed from step 2 on");
  EXPECT_EQ(metrics.json()["lesson"]["from_step"], 2);
}

TEST(LessonMark, MeasuresTheRemainingStenosis)
{
  SessionMetrics metrics = metricsWith("{stenosis: 0.3}");
  finish(metrics, 1.0);
  LesionOutcome lesion;
  lesion.after.stenosis = 0.42;
  metrics.setLesions({lesion});
  EXPECT_EQ(verdict(lessonMarks(metrics), stepsBefore(metrics)),
            "lesson not passed: remaining stenosis 42.0 %, at most 30.0 %");
}

TEST(LessonMark, IsMissingWithoutPassMarks)
{
  SessionMetrics metrics = metricsWith("{}");
  EXPECT_TRUE(lessonMarks(metrics).empty());
  EXPECT_EQ(verdict({}, 0), "");
  EXPECT_FALSE(metrics.json().contains("lesson"));
}

}  // namespace
}  // namespace endovascular_sim::results
