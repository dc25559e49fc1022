#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "session/session.h"

namespace endovascular_sim::session
{
namespace
{

TEST(ErrorsOfATrainee, AreNoneWhereTheExpertSteersThroughTheFirstLesson)
{
  SessionSettings settings;
  settings.results = true;
  Session session("lesson_bifurcation", {"procedure.guided=false", "drive.source=procedure"}, settings);
  while (session.step(1000) > 0)
  {
  }
  ASSERT_NE(session.scriptedOperator(), nullptr);
  EXPECT_EQ(session.scriptedOperator()->progress(), procedure::Progress::kDone);
  for (const procedure::StepRecord& step : session.scriptedOperator()->records())
    EXPECT_EQ(step.wrong_branches, 0) << step.phase;
}

TEST(ErrorsOfATrainee, HoldASoftWireThatIsPushedAgainstTheClosedEndOfAVessel)
{
  const std::shared_ptr<const World> world = World::parse(
      "duration: 6\n"
      "vessel: {friction: 0.05, tube: {radius: 0.001, pieces: [{length: 0.1}]}}\n"
      "entry: {position: [0, 0, 0.003], direction: [0, 0, 1], up: [1, 0, 0]}\n"
      "instrument: {use: guidewire_014_workhorse, name: wire}\n"
      "drive: {source: script, initial_insertion: 0.06, force_limit: 3.2, speed: 0.02, travel: 0.1}\n"
      "sampling: {kind: adaptive, max_edge: 4.0e-3, turn_per_edge: 0.1}\n",
      "closed tube");
  SessionSettings settings;
  settings.results = true;
  Session session(world, settings);
  session.step(1500);  // the tip is still in the open lumen
  EXPECT_TRUE(session.record().metrics()->errors().empty());
  session.step(4500);
  const std::vector<results::SessionError>& errors = session.record().metrics()->errors();
  const auto sustained =
      std::find_if(errors.begin(), errors.end(),
                   [](const results::SessionError& error) { return error.kind == "sustained force of a tip"; });
  ASSERT_NE(sustained, errors.end());
  EXPECT_GT(sustained->time, 1.5);
  EXPECT_GT(sustained->value, 0.1);
}

}  // namespace
}  // namespace endovascular_sim::session
