#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace endovascular_sim::haptics
{

/** Motion at the hand. */
struct HandMotion
{
  double insertion = 0.0;  ///< [m]
  double rotation = 0.0;   ///< [rad]
};

/** Turns the device's own count, which starts anew whenever it does, into a command that never jumps. */
class MotionReference
{
public:
  static constexpr double kLargestInsertionStep = 20e-3;  ///< between samples; more is a glitch or a restart [m]
  static constexpr double kLargestRotationStep = 3.0;     ///< [rad]

  /** @param start the command at the first sample */
  explicit MotionReference(const HandMotion& start = {}) : command_(start), base_(start) {}

  /** Takes the device's count.
   *  @return the command; nothing when the sample is not believed (not finite, or a jump that stands alone) */
  std::optional<HandMotion> update(const HandMotion& count);

  /** Holds the command; the next sample only tells where the device's count stands. */
  void hold() { anchored_ = false; }

  const HandMotion& command() const { return command_; }
  std::uint64_t rejected() const { return rejected_; }  ///< samples not believed
  std::uint64_t rebased() const { return rebased_; }    ///< times that the count was taken anew after the first

private:
  void anchor(const HandMotion& count);

  HandMotion command_;
  HandMotion base_;       ///< the command at the anchor
  HandMotion reference_;  ///< the count at the anchor
  HandMotion last_;       ///< the last count that was believed
  std::optional<HandMotion> suspect_;
  bool anchored_ = false;
  bool started_ = false;
  std::uint64_t rejected_ = 0;
  std::uint64_t rebased_ = 0;
};

/** Remembers which device time each command belongs to, so that a force can tell whose motion it answers. */
class SampleTimes
{
public:
  void add(const HandMotion& command, std::uint32_t time);
  void clear() { count_ = 0; }
  /** The device's time [us] of the newest sample with exactly this command, within the last 4096. */
  std::optional<std::uint32_t> find(const HandMotion& command) const;

private:
  struct Entry
  {
    HandMotion command;
    std::uint32_t time = 0;
  };
  std::array<Entry, 4096> entries_;
  std::size_t count_ = 0;  ///< ever added
};

}  // namespace endovascular_sim::haptics
