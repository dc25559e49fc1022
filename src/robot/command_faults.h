#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drive/hand_command.h"
#include "drive/hand_motion.h"
#include "robot/command_fault.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::robot
{

/** Faults of a robot between the commands of a step and the handles. Several faults of an axis act one after the other.
 *  Without faults the commands pass unchanged. */
class CommandFaults
{
public:
  /** @param faults of the scene
   *  @param start commands before the first step, one per instrument
   *  @param time_step [s]
   *  @param seed of the run; varies the faulty intervals */
  CommandFaults(const std::vector<FaultSettings>& faults, std::vector<drive::HandCommand> start, double time_step,
                std::uint64_t seed);

  /** True if commands pass unchanged: no fault is present, nor has one that was removed slipped. */
  bool empty() const { return faults_.empty() && !keeps_offsets_; }

  /** Faults of the scene, and those that were added. */
  std::vector<FaultSettings> settings() const;

  /** Adds a fault. @pre refusalOf() is empty and the instrument exists */
  void add(const FaultSettings& fault);

  /** Removes all faults of an axis. Slipped motion stays lost.
   *  @return number of faults that were removed */
  std::size_t remove(std::size_t instrument, FaultAxis axis);

  /** Varies the faulty intervals from now on. */
  void setSeed(std::uint64_t seed);

  /** Commands that the handles follow in a step.
   *  @param step number of steps before it
   *  @param commands one per instrument
   *  @return the commands themselves without a fault */
  const std::vector<drive::HandCommand>& execute(std::uint64_t step, const std::vector<drive::HandCommand>& commands);

  /** Command minus executed position of an instrument after the last step. */
  const drive::HandMotion& lag(std::size_t instrument) const { return lags_[instrument]; }

  /** Begins again, with all instruments at rest at these commands. */
  void restAt(const std::vector<drive::HandCommand>& commands);

  /** Saves or loads all data, also the faults themselves. @throws ArchiveError for invalid data */
  void archive(Archive& archive);

private:
  double& offset(std::size_t instrument, FaultAxis axis);

  double time_step_;  ///< [s]
  std::uint64_t seed_;
  std::vector<CommandFault> faults_;
  std::vector<drive::HandMotion> offsets_;    ///< motion that slipped in removed faults, one per instrument
  std::vector<drive::HandMotion> lags_;       ///< one per instrument
  std::vector<drive::HandCommand> executed_;  ///< in the last step
  bool keeps_offsets_ = false;                ///< an offset is not zero
};

}  // namespace endovascular_sim::robot
