#include "nodes/rod_dynamics/response_timeout.h"

#include <algorithm>
#include <deque>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(ResponseTimeout, IsCompleteWhileResponsesArrive)
{
  ResponseTimeout timeout(3e-3);
  EXPECT_EQ(timeout.next(), 3e-3);
  timeout.received();
  EXPECT_EQ(timeout.next(), 3e-3);
  EXPECT_FALSE(timeout.silent());
}

TEST(ResponseTimeout, IsShortAfterAMissedResponse)
{
  ResponseTimeout timeout(3e-3);
  for (int query = 0; query < 5; ++query)
  {
    timeout.missed();
    EXPECT_TRUE(timeout.silent());
    EXPECT_DOUBLE_EQ(timeout.next(), 0.3e-3);
  }
  timeout.received();
  EXPECT_EQ(timeout.next(), 3e-3);
}

/** The peer needs 0.9 ms for each query in turn, and 5 ms for the first one. */
TEST(ResponseTimeout, CatchesUpWithAPeerThatWasLateOnceAndNeedsLongerThanTheShortTimeout)
{
  ResponseTimeout timeout(3e-3);
  std::deque<double> late;
  double now = 0.0;
  double done = 0.0;
  int missed = 0;
  for (int query = 0; query < 20; ++query)
  {
    for (; !late.empty() && late.front() <= now; late.pop_front())
      timeout.receivedLate();
    done = std::max(now, done) + (query == 0 ? 5e-3 : 0.9e-3);
    const double until = now + timeout.next();
    if (done <= until)
    {
      timeout.received();
      late.clear();
    }
    else
    {
      timeout.missed();
      ++missed;
      late.push_back(done);
    }
    now = std::min(done, until) + 0.7e-3;
  }
  EXPECT_FALSE(timeout.silent());
  EXPECT_EQ(missed, 3);
}

}  // namespace
}  // namespace endovascular_sim::nodes
