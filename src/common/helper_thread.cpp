#include "common/helper_thread.h"

#include <chrono>
#include <utility>

namespace endovascular_sim::contact
{
namespace
{

// For so long the caller looks whether the helper is done before it sleeps: about what a part of a search takes.
constexpr std::chrono::microseconds kLook{30};
constexpr std::uint64_t kLower = 0xffffffff;

std::uint32_t begin(std::uint64_t open)
{
  return static_cast<std::uint32_t>(open & kLower);
}

std::uint32_t end(std::uint64_t open)
{
  return static_cast<std::uint32_t>(open >> 32);
}

std::uint64_t range(std::uint32_t begin, std::uint32_t end)
{
  return std::uint64_t{begin} | std::uint64_t{end} << 32;
}

}  // namespace

HelperThread::HelperThread(std::function<void()> at_start)
  : thread_([this, at_start = std::move(at_start)] { help(at_start); })
{
}

HelperThread::~HelperThread()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void HelperThread::run(std::uint32_t count, const std::function<void(std::uint32_t)>& task)
{
  task_ = &task;
  left_ = count;
  open_ = range(0, count);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    called_ = true;
  }
  wake_.notify_one();
  std::uint64_t open = open_;
  while (begin(open) < end(open))
    if (open_.compare_exchange_weak(open, range(begin(open) + 1, end(open))))
    {
      task(begin(open));
      --left_;
      open = open_;
    }
  const auto until = std::chrono::steady_clock::now() + kLook;
  while (left_ > 0 && std::chrono::steady_clock::now() < until)
  {
  }
  std::unique_lock<std::mutex> lock(mutex_);
  called_ = false;
  done_.wait(lock, [this] { return left_ == 0; });
}

void HelperThread::takeLast()
{
  std::uint64_t open = open_;
  while (begin(open) < end(open))
    if (open_.compare_exchange_weak(open, range(begin(open), end(open) - 1)))
    {
      (*task_)(end(open) - 1);
      ++helped_;
      if (--left_ == 0)
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        done_.notify_one();
      }
      open = open_;
    }
}

void HelperThread::help(const std::function<void()>& at_start)
{
  at_start();
  std::unique_lock<std::mutex> lock(mutex_);
  while (true)
  {
    wake_.wait(lock, [this] { return called_ || over_; });
    if (over_)
      return;
    called_ = false;
    lock.unlock();
    takeLast();
    lock.lock();
  }
}

}  // namespace endovascular_sim::contact
