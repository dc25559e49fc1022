#pragma once

#include <string>

#include <ros/node_handle.h>

#include "common/error.h"

namespace endovascular_sim::nodes
{

/** Pace of the simulation. It has no effect on the trajectory of given commands. */
enum class Pace
{
  kRealTime,  ///< one step per slot of the steady clock
  kFree,      ///< as fast as the machine
  kStepped,   ///< by calls of simulation/step only
};

/** Word of a pace: "real_time", "free" or "stepped". */
inline const char* nameOf(Pace pace)
{
  return pace == Pace::kRealTime ? "real_time" : pace == Pace::kFree ? "free" : "stepped";
}

/** Pace of the parameter `pace`.
 *  @throws InputError for another word */
inline Pace paceFrom(const ros::NodeHandle& parameters)
{
  const std::string word = parameters.param<std::string>("pace", nameOf(Pace::kRealTime));
  for (const Pace pace : {Pace::kRealTime, Pace::kFree, Pace::kStepped})
    if (word == nameOf(pace))
      return pace;
  throw InputError("parameter server", parameters.resolveName("pace"),
                   "is '" + word + "'; must be real_time, free or stepped");
}

}  // namespace endovascular_sim::nodes
