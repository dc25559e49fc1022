#pragma once

#include <string>

#include <diagnostic_msgs/DiagnosticStatus.h>

namespace endovascular_sim::rviz_plugin
{

/** Text of a warning or an error of the diagnostics for the panel.
 *
 *  In a lesson, warnings are those that a trainee understands and that matter: late steps if they are more than 10 % of
 *  all, and none of an instrument, whose state the notice explains.
 *  @param is_lesson true: a person does the steps of a procedure
 *  @return empty for a status that is not shown */
std::string diagnosisText(const diagnostic_msgs::DiagnosticStatus& status, bool is_lesson);

}  // namespace endovascular_sim::rviz_plugin
