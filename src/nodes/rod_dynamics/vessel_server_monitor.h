#pragma once

#include <ros/ros.h>

#include "endovascular_sim/GetVessel.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

/** Detects the end of vessel_server by a persistent connection to its service, which the operating system closes with
 *  the process. A subscription is not sufficient: roscpp reconnects it silently, and the master does not notice a
 * crash.
 *
 *  Without the service at construction there is nothing to monitor, and hasEnded() remains false. */
class VesselServerMonitor
{
public:
  explicit VesselServerMonitor(ros::NodeHandle& node)
  {
    const std::string service = node.resolveName(names::kGetVessel);
    if (ros::service::exists(service, false))
      connection_ = node.serviceClient<GetVessel>(service, true);
    is_connected_ = connection_.isValid();
  }

  /** @return true after the end of the process, or after a loss of the connection to its machine */
  bool hasEnded() { return is_connected_ && !connection_.isValid(); }

private:
  ros::ServiceClient connection_;
  bool is_connected_ = false;
};

}  // namespace endovascular_sim::nodes
