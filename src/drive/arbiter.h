#pragma once

#include <cstdint>
#include <string>

#include "drive/command_gate.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::drive
{

/** Arbiter between the clients of an instrument or a robot.
 *
 *  One client drives at a time: the first one whose command is accepted, until it sends none for the time-out, or until
 *  release(). A rejected command keeps its sender driving. Every client may enable, disable and pause. */
class Arbiter
{
public:
  /** @param driven noun for messages, e.g. "instrument"
   *  @param time_out silence after which another client may drive [s] */
  Arbiter(std::string driven, double time_out) : driven_(std::move(driven)), time_out_(time_out) {}

  /** Advances the simulated time; after its reset by a negative duration [s]. */
  void advance(double dt);

  /** @param is_busy true during a move, whose sender drives until its end */
  bool isDrivenByAnother(const std::string& client, bool is_busy = false) const;

  /** Permission of a command without values; a refusal is counted. */
  bool permits(const std::string& client, const std::string& word, bool is_busy = false);

  void accept(const std::string& client);       ///< counts an accepted command, whose sender drives
  void take(const std::string& client);         ///< lets a client drive without an accepted command
  void keepDriver() { driver_silence_ = 0.0; }  ///< counts the time-out from now on
  void release() { driver_.clear(); }           ///< nobody drives
  void countClamped(bool clamped) { rejected_.clamped += clamped; }

  /** Counts a rejection. @return its text, "COMMAND of CLIENT: REASON" */
  const std::string& reject(CommandVerdict verdict, const std::string& command, const std::string& client,
                            const std::string& reason);

  /** Takes over the number and the last reason of rejections, nothing else. */
  void copyRejections(const Arbiter& other);

  /** Reason of a refusal of another client. */
  std::string foreignReason() const { return driver_ + " drives the " + driven_; }

  const std::string& driver() const { return driver_; }             ///< client that drives; empty without one
  const std::string& lastRefusal() const { return last_refusal_; }  ///< text of the last rejection
  std::uint64_t accepted() const { return accepted_; }
  const RejectedCommands& rejected() const { return rejected_; }
  double silence() const;  ///< simulated time since the last accepted command [s]; infinite before the first
  bool isTimedOut() const { return silence_ > time_out_; }  ///< true if no command was accepted for the time-out

  /** Saves or loads the silence and the number of accepted commands; after loading nobody drives.
   *  @throws ArchiveError for invalid data */
  void archive(Archive& archive);

private:
  std::string driven_;
  double time_out_;
  std::string driver_;
  double driver_silence_ = 0.0;  ///< since the last command of the driver [s]
  double silence_ = 0.0;         ///< since the last accepted command [s]
  std::uint64_t accepted_ = 0;
  RejectedCommands rejected_;
  std::string last_refusal_;
};

}  // namespace endovascular_sim::drive
