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

/** Converts a query to its message, bit for bit; the caller sets the header. Contact sets need no conversion
 *  (contact_set_serializer.h).
 *  @param wanted_free_distance of a query for free distances [m]; 0: a query for features */
void toMessage(const contact::Query& query, double wanted_free_distance, RodState& message);
/** Inverse of toMessage; message.wanted_free_distance is left to the caller. */
void fromMessage(const RodState& message, contact::Query& query);

}  // namespace endovascular_sim::nodes
