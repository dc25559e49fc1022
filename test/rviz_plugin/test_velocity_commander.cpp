#include "rviz_plugin/model/velocity_commander.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

using std::chrono::milliseconds;

/** Commands that were sent. */
class Sent
{
public:
  VelocityCommander::Send receiver()
  {
    return [this](const HandVelocity& velocity)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      sent_.push_back(velocity);
    };
  }

  std::vector<HandVelocity> all() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return sent_;
  }

  /** Waits at most 5 s. */
  template <typename Condition>
  bool becomes(const Condition& condition) const
  {
    for (int k = 0; k < 5000; ++k)
    {
      if (condition(all()))
        return true;
      std::this_thread::sleep_for(milliseconds(1));
    }
    return false;
  }

private:
  mutable std::mutex mutex_;
  std::vector<HandVelocity> sent_;
};

bool endsWithZero(const std::vector<HandVelocity>& sent)
{
  return !sent.empty() && sent.back().isZero();
}

TEST(VelocityCommander, SendsAHeldVelocityRepeatedlyAndOneZeroAfterTheRelease)
{
  Sent sent;
  VelocityCommander commander(sent.receiver(), milliseconds(2), milliseconds(60000));
  commander.hold({"wire", 0.02, 1.0});
  EXPECT_TRUE(sent.becomes([](const auto& all) { return all.size() > 10; }));
  EXPECT_TRUE(commander.isMoving());
  commander.hold({"wire", 0.0, 0.0});
  EXPECT_TRUE(sent.becomes(endsWithZero));
  const std::size_t count = sent.all().size();
  std::this_thread::sleep_for(milliseconds(30));
  EXPECT_EQ(sent.all().size(), count);  // silent: another client may drive
  EXPECT_FALSE(commander.isMoving());
  EXPECT_EQ(sent.all().front().insertion, 0.02);
  EXPECT_EQ(sent.all().front().rotation, 1.0);
  EXPECT_FALSE(sent.all()[count - 2].isZero());
}

TEST(VelocityCommander, StopsWhenTheMotionIsNoLongerConfirmedUntilARelease)
{
  Sent sent;
  VelocityCommander commander(sent.receiver(), milliseconds(2), milliseconds(50));
  commander.hold({"wire", 0.02, 0.0});
  EXPECT_TRUE(sent.becomes(endsWithZero));
  EXPECT_EQ(commander.timeOuts(), 1U);
  commander.confirm();
  commander.hold({"wire", 0.02, 0.0});  // the same press
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_TRUE(endsWithZero(sent.all()));
  commander.hold({"wire", 0.0, 0.0});
  commander.hold({"wire", 0.03, 0.0});
  EXPECT_TRUE(sent.becomes([](const auto& all) { return all.back().insertion == 0.03; }));
}

TEST(VelocityCommander, KeepsMovingWhileItIsConfirmed)
{
  Sent sent;
  VelocityCommander commander(sent.receiver(), milliseconds(2), milliseconds(500));
  commander.hold({"wire", 0.02, 0.0});
  for (int k = 0; k < 40; ++k)
  {
    std::this_thread::sleep_for(milliseconds(20));
    commander.confirm();
  }
  EXPECT_EQ(commander.timeOuts(), 0U);
  EXPECT_TRUE(commander.isMoving());
}

TEST(VelocityCommander, StopsOneInstrumentBeforeItMovesAnother)
{
  Sent sent;
  VelocityCommander commander(sent.receiver(), milliseconds(2), milliseconds(60000));
  commander.hold({"wire", 0.02, 0.0});
  EXPECT_TRUE(sent.becomes([](const auto& all) { return !all.empty(); }));
  commander.hold({"catheter", 0.01, 0.0});
  EXPECT_TRUE(sent.becomes([](const auto& all) { return all.back().instrument == "catheter"; }));
  bool is_stopped = false;
  for (const HandVelocity& velocity : sent.all())
  {
    if (velocity.instrument == "wire" && velocity.isZero())
      is_stopped = true;
    EXPECT_TRUE(velocity.instrument == "wire" || is_stopped);
  }
}

TEST(VelocityCommander, SendsAZeroWhenItEnds)
{
  Sent sent;
  {
    VelocityCommander commander(sent.receiver(), milliseconds(2), milliseconds(60000));
    commander.hold({"wire", 0.02, 0.0});
    EXPECT_TRUE(sent.becomes([](const auto& all) { return !all.empty(); }));
  }
  EXPECT_TRUE(endsWithZero(sent.all()));
}

TEST(VelocityCommander, DropsExceptionsOfItsReceiver)
{
  int calls = 0;
  VelocityCommander commander(
      [&](const HandVelocity&)
      {
        ++calls;
        throw std::runtime_error("no connection");
      },
      milliseconds(2));
  commander.hold({"wire", 0.02, 0.0});
  std::this_thread::sleep_for(milliseconds(100));
  commander.hold({"wire", 0.0, 0.0});
  EXPECT_TRUE(commander.timeOuts() == 0U);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
