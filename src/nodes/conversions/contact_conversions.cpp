#include "nodes/conversions/contact_conversions.h"

namespace endovascular_sim::nodes
{

geometry_msgs::Point toPoint(const Eigen::Vector3d& v)
{
  geometry_msgs::Point point;
  point.x = v.x();
  point.y = v.y();
  point.z = v.z();
  return point;
}

geometry_msgs::Vector3 toVector(const Eigen::Vector3d& v)
{
  geometry_msgs::Vector3 vector;
  vector.x = v.x();
  vector.y = v.y();
  vector.z = v.z();
  return vector;
}

Eigen::Vector3d fromMessage(const geometry_msgs::Point& p)
{
  return {p.x, p.y, p.z};
}

Eigen::Vector3d fromMessage(const geometry_msgs::Vector3& v)
{
  return {v.x, v.y, v.z};
}

void toMessage(const contact::Query& query, double wanted_free_distance, RodState& message)
{
  message.step = query.step;
  message.substep = static_cast<std::uint16_t>(query.substep);
  message.pass = static_cast<std::uint16_t>(query.pass);
  message.wanted_free_distance = wanted_free_distance;
  message.vessel_version = query.vessel_version;
  message.first_node = static_cast<std::uint32_t>(query.first_node);
  message.radius = query.radius;
  message.margin = query.margin;
  message.nodes.resize(query.nodes.size());
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
    message.nodes[i] = toPoint(query.nodes[i]);
}

void fromMessage(const RodState& message, contact::Query& query)
{
  query.step = message.step;
  query.substep = message.substep;
  query.pass = message.pass;
  query.vessel_version = message.vessel_version;
  query.first_node = static_cast<int>(message.first_node);
  query.radius = message.radius;
  query.margin = message.margin;
  query.nodes.resize(message.nodes.size());
  for (std::size_t i = 0; i < message.nodes.size(); ++i)
    query.nodes[i] = fromMessage(message.nodes[i]);
}

}  // namespace endovascular_sim::nodes
