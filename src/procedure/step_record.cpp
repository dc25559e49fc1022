#include "procedure/step_record.h"

#include <cmath>

#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::procedure
{
namespace
{

using scene::StepAction;

std::string goalOf(const std::string& verb, const scene::StepScene& step)
{
  std::string text = verb + " " + step.instrument;
  if (!step.until.tip_in.empty())
    text += " until its tip is in " + step.until.tip_in;
  if (!step.until.balloon_in.empty())
    text += " until its balloon is in " + step.until.balloon_in;
  if (!std::isnan(step.until.beyond))
    text += formatted(" by %.1f mm", 1e3 * step.until.beyond);
  if (step.until.outside)
    text += " until it is out";
  if (!std::isnan(step.until.insertion))
    text += formatted(" to %.1f mm", 1e3 * step.until.insertion);
  if (!std::isnan(step.until.by))
    text += formatted(" by %.1f mm", 1e3 * step.until.by);
  if (!std::isnan(step.until.turned))
    text += formatted(" by %.2f rad", step.until.turned);
  return text;
}

}  // namespace

std::string nameOf(const scene::StepScene& step)
{
  switch (step.action)
  {
    case StepAction::kAdvance:
      return goalOf("advance", step);
    case StepAction::kWithdraw:
      return goalOf("withdraw", step);
    case StepAction::kRotate:
      return goalOf("rotate", step);
    case StepAction::kInflate:
      return "inflate " + step.instrument + formatted(" to %.1f atm", step.pressure / units::kAtmosphere);
    case StepAction::kInject:
      return formatted("inject %.1f ml through ", 1e6 * step.volume) + step.instrument;
    case StepAction::kExchange:
    case StepAction::kWait:
      break;
  }
  std::string wait = formatted("wait %.1f s", step.duration);
  if (step.hyperaemia)
    wait += *step.hyperaemia ? " in hyperaemia" : " at rest";
  if (step.breath_held)
    wait += *step.breath_held ? ", breath held" : ", breathing freely";
  return step.until_diastole ? wait + ", until diastole" : wait;
}

}  // namespace endovascular_sim::procedure
