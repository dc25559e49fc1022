#include "rviz_plugin/model/player_remote.h"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

using Command = PlayerControl::Request;

/** Player whose calls wait until they are released. */
struct SlowPlayer
{
  std::mutex mutex;
  std::condition_variable changed;
  bool is_released = false;
  std::vector<double> called;

  void release()
  {
    const std::lock_guard<std::mutex> lock(mutex);
    is_released = true;
    changed.notify_all();
  }

  bool waitForCalls(std::size_t count)
  {
    std::unique_lock<std::mutex> lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(20), [&] { return called.size() >= count; });
  }
};

PlayerRemote::Call callOf(const std::shared_ptr<SlowPlayer>& player)
{
  return [player](const PlayerControl::Request& request) -> std::string
  {
    std::unique_lock<std::mutex> lock(player->mutex);
    player->called.push_back(request.value);
    player->changed.notify_all();
    player->changed.wait(lock, [&] { return player->is_released; });
    return request.value < 0.0 ? "refused" : "";
  };
}

TEST(PlayerRemote, ReplacesASeekThatWaitsByTheNextOne)
{
  const auto player = std::make_shared<SlowPlayer>();
  PlayerRemote remote(callOf(player));
  remote.give(Command::SEEK_TIME, 1.0);
  ASSERT_TRUE(player->waitForCalls(1));
  for (double time = 2.0; time < 50.0; ++time)
    remote.give(Command::SEEK_TIME, time);
  remote.give(Command::RATE, 4.0);
  player->release();
  ASSERT_TRUE(player->waitForCalls(3));
  EXPECT_EQ(player->called, (std::vector<double>{1.0, 49.0, 4.0}));
}

TEST(PlayerRemote, NamesTheReasonOfTheLastRefusal)
{
  const auto player = std::make_shared<SlowPlayer>();
  player->release();
  PlayerRemote remote(callOf(player));
  remote.give(Command::RATE, -1.0);
  for (int k = 0; k < 2000 && remote.answer().empty(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(remote.answer(), "refused");
  remote.give(Command::PLAY, 0.0);
  for (int k = 0; k < 2000 && !remote.answer().empty(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(remote.answer(), "");
}

TEST(PlayerRemote, EndsWhileACallWaits)
{
  const auto player = std::make_shared<SlowPlayer>();
  {
    PlayerRemote remote(callOf(player));
    remote.give(Command::PLAY, 0.0);
    ASSERT_TRUE(player->waitForCalls(1));
  }
  player->release();
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
