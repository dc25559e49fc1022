#include "nodes/rod_dynamics/response_timeout.h"

#include <algorithm>
#include <deque>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(ResponseTimeout, WaitsInFullWhileAnswersCome)
{
  ResponseTimeout patience(3e-3);
  EXPECT_EQ(patience.next(), 3e-3);
  patience.answered();
  EXPECT_EQ(patience.next(), 3e-3);
  EXPECT_FALSE(patience.silent());
}

TEST(ResponseTimeout, KeepsItsPaceWhileTheOtherSideIsSilent)
{
  ResponseTimeout patience(3e-3);
  for (int question = 0; question < 5; ++question)
  {
    patience.missed();
    EXPECT_TRUE(patience.silent());
    EXPECT_DOUBLE_EQ(patience.next(), 0.3e-3);
  }
  patience.answered();
  EXPECT_EQ(patience.next(), 3e-3);
}

/** The other side takes 0.9 ms for each question, one after another, and 5 ms for the first. */
TEST(ResponseTimeout, CatchesUpWithASideThatWasLateOnceAndTakesLongerThanTheFraction)
{
  ResponseTimeout patience(3e-3);
  std::deque<double> late;
  double now = 0.0;
  double done = 0.0;
  int missed = 0;
  for (int question = 0; question < 20; ++question)
  {
    for (; !late.empty() && late.front() <= now; late.pop_front())
      patience.heardLate();
    done = std::max(now, done) + (question == 0 ? 5e-3 : 0.9e-3);
    const double until = now + patience.next();
    if (done <= until)
    {
      patience.answered();
      late.clear();
    }
    else
    {
      patience.missed();
      ++missed;
      late.push_back(done);
    }
    now = std::min(done, until) + 0.7e-3;
  }
  EXPECT_FALSE(patience.silent());
  EXPECT_EQ(missed, 3);
}

}  // namespace
}  // namespace endovascular_sim::nodes
