#include "drive/arbiter.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/archive.h"

namespace endovascular_sim::drive
{
namespace
{

constexpr double kTimeOut = 0.2;

TEST(Arbiter, LetsOneClientDriveUntilItIsSilentForTheTimeOut)
{
  Arbiter arbiter("instrument", kTimeOut);
  EXPECT_FALSE(arbiter.isDrivenByAnother("b"));
  EXPECT_TRUE(std::isinf(arbiter.silence()));
  arbiter.accept("a");
  arbiter.advance(0.19);
  EXPECT_TRUE(arbiter.isDrivenByAnother("b"));
  EXPECT_FALSE(arbiter.isDrivenByAnother("a"));
  arbiter.advance(0.02);
  EXPECT_FALSE(arbiter.isDrivenByAnother("b"));
  EXPECT_TRUE(arbiter.isDrivenByAnother("b", true)) << "the sender of a move drives until its end";
  EXPECT_TRUE(arbiter.isTimedOut());
}

TEST(Arbiter, FreesTheInstrumentWhenTheSimulatedTimeBeginsAgain)
{
  Arbiter arbiter("instrument", kTimeOut);
  arbiter.advance(5.0);
  arbiter.accept("a");
  arbiter.advance(-5.0);
  EXPECT_FALSE(arbiter.isDrivenByAnother("b"));
}

TEST(Arbiter, ARejectedCommandKeepsItsSenderDriving)
{
  Arbiter arbiter("robot", kTimeOut);
  arbiter.accept("a");
  arbiter.advance(0.15);
  EXPECT_EQ(arbiter.reject(CommandVerdict::kNotFinite, "servo_jp", "a", "not finite"), "servo_jp of a: not finite");
  arbiter.advance(0.15);
  EXPECT_TRUE(arbiter.isDrivenByAnother("b"));
  EXPECT_EQ(arbiter.reject(CommandVerdict::kForeign, "servo_jp", "b", arbiter.foreignReason()),
            "servo_jp of b: a drives the robot");
  EXPECT_EQ(arbiter.rejected().total(), 2U);
  EXPECT_EQ(arbiter.accepted(), 1U);
}

TEST(Arbiter, LetsEveryClientEnableDisableAndPause)
{
  Arbiter arbiter("instrument", kTimeOut);
  arbiter.accept("a");
  for (const char* word : {"enable", "disable", "pause"})
    EXPECT_TRUE(arbiter.permits("b", word)) << word;
  for (const char* word : {"resume", "home", "unhome", "hold", "free"})
  {
    EXPECT_FALSE(arbiter.permits("b", word)) << word;
    EXPECT_TRUE(arbiter.permits("a", word)) << word;
  }
  EXPECT_EQ(arbiter.lastRefusal(), "free of b: a drives the instrument");
  EXPECT_FALSE(arbiter.permits("a", "dance"));
  EXPECT_EQ(arbiter.rejected().malformed, 1U);
}

TEST(Arbiter, ASavedStateHoldsTheSilenceButNotTheDriver)
{
  Arbiter arbiter("instrument", kTimeOut);
  arbiter.accept("a");
  arbiter.advance(0.125);
  Archive out;
  out(arbiter);
  Archive in(out.bytes());
  Arbiter loaded("instrument", kTimeOut);
  loaded.accept("c");
  in(loaded);
  EXPECT_EQ(loaded.silence(), 0.125);
  EXPECT_EQ(loaded.accepted(), 1U);
  EXPECT_EQ(loaded.driver(), "");
}

}  // namespace
}  // namespace endovascular_sim::drive
