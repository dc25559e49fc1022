#pragma once

#include <cstdint>

#include "drive/drive_limits.h"
#include "drive/hand_motion.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::drive
{

/** Result of a command that has been examined. */
enum class CommandVerdict
{
  kAccepted,
  kMalformed,  ///< joints missing, repeated or unknown, or a pressure out of range
  kNotFinite,
  kOutOfRange,  ///< position, speed or force beyond the limits
  kJump,        ///< further from the last accepted position than the largest step
  kForeign,     ///< another client drives the instrument
  kNotEnabled,  ///< the instrument is disabled, paused, or not homed
};

/** Numbers of commands that were not taken over as they were. */
struct RejectedCommands
{
  std::uint64_t malformed = 0;
  std::uint64_t not_finite = 0;
  std::uint64_t out_of_range = 0;
  std::uint64_t jumps = 0;
  std::uint64_t foreign = 0;
  std::uint64_t not_enabled = 0;
  std::uint64_t clamped = 0;  ///< taken over with a limit in place of a value; no rejection

  /** Counts a verdict. */
  void add(CommandVerdict verdict);
  /** Number of rejections. */
  std::uint64_t total() const { return malformed + not_finite + out_of_range + jumps + foreign + not_enabled; }
};

/** Range of the commands to an instrument whose scale has slipped. A slip is a sum of many steps, whose rounding must
 * not exclude the ends of the range.
 *  @param range of the instrument's positions
 *  @param slipped scale of the commands minus position of the instrument */
inline Interval commandRange(const Interval& range, double slipped)
{
  constexpr double kRounding = 1e-6;  // [m] or [rad]
  return slipped == 0.0 ? range : Interval{range.low + slipped - kRounding, range.high + slipped + kRounding};
}

/** Filter between a stream of positions and the motion of an instrument.
 *
 *  A rejected command has no effect. A jump is measured from the last accepted command, so that one wrong number in a
 *  stream is rejected and the next correct one is accepted. The first command after the time-out may be anywhere within
 *  the range; it is approached at limited speed. During an approach, a command near the present position is accepted
 *  too, so that a wrong first command is corrected by the next one. Where the limits clamp, a jump is approached
 * instead of rejected. Commands that arrive between two steps, e.g. during a delay of the simulation, are executed over
 * the next steps: a hand that made up for them in one step would lose its grip. Times are simulated ones: the result
 * depends on the order of commands and steps only. */
class CommandGate
{
public:
  /** @param start position of the instrument at the first step
   *  @param limits completed ones (DriveLimits::completed()) */
  CommandGate(const HandMotion& start, const DriveLimits& limits) : target_(start), position_(start), limits_(limits) {}

  /** Examines a command and takes it over if it is accepted.
   *  @param slipped slipped motion of the handle [m], [rad]; it shifts the permitted range of the commands */
  CommandVerdict offer(HandMotion command, const HandMotion& slipped = {});

  /** Replaces a target beyond a stop by the stop. A position beyond it returns at once.
   *  @param stops of the insertion [m] */
  void stopAt(const Interval& stops);

  /** Advances by a step of another mode: jumps are measured from its position.
   *  @param dt duration of the step [s] */
  void follow(const HandMotion& position, double dt);

  /** Advances by a step of the simulation.
   *  @param dt duration of the step [s]
   *  @return command of the step */
  const HandMotion& next(double dt);

  const HandMotion& target() const { return target_; }      ///< last accepted command
  const HandMotion& position() const { return position_; }  ///< command of the last step

  /** Number of accepted commands. */
  std::uint64_t accepted() const { return accepted_; }

  const RejectedCommands& rejected() const { return rejected_; }

  /** Simulated time since the last accepted command [s]; infinite before the first. */
  double silence() const;

  /** Saves or loads all data that change, without the numbers of rejections. @throws ArchiveError for invalid ones */
  void archive(Archive& archive);

private:
  bool isNear(const HandMotion& command) const;
  bool isFirst() const { return accepted_ == 0 || silence_ >= limits_.time_out; }
  void followStream();
  CommandVerdict examine(HandMotion& command, const HandMotion& slipped);

  HandMotion target_;
  HandMotion position_;
  HandMotion longest_;  ///< longest motions by one command since the position was at the target
  DriveLimits limits_;
  double silence_ = 0.0;  ///< since the last accepted command, or since the start [s]
  bool approaching_ = false;
  std::uint64_t accepted_ = 0;
  RejectedCommands rejected_;
};

}  // namespace endovascular_sim::drive
