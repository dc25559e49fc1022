#pragma once

#include <cstdint>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>

#include "drive/arbiter.h"

namespace endovascular_sim::nodes
{

/** Commands to one instrument or to a robot, for reports. */
struct CommandReport
{
  std::string instrument;  ///< resolved name of its topics, without the last part
  bool has_publisher = false;
  std::string driver;        ///< client that drives; empty without one
  std::string last_refusal;  ///< empty without one
  std::string warning;       ///< of the grip; empty without one
  std::uint64_t accepted = 0;
  drive::RejectedCommands rejected;
  double silence = 0.0;  ///< simulated time since the last accepted command [s]
};

/** Takes over driver, last refusal, numbers and silence. */
void fill(CommandReport& report, const drive::Arbiter& arbiter);

/** Adds commands to the diagnostics. A missing publisher and rejected commands are warnings. */
void diagnoseCommands(const CommandReport& report, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace endovascular_sim::nodes
