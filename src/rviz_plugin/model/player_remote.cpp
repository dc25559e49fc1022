#include "rviz_plugin/model/player_remote.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr std::size_t kMostCommands = 64;  // that wait; a player that does not respond needs no more

bool isSeek(std::uint8_t command)
{
  using Request = PlayerControl::Request;
  return command == Request::SEEK_TIME || command == Request::SEEK_STEP || command == Request::SEEK_CHAPTER;
}

}  // namespace

/** Commands that wait; shared with the thread. */
struct PlayerRemote::Data
{
  Call call;
  mutable std::mutex mutex;
  std::condition_variable wake;
  std::deque<PlayerControl::Request> waiting;
  std::string answer;
  bool is_ending = false;
};

PlayerRemote::PlayerRemote(Call call) : data_(std::make_shared<Data>())
{
  data_->call = std::move(call);
  std::thread([data = data_] { loop(data); }).detach();
}

PlayerRemote::~PlayerRemote()
{
  {
    const std::lock_guard<std::mutex> lock(data_->mutex);
    data_->is_ending = true;
  }
  data_->wake.notify_one();
}

void PlayerRemote::give(std::uint8_t command, double value)
{
  PlayerControl::Request request;
  request.command = command;
  request.value = value;
  {
    const std::lock_guard<std::mutex> lock(data_->mutex);
    if (isSeek(command) && !data_->waiting.empty() && isSeek(data_->waiting.back().command))
      data_->waiting.back() = request;
    else if (data_->waiting.size() < kMostCommands)
      data_->waiting.push_back(request);
  }
  data_->wake.notify_one();
}

std::string PlayerRemote::answer() const
{
  const std::lock_guard<std::mutex> lock(data_->mutex);
  return data_->answer;
}

void PlayerRemote::loop(const std::shared_ptr<Data>& data)
{
  std::unique_lock<std::mutex> lock(data->mutex);
  while (true)
  {
    data->wake.wait(lock, [&data] { return data->is_ending || !data->waiting.empty(); });
    if (data->is_ending)
      return;
    const PlayerControl::Request request = data->waiting.front();
    data->waiting.pop_front();
    lock.unlock();
    std::string answer;
    try
    {
      answer = data->call(request);
    }
    catch (const std::exception& error)
    {
      answer = error.what();
    }
    lock.lock();
    data->answer = answer;
  }
}

}  // namespace endovascular_sim::rviz_plugin
