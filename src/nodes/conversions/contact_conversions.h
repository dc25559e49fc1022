#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>

#include "contact/contract/contact_set.h"
#include "endovascular_sim/RodState.h"

namespace endovascular_sim::nodes
{

geometry_msgs::Point toPoint(const Eigen::Vector3d& v);
geometry_msgs::Vector3 toVector(const Eigen::Vector3d& v);
Eigen::Vector3d fromMessage(const geometry_msgs::Point& p);
Eigen::Vector3d fromMessage(const geometry_msgs::Vector3& v);

/** What the rod asks of the contact node, every number bit for bit; headers are left to the caller. Its answers are
 *  sent and read as they are (contact_message.h). */
void toMessage(const contact::Query& query, RodState& message);
void fromMessage(const RodState& message, contact::Query& query);

}  // namespace endovascular_sim::nodes
