#include "visualization/wall_heat_map.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace endovascular_sim::visualization
{

WallHeatMap::WallHeatMap(geometry::TriangleMesh mesh, double radius, double inset)
  : mesh_(std::move(mesh)),
    radius_(radius),
    normals_(mesh_.vertices.size(), Eigen::Vector3d::Zero()),
    inset_(mesh_.vertices),
    tree_(mesh_.vertices)
{
  for (const Eigen::Vector3i& corners : mesh_.triangles)
    for (int k = 0; k < 3; ++k)
      normals_[corners[k]] += normalOf(corners);  // weighted by area, sufficient for display
  for (std::size_t v = 0; v < normals_.size(); ++v)
  {
    normals_[v].normalize();
    inset_[v] -= inset * normals_[v];
  }
}

Eigen::Vector3d WallHeatMap::normalOf(const Eigen::Vector3i& corners) const
{
  const Eigen::Vector3d& a = mesh_.vertices[corners[0]];
  return (mesh_.vertices[corners[1]] - a).cross(mesh_.vertices[corners[2]] - a);
}

HeatPatch WallHeatMap::patch(const std::vector<std::uint32_t>& triangles, const std::vector<float>& values) const
{
  std::vector<double> heat(mesh_.vertices.size(), 0.0);
  for (std::size_t k = 0; k < std::min(triangles.size(), values.size()); ++k)
  {
    if (triangles[k] >= mesh_.triangles.size())
      continue;
    const Eigen::Vector3i& corners = mesh_.triangles[triangles[k]];
    const double value = values[k];
    const Eigen::Vector3d normal = normalOf(corners);
    const Eigen::Vector3d centre =
        (mesh_.vertices[corners[0]] + mesh_.vertices[corners[1]] + mesh_.vertices[corners[2]]) / 3.0;
    for (int c = 0; c < 3; ++c)
      heat[corners[c]] = std::max(heat[corners[c]], value);
    tree_.within(centre, radius_,
                 [&](int vertex)
                 {
                   if (normals_[vertex].dot(normal) <= 0.0)
                     return;
                   const double share = (mesh_.vertices[vertex] - centre).squaredNorm() / (radius_ * radius_);
                   heat[vertex] = std::max(heat[vertex], value * (1.0 - share) * (1.0 - share));
                 });
  }
  HeatPatch patch;
  for (const Eigen::Vector3i& corners : mesh_.triangles)
  {
    if (heat[corners[0]] + heat[corners[1]] + heat[corners[2]] <= 0.0)
      continue;
    for (int k = 0; k < 3; ++k)
    {
      patch.corners.push_back(inset_[corners[k]]);
      patch.values.push_back(heat[corners[k]]);
    }
  }
  return patch;
}

}  // namespace endovascular_sim::visualization
