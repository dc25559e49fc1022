#pragma once

#include <string>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>

#include "drive/operating_state.h"

namespace endovascular_sim::nodes
{

/** Message of an operating state; its reason is a message of its own. */
inline crtk_msgs::OperatingState toMessage(const drive::ControlState& state, const ros::Time& stamp)
{
  crtk_msgs::OperatingState message;
  message.header.stamp = stamp;
  message.state = drive::nameOf(state.state);
  message.is_homed = state.is_homed;
  message.is_busy = state.is_busy;
  return message;
}

/** Message of the reason of a state. */
inline crtk_msgs::StringStamped reasonMessage(const std::string& reason, const ros::Time& stamp)
{
  crtk_msgs::StringStamped message;
  message.header.stamp = stamp;
  message.string = reason;
  return message;
}

/** Takes over the operating state of a message, without its reason. A state that CRTK does not define is a fault. */
inline void fromMessage(const crtk_msgs::OperatingState& message, drive::ControlState& state)
{
  state.state = drive::operatingState(message.state).value_or(drive::OperatingState::kFault);
  state.is_homed = message.is_homed;
  state.is_busy = message.is_busy;
}

}  // namespace endovascular_sim::nodes
