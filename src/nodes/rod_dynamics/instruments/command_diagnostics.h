#pragma once

#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>

#include "nodes/rod_dynamics/instruments/drive_commands.h"
#include "nodes/rod_dynamics/instruments/unread_topics.h"

namespace endovascular_sim::nodes
{

/** Adds the commands of the instruments to the diagnostics. An instrument without a publisher, rejected commands, and a
 *  topic that is not read are warnings. */
void diagnoseCommands(const std::vector<CommandReport>& reports, const std::vector<UnreadTopic>& unread,
                      diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace endovascular_sim::nodes
