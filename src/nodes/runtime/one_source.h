#pragma once

#include <chrono>
#include <stdexcept>
#include <string>

namespace endovascular_sim::nodes
{

/** Publisher that a subscription follows, for topics in lock-step: the first one, until it has been silent for
 * kSilence. A message of another node at the wrong moment would stop the simulation, however valid it is. */
class OneSource
{
public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kSilence{2};

  /** @param publisher name of the message's node
   *  @throws std::runtime_error for a message of another node */
  void require(const std::string& publisher, Clock::time_point now = Clock::now())
  {
    if (publisher != source_ && now - heard_ < kSilence)
      throw std::runtime_error("a message of " + publisher + ", while " + source_ + " publishes too");
    source_ = publisher;
    heard_ = now;
  }

private:
  std::string source_;
  Clock::time_point heard_;  ///< time of its last message
};

}  // namespace endovascular_sim::nodes
