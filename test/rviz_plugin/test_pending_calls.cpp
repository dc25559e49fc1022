#include "rviz_plugin/model/pending_calls.h"

#include <future>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

/** Service that does not answer until it is told to. */
class SilentService
{
public:
  std::function<CallOutcome()> call(const std::string& answer)
  {
    return [silence = silence_.get_future().share(), answer]
    {
      silence.wait();
      return CallOutcome{true, answer};
    };
  }
  void respond() { silence_.set_value(); }

private:
  std::promise<void> silence_;
};

template <typename Condition>
void waitFor(Condition condition)
{
  while (!condition())
    std::this_thread::yield();
}

TEST(PendingCalls, PauseAndStartWaitForNoOtherService)
{
  PendingCalls calls;
  SilentService recorder;
  ASSERT_TRUE(calls.begin(Request::kStopRecording, "session/stop", recorder.call("stopped")));
  EXPECT_TRUE(calls.begin(Request::kPause, "simulation/pause", [] { return CallOutcome{true, "paused"}; }));
  waitFor([&] { return calls.answer() == "paused"; });
  EXPECT_TRUE(calls.begin(Request::kStart, "simulation/resume", [] { return CallOutcome{true, "continues"}; }));
  waitFor([&] { return calls.answer() == "continues"; });
  EXPECT_EQ(calls.waiting(), std::vector<std::string>({"session/stop (0 s)"}));
  recorder.respond();
  waitFor([&] { return calls.waiting().empty(); });
  EXPECT_EQ(calls.answer(), "stopped");
}

TEST(PendingCalls, APauseIsRepeatedWhileOneDoesNotAnswer)
{
  PendingCalls calls;
  SilentService lost;
  ASSERT_TRUE(calls.begin(Request::kPause, "simulation/pause", lost.call("")));
  EXPECT_TRUE(calls.begin(Request::kPause, "simulation/pause", [] { return CallOutcome{true, "paused"}; }));
  waitFor([&] { return calls.answer() == "paused"; });
  lost.respond();
  waitFor([&] { return calls.waiting().empty(); });
}

TEST(PendingCalls, AResetIsNotRepeatedWhileItWaits)
{
  PendingCalls calls;
  SilentService simulation;
  ASSERT_TRUE(calls.begin(Request::kReset, "simulation/reset", simulation.call("run 2")));
  EXPECT_FALSE(calls.begin(Request::kReset, "simulation/reset", [] { return CallOutcome{}; }));
  simulation.respond();
  waitFor([&] { return calls.answer() == "run 2"; });
}

TEST(PendingCalls, AnExceptionIsTheAnswer)
{
  PendingCalls calls;
  calls.begin(Request::kReset, "simulation/reset", []() -> CallOutcome { throw std::runtime_error("no master"); });
  waitFor([&] { return calls.answer() == "no master"; });
}

TEST(PendingCalls, ACallMayOutliveTheObject)
{
  SilentService service;
  {
    PendingCalls calls;
    calls.begin(Request::kReset, "simulation/reset", service.call(""));
  }
  service.respond();
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
