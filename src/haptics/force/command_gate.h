#pragma once

#include <cstdint>

#include "haptics/force/hand_motion.h"

namespace endovascular_sim::haptics
{

/** Result of a command that a gate has examined. */
enum class CommandVerdict
{
  kAccepted,
  kNotFinite,
  kOutOfRange,  ///< beyond the travel of the instrument
  kJump,        ///< further from the last accepted command than isJump() allows
};

/** Numbers of rejected commands. */
struct RejectedCommands
{
  std::uint64_t not_finite = 0;
  std::uint64_t out_of_range = 0;
  std::uint64_t jumps = 0;

  std::uint64_t total() const { return not_finite + out_of_range + jumps; }
};

/** Filter between the commands of a client and the motion of an instrument.
 *
 *  A rejected command has no effect. A jump is measured from the last accepted command, so that one wrong number in a
 *  stream is rejected and the next correct one is accepted. The first command after kSilence may be anywhere within the
 *  travel; it is approached at limited speed. During an approach, a command near the present position is accepted too,
 *  so that a wrong first command is corrected by the next one. Times are simulated ones: the result depends on the
 *  order of commands and steps only. */
class CommandGate
{
public:
  static constexpr double kSilence = 0.2;          ///< interval without an accepted command that ends a stream [s]
  static constexpr double kApproachSpeed = 0.1;    ///< speed of an approach [m/s]
  static constexpr double kApproachTurn = 3.0;     ///< angular speed of an approach [rad/s]
  static constexpr double kLargestTurns = 1000.0;  ///< largest magnitude of a rotation [turns]

  /** @param start position of the instrument at the first step
   *  @param travel largest magnitude of an insertion [m] */
  CommandGate(const HandMotion& start, double travel) : target_(start), position_(start), travel_(travel) {}

  /** Examines a command and takes it over if it is accepted. */
  CommandVerdict offer(const HandMotion& command);

  /** Advances by a step of the simulation.
   *  @param dt duration of the step [s]
   *  @return command of the step */
  const HandMotion& next(double dt);

  /** Number of accepted commands. */
  std::uint64_t accepted() const { return accepted_; }

  const RejectedCommands& rejected() const { return rejected_; }

  /** Simulated time since the last accepted command [s]; infinite before the first. */
  double silence() const;

private:
  CommandVerdict examine(const HandMotion& command) const;

  HandMotion target_;    ///< last accepted command
  HandMotion position_;  ///< command of the last step
  double travel_;
  double silence_ = 0.0;  ///< since the last accepted command, or since the start [s]
  bool approaching_ = false;
  std::uint64_t accepted_ = 0;
  RejectedCommands rejected_;
};

}  // namespace endovascular_sim::haptics
