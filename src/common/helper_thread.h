#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace endovascular_sim::contact
{

/** A second thread that takes tasks off a first one. It may come as late as it likes: what it has not begun, the first
 * one does. */
class HelperThread
{
public:
  /** @param at_start what the helper does first (scheduling, processor) */
  explicit HelperThread(std::function<void()> at_start);
  ~HelperThread();
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;

  /** Runs a task for every index below @p count, each once: the caller from the first on, the helper from the last
   * down. Returns when all are done. One caller at a time.
   *  @param task does not throw, and for no index needs what another one does */
  void run(std::uint32_t count, const std::function<void(std::uint32_t)>& task);

  /** Tasks that the helper did. */
  std::uint64_t helped() const { return helped_; }

private:
  void help(const std::function<void()>& at_start);
  void takeLast();

  /** The indices that nobody has begun: begin in the lower half, end in the upper one. */
  std::atomic<std::uint64_t> open_{0};
  std::atomic<std::uint32_t> left_{0};  ///< tasks that are not done
  std::atomic<std::uint64_t> helped_{0};
  const std::function<void(std::uint32_t)>* task_ = nullptr;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  bool called_ = false;  ///< guarded, as the next one
  bool over_ = false;
  std::thread thread_;
};

/** Runs a task for every item, which for none needs what it does for another one.
 *  @param helper takes some of them where there are many; null: none */
template <typename Task>
void forEach(HelperThread* helper, const std::vector<int>& items, Task task)
{
  constexpr std::size_t kFew = 100;
  constexpr std::size_t kParts = 8;
  const auto run = [&items, &task](std::size_t part, std::size_t parts)
  {
    for (std::size_t k = items.size() * part / parts; k < items.size() * (part + 1) / parts; ++k)
      task(items[k]);
  };
  if (helper == nullptr || items.size() < kFew)
    run(0, 1);
  else
    helper->run(kParts, [&run](std::uint32_t part) { run(part, kParts); });
}

}  // namespace endovascular_sim::contact
