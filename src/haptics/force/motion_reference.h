#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptics/force/hand_motion.h"

namespace endovascular_sim::haptics
{

/** Continuous motion command from the device's position count.
 *
 *  The count restarts with the device. The command is the count relative to an anchor, so it never jumps. */
class MotionReference
{
public:
  /** @param start command at the first sample */
  explicit MotionReference(const HandMotion& start = {}) : command_(start), base_(start) {}

  /** Converts the device's count. A jump is measured from the last accepted sample (isJump()).
   *  @return command; none if the sample is rejected (not finite, or an isolated jump) */
  std::optional<HandMotion> update(const HandMotion& count);

  /** Replaces the command; the next sample anchors the count at it. */
  void startAt(const HandMotion& command)
  {
    command_ = base_ = command;
    anchored_ = false;
  }

  /** Holds the command; the next sample re-anchors the count. */
  void hold() { anchored_ = false; }

  const HandMotion& command() const { return command_; }
  std::uint64_t rejected() const { return rejected_; }  ///< number of rejected samples
  std::uint64_t rebased() const { return rebased_; }    ///< number of re-anchorings after the first anchor

private:
  void anchor(const HandMotion& count);

  HandMotion command_;
  HandMotion base_;                    ///< command at the anchor
  HandMotion reference_;               ///< count at the anchor
  HandMotion last_;                    ///< last accepted count
  std::optional<HandMotion> suspect_;  ///< rejected count after a jump, until the next sample confirms or refutes it
  bool anchored_ = false;
  bool started_ = false;
  std::uint64_t rejected_ = 0;
  std::uint64_t rebased_ = 0;
};

/** Ring buffer of commands with their device times. It identifies the sample that a force responds to. */
class SampleTimes
{
public:
  void add(const HandMotion& command, std::uint32_t time);
  void clear() { count_ = 0; }
  /** Device time of the newest sample with exactly this command, among the last 4096 [µs]. */
  std::optional<std::uint32_t> find(const HandMotion& command) const;

private:
  struct Entry
  {
    HandMotion command;
    std::uint32_t time = 0;
  };
  std::array<Entry, 4096> entries_;
  std::size_t count_ = 0;  ///< number of entries ever added
};

}  // namespace endovascular_sim::haptics
