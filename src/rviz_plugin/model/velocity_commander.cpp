#include "rviz_plugin/model/velocity_commander.h"

#include <exception>
#include <utility>

namespace endovascular_sim::rviz_plugin
{

VelocityCommander::VelocityCommander(Send send, std::chrono::milliseconds period, std::chrono::milliseconds dead_man)
  : send_(std::move(send)), period_(period), dead_man_(dead_man), thread_([this] { run(); })
{
}

VelocityCommander::~VelocityCommander()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void VelocityCommander::hold(const HandVelocity& velocity)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (velocity.isZero())
      is_blocked_ = false;
    wanted_ = velocity;
    confirmed_ = std::chrono::steady_clock::now();
  }
  changed_.notify_all();
}

void VelocityCommander::confirm()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  confirmed_ = std::chrono::steady_clock::now();
}

bool VelocityCommander::isMoving() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return !moving_.empty();
}

std::uint64_t VelocityCommander::timeOuts() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return time_outs_;
}

void VelocityCommander::run()
{
  std::unique_lock<std::mutex> lock(mutex_);
  const auto send = [&](const HandVelocity& velocity)
  {
    lock.unlock();
    try
    {
      send_(velocity);
    }
    catch (const std::exception&)
    {
    }
    lock.lock();
  };
  while (true)
  {
    const bool is_late = std::chrono::steady_clock::now() - confirmed_ > dead_man_;
    if (!moving_.empty() && is_late)
    {
      is_blocked_ = true;
      ++time_outs_;
    }
    HandVelocity velocity = wanted_;
    if (is_ending_ || is_blocked_)
      velocity.insertion = velocity.rotation = 0.0;
    if (!moving_.empty() && (velocity.isZero() || velocity.instrument != moving_))
    {
      const std::string stopped = std::exchange(moving_, std::string());
      send({stopped, 0.0, 0.0});
      continue;  // the state may have changed meanwhile
    }
    if (is_ending_)
      return;
    if (velocity.isZero())
    {
      changed_.wait(lock);
      continue;
    }
    moving_ = velocity.instrument;
    send(velocity);
    if (!is_ending_)
      changed_.wait_for(lock, period_);
  }
}

}  // namespace endovascular_sim::rviz_plugin
