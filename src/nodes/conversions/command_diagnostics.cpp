#include "nodes/conversions/command_diagnostics.h"

#include <string>

namespace endovascular_sim::nodes
{

void fill(CommandReport& report, const drive::Arbiter& arbiter)
{
  report.driver = arbiter.isTimedOut() ? "" : arbiter.driver();
  report.last_refusal = arbiter.lastRefusal();
  report.accepted = arbiter.accepted();
  report.rejected = arbiter.rejected();
  report.silence = arbiter.silence();
}

void diagnoseCommands(const CommandReport& report, diagnostic_updater::DiagnosticStatusWrapper& status)
{
  using diagnostic_msgs::DiagnosticStatus;
  const std::uint64_t rejected = report.rejected.total();
  const std::string& name = report.instrument;
  if (!report.has_publisher)
    status.mergeSummary(DiagnosticStatus::WARN, "no publisher of commands to " + name);
  if (!report.warning.empty())
    status.mergeSummary(DiagnosticStatus::WARN, name + ": " + report.warning);
  if (rejected > 0)
    status.mergeSummary(DiagnosticStatus::WARN, std::to_string(rejected) + " rejected commands to " + name);
  status.add(name + ": driver", report.driver);
  status.add(name + ": accepted commands", report.accepted);
  status.add(name + ": rejected, malformed", report.rejected.malformed);
  status.add(name + ": rejected, not finite", report.rejected.not_finite);
  status.add(name + ": rejected, out of range", report.rejected.out_of_range);
  status.add(name + ": rejected, jumps", report.rejected.jumps);
  status.add(name + ": rejected, another client drives", report.rejected.foreign);
  status.add(name + ": rejected, not enabled", report.rejected.not_enabled);
  status.add(name + ": clamped commands", report.rejected.clamped);
  status.add(name + ": last rejection", report.last_refusal);
  status.add(name + ": time since the last command [s]", report.silence);
}

}  // namespace endovascular_sim::nodes
