#pragma once

#include <atomic>

namespace endovascular_sim::nodes
{

/** How long a loop waits for an answer. One that has nothing from the other side after a failure waits a fraction only
 *  and keeps its pace; where answers come late, to questions of before, the other side is at work and is waited for in
 *  full: with a fraction it would stay a question behind for ever. heardLate() may be called from another thread. */
class ResponseTimeout
{
public:
  /** @param patience for one answer [s] */
  explicit ResponseTimeout(double patience) : patience_(patience) {}

  /** For the question that is asked now [s]. */
  double next() { return silent_ && !late_.exchange(false) ? kSilent * patience_ : patience_; }

  void answered() { silent_ = false; }
  void missed() { silent_ = true; }
  void heardLate() { late_ = true; }

  bool silent() const { return silent_; }  ///< the last question was not answered

private:
  static constexpr double kSilent = 0.1;  // of the patience

  double patience_;
  bool silent_ = false;
  std::atomic<bool> late_{false};
};

}  // namespace endovascular_sim::nodes
