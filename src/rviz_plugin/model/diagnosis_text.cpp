#include "rviz_plugin/model/diagnosis_text.h"

#include <cstdlib>

namespace endovascular_sim::rviz_plugin
{
namespace
{

using diagnostic_msgs::DiagnosticStatus;

constexpr auto kSteps = "rod_dynamics: simulation";  // status of the steps
constexpr auto kOnTime = "on time [%]";
constexpr double kLeastOnTime = 90.0;  // [%]

bool beginsWith(const std::string& text, const std::string& beginning)
{
  return text.rfind(beginning, 0) == 0;
}

/** Share of the steps that are on time [%]; 100 if it is unknown. */
double onTime(const DiagnosticStatus& status)
{
  for (const diagnostic_msgs::KeyValue& value : status.values)
    if (value.key == kOnTime)
      return std::strtod(value.value.c_str(), nullptr);
  return 100.0;
}

}  // namespace

std::string diagnosisText(const DiagnosticStatus& status, bool is_lesson)
{
  const std::string text = status.name + ": " + status.message;
  if (status.level == DiagnosticStatus::OK)
    return {};
  if (!is_lesson || status.level != DiagnosticStatus::WARN)
    return text;
  if (beginsWith(status.name, "/instruments/"))
    return {};
  if (status.name != kSteps || beginsWith(status.message, "paused"))
    return text;
  return onTime(status) < kLeastOnTime ? "this computer is too slow: the simulation lags behind real time" : "";
}

}  // namespace endovascular_sim::rviz_plugin
