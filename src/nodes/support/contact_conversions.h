#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>

#include "contact/contact_set.h"
#include "endovascular_sim/RodState.h"
#include "nodes/support/contact_message.h"

namespace endovascular_sim::nodes
{

geometry_msgs::Point toPoint(const Eigen::Vector3d& v);
geometry_msgs::Vector3 toVector(const Eigen::Vector3d& v);
Eigen::Vector3d fromMessage(const geometry_msgs::Point& p);
Eigen::Vector3d fromMessage(const geometry_msgs::Vector3& v);

/** The contract between rod and contact as messages, every number bit for bit; headers are left to the caller. */
void toMessage(const contact::Query& query, RodState& message);
void fromMessage(const RodState& message, contact::Query& query);
void toMessage(const contact::ContactSet& set, ContactSet& message);
void fromMessage(const ContactSet& message, contact::ContactSet& set);

}  // namespace endovascular_sim::nodes
