#pragma once

#include <cmath>
#include <string>

#include <ros/console.h>
#include <ros/node_handle.h>

#include "common/error.h"
#include "common/quantities.h"

namespace endovascular_sim::nodes
{

/** Number of a parameter. An unusual value is logged as a warning.
 *  @throws InputError for a value that is not finite or impossible */
inline double numericParameter(const ros::NodeHandle& parameters, const std::string& name, double fallback,
                               const Quantity& quantity)
{
  const double value = parameters.param(name, fallback);
  if (!std::isfinite(value))
    throw InputError("parameter server", parameters.resolveName(name), "is not finite; must be a number");
  const Plausibility result = plausibility(quantity, value);
  if (result == Plausibility::kImpossible)
    throw InputError("parameter server", parameters.resolveName(name), plausibilityMessage(quantity, value));
  if (result == Plausibility::kUnusual)
    ROS_WARN("parameter %s: %s", parameters.resolveName(name).c_str(), plausibilityMessage(quantity, value).c_str());
  return value;
}

}  // namespace endovascular_sim::nodes
