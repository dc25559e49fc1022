#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <vector>

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::robot
{

enum class FaultKind
{
  kStuck,     ///< the handle stays where it is, and follows the command again afterwards
  kSlipping,  ///< a share of every motion is lost for good
  kDelayed,   ///< the handle follows the commands after a delay
  kBacklash,  ///< the handle follows after the play has been used up
};

/** Words of the kinds, in their order. */
const std::vector<std::string>& faultWords();

/** Axis of an instrument that a robot drives. */
enum class FaultAxis
{
  kInsertion,  ///< [m]
  kRotation,   ///< [rad]
};

/** Words of the axes, in their order. */
const std::vector<std::string>& axisWords();

/** Fault of a robot's drive on one axis of an instrument. */
struct FaultSettings
{
  std::size_t instrument = 0;
  FaultAxis axis = FaultAxis::kInsertion;
  FaultKind kind = FaultKind::kStuck;
  double amount = 0.0;  ///< share of the motion that slips [1], delay [s], or play [m or rad]; 0 when stuck
  double start = 0.0;   ///< simulated time of the first faulty step [s]
  double end = std::numeric_limits<double>::infinity();  ///< simulated time of its end [s]
  double probability = 1.0;                              ///< that an interval from start to end is faulty [1]
  double interval = 0.1;                                 ///< [s]
  std::uint64_t seed = 0;                                ///< selects the faulty intervals

  void archive(Archive& archive);
};

/** Reason for which values of a fault are refused, beginning with the name of the value; empty without one. The names
 * are `amount`, `start`, `end`, `probability` and `interval`. */
std::string refusalOf(const FaultSettings& fault);

/** Fault at work: positions that the handle is to take, from those that were commanded. A function of the steps, the
 *  commands and the seeds only. */
class CommandFault
{
public:
  CommandFault() = default;  ///< to be loaded

  /** @param time_step [s]
   *  @param seed of the run; varies the faulty intervals
   *  @param position commanded position before the first step [m or rad] */
  CommandFault(const FaultSettings& settings, double time_step, std::uint64_t seed, double position);

  const FaultSettings& settings() const { return settings_; }

  void setSeed(std::uint64_t seed) { seed_ = seed; }

  /** True if the fault acts in the step that begins after a number of steps. */
  bool isActive(std::uint64_t step) const;

  /** Position of the handle in a step.
   *  @param step number of steps before it */
  double execute(std::uint64_t step, double commanded);

  /** Commanded minus executed position that a slipping drive does not make up for. */
  double slipped() const { return slipped_; }

  /** Begins again at a position, as after a long rest. */
  void restAt(double position);

  /** Saves or loads all data. @throws ArchiveError for invalid data */
  void archive(Archive& archive);

private:
  double delayed(double commanded);

  FaultSettings settings_;
  double time_step_ = 0.0;      ///< [s]
  std::uint64_t seed_ = 0;      ///< of the run
  double commanded_ = 0.0;      ///< in the last step
  double executed_ = 0.0;       ///< in the last step
  double slipped_ = 0.0;        ///< commanded minus executed positions of a slipping drive
  std::deque<double> waiting_;  ///< commands of a delayed drive that were not executed yet
};

}  // namespace endovascular_sim::robot
