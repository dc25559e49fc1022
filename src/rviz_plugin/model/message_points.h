#pragma once

#include <vector>

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>
#include <Eigen/Core>

namespace endovascular_sim::rviz_plugin
{

inline Eigen::Vector3d toEigen(const geometry_msgs::Point& point)
{
  return {point.x, point.y, point.z};
}

inline Eigen::Vector3d toEigen(const geometry_msgs::Vector3& vector)
{
  return {vector.x, vector.y, vector.z};
}

/** Replaces @p points; keeps its capacity. */
inline void toEigen(const std::vector<geometry_msgs::Point>& message, std::vector<Eigen::Vector3d>& points)
{
  points.clear();
  for (const geometry_msgs::Point& point : message)
    points.push_back(toEigen(point));
}

}  // namespace endovascular_sim::rviz_plugin
