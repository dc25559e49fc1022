#include "session/step_states.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "session/session.h"

namespace endovascular_sim::session
{
namespace
{

const std::string kLesson = PROJECT_DIR "/config/scenes/lesson_bifurcation.yaml";
const std::vector<std::string> kByTheExpert = {"procedure.guided=false", "drive.source=procedure"};

std::string hashOf(const Session& session)
{
  return std::to_string(session.simulation().trajectoryHash());
}

/** Steps a session, and keeps the states, until a number of steps of the procedure has begun. */
void stepTo(Session& session, StepStates& states, std::size_t begun)
{
  while (!session.isOver() && session.scriptedOperator()->records().size() < begun)
  {
    session.step();
    states.follow(*session.scriptedOperator(), [&session] { return session.save(); });
  }
}

TEST(StepStates, RepeatAStepBitForBit)
{
  Session session(kLesson, kByTheExpert);
  StepStates states;
  stepTo(session, states, 3);
  EXPECT_EQ(states.present(), 2U);
  ASSERT_NE(states.at(1), nullptr);
  EXPECT_EQ(states.at(3), nullptr);
  const std::string end = hashOf(session);
  session.load(*states.at(1));
  EXPECT_EQ(session.scriptedOperator()->records().size(), 2U);
  stepTo(session, states, 3);
  EXPECT_EQ(hashOf(session), end);
}

TEST(StepStates, FollowARunThatBeginsAgain)
{
  Session session(kLesson, kByTheExpert);
  StepStates states;
  stepTo(session, states, 2);
  session.reset();
  EXPECT_FALSE(states.follow(*session.scriptedOperator(), [] { return std::string("unused"); }));
  stepTo(session, states, 1);
  EXPECT_EQ(states.present(), 0U);
  EXPECT_NE(states.at(1), nullptr) << "of the run before";
}

TEST(StepStates, OfTheExpertContinueByAPersonAndNotTheOtherWayRound)
{
  Session expert(kLesson, kByTheExpert);
  StepStates states;
  stepTo(expert, states, 2);

  Session lesson(kLesson);
  lesson.load(*states.at(1));
  EXPECT_EQ(lesson.scriptedOperator()->records().size(), 2U);
  EXPECT_EQ(lesson.simulation().hand(0).insertion, expert.simulation().hand(0).insertion);
  lesson.step(100);
  try
  {
    expert.load(lesson.save());
    FAIL() << "the operator would jump from its own commands to those of the person";
  }
  catch (const InputError& error)
  {
    EXPECT_NE(std::string(error.what()).find("while a person drove an instrument"), std::string::npos) << error.what();
  }
  EXPECT_EQ(expert.scriptedOperator()->records().size(), 2U) << "a refused state has no effect";
}

}  // namespace
}  // namespace endovascular_sim::session
