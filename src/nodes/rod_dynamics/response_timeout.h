#pragma once

#include <atomic>

namespace endovascular_sim::nodes
{

/** Timeout of a loop that queries a peer.
 *
 *  After a missed response the loop waits for a fraction of the timeout only, and so maintains its rate. If a late
 *  response to an earlier query arrives, the peer is alive, and the full timeout applies: with the fraction it would
 *  remain one query behind. receivedLate() is thread-safe. */
class ResponseTimeout
{
public:
  /** @param timeout longest wait for one response [s] */
  explicit ResponseTimeout(double timeout) : timeout_(timeout) {}

  /** Timeout of the query that is sent next [s]. */
  double next() { return silent_ && !late_.exchange(false) ? kSilentShare * timeout_ : timeout_; }

  void received() { silent_ = false; }
  void missed() { silent_ = true; }
  void receivedLate() { late_ = true; }

  bool silent() const { return silent_; }  ///< true when the last response was missed

private:
  static constexpr double kSilentShare = 0.1;  ///< share of the timeout after a missed response [1]

  double timeout_;
  bool silent_ = false;
  std::atomic<bool> late_{false};
};

}  // namespace endovascular_sim::nodes
