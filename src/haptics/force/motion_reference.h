#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace endovascular_sim::haptics
{

/** Position of the user's hand on the instrument. */
struct HandMotion
{
  double insertion = 0.0;  ///< [m]
  double rotation = 0.0;   ///< [rad]
};

/** Continuous motion command from the device's position count.
 *
 *  The count restarts with the device. The command is the count relative to an anchor, so it never jumps. */
class MotionReference
{
public:
  /** Largest change of the insertion between samples; a larger one is a glitch or a restart [m]. */
  static constexpr double kLargestInsertionStep = 20e-3;
  /** Largest change of the rotation between samples [rad]. */
  static constexpr double kLargestRotationStep = 3.0;

  /** @param start command at the first sample */
  explicit MotionReference(const HandMotion& start = {}) : command_(start), base_(start) {}

  /** Converts the device's count.
   *  @return command; none if the sample is rejected (not finite, or an isolated jump) */
  std::optional<HandMotion> update(const HandMotion& count);

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
