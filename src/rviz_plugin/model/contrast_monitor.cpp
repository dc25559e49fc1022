#include "rviz_plugin/model/contrast_monitor.h"

#include <cmath>

#include "common/error.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::rviz_plugin
{

void ContrastMonitor::add(const ContrastState& message)
{
  for (const double value : {message.rate, message.remaining, message.syringe, message.volume})
    if (!std::isfinite(value) || value < 0.0)
      throw InputError(nodes::names::kContrastState, "rate, remaining, syringe, volume",
                       "must be finite and at least 0");
  status_ = {message.rate, message.remaining, message.syringe, message.volume};
  without_ = 0;
}

void ContrastMonitor::countWire()
{
  if (status_ && ++without_ > kMostWithout)
    *this = ContrastMonitor();
}

}  // namespace endovascular_sim::rviz_plugin
