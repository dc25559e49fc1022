#include "nodes/rod_dynamics/instruments/command_diagnostics.h"

#include <string>

namespace endovascular_sim::nodes
{
namespace
{

using diagnostic_msgs::DiagnosticStatus;

void diagnose(const CommandReport& report, diagnostic_updater::DiagnosticStatusWrapper& status)
{
  const std::uint64_t rejected = report.rejected.total();
  const std::string& name = report.instrument;
  if (!report.has_publisher)
    status.mergeSummary(DiagnosticStatus::WARN, "no publisher of commands to " + name);
  else if (report.accepted == 0)
    status.mergeSummary(DiagnosticStatus::WARN, "no command to " + name + " accepted");
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

}  // namespace

void diagnoseCommands(const std::vector<CommandReport>& reports, const std::vector<UnreadTopic>& unread,
                      diagnostic_updater::DiagnosticStatusWrapper& status)
{
  for (const CommandReport& report : reports)
    diagnose(report, status);
  for (const UnreadTopic& topic : unread)
  {
    status.mergeSummary(DiagnosticStatus::WARN, "nobody reads " + topic.topic + ": " + topic.remedy);
    status.add(topic.topic + ": not read", topic.remedy);
  }
}

}  // namespace endovascular_sim::nodes
