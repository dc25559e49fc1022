#include "rviz_plugin/model/vessel_drawing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "rviz_plugin/model/message_points.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kHeatRadius = 2e-3;   ///< distance over which the colour of a touched triangle fades [m]
constexpr double kHeatInset = 0.1e-3;  ///< distance of the coloured triangles from the wall, into the lumen [m]

geometry::TriangleMesh toMesh(const VesselMesh& message)
{
  geometry::TriangleMesh mesh;
  toEigen(message.mesh.vertices, mesh.vertices);
  for (const shape_msgs::MeshTriangle& triangle : message.mesh.triangles)
    mesh.triangles.emplace_back(static_cast<int>(triangle.vertex_indices[0]),
                                static_cast<int>(triangle.vertex_indices[1]),
                                static_cast<int>(triangle.vertex_indices[2]));
  return mesh;
}

bool isSame(const motion::Fade& a, const motion::Fade& b)
{
  return a.centre == b.centre && a.core == b.core && a.reach == b.reach;
}

const std::vector<float>& valuesOf(const ContactForceMap& message, HeatQuantity quantity)
{
  switch (quantity)
  {
    case HeatQuantity::kIntegral:
      return message.integral;
    case HeatQuantity::kTimeOverThreshold:
      return message.time_over_threshold;
    case HeatQuantity::kPeak:
      break;
  }
  return message.peak;
}

}  // namespace

std::string VesselDrawing::setVessel(const VesselMesh& message, const visualization::TranslucentColour& colour)
{
  wall_.clear();
  heat_.clear();
  heat_rest_.clear();
  heat_map_.reset();
  rest_.clear();
  moving_.clear();
  moving_rest_.clear();
  geometry::TriangleMesh mesh = toMesh(message);
  if (const char* problem = visualization::problemOfMesh(mesh))
    return problem;
  wall_ = visualization::wallSurface(mesh, colour);
  rest_ = mesh.vertices;
  if (!map_.resting())
  {
    findMoving();
    moveWall();
  }
  heat_map_ = std::make_unique<visualization::WallHeatMap>(std::move(mesh), kHeatRadius, kHeatInset);
  if (message.version <= 1 || hash_ == 0)
    hash_ = message.content_hash;  // maps contain the hash of the initial wall
  return {};
}

std::string VesselDrawing::setForces(const ContactForceMap& message, HeatQuantity quantity, double full_scale)
{
  heat_.clear();
  heat_rest_.clear();
  if (!heat_map_ || message.content_hash != hash_)
    return "waiting for the vessel of this map";
  const std::vector<float>& values = valuesOf(message, quantity);
  if (values.size() != message.triangles.size())
    return "inconsistent lengths";
  if (!std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); }))
    return "not finite";
  if (message.time < last_time_ || quantity != last_quantity_)
    scale_.reset();
  last_time_ = message.time;
  last_quantity_ = quantity;
  if (!values.empty())
    scale_.follow(*std::max_element(values.begin(), values.end()));
  full_scale_ = full_scale > 0.0 ? full_scale : scale_.full();
  visualization::HeatPatch patch = heat_map_->patch(message.triangles, values);
  for (std::size_t i = 0; i + 2 < patch.corners.size(); i += 3)
  {
    const Eigen::Vector3d normal =
        (patch.corners[i + 1] - patch.corners[i]).cross(patch.corners[i + 2] - patch.corners[i]).normalized();
    for (std::size_t k = i; k < i + 3; ++k)
    {
      heat_.triangles.push_back(static_cast<std::uint32_t>(heat_.positions.size()));
      heat_.positions.push_back(patch.corners[k].cast<float>());
      heat_.normals.push_back(normal.cast<float>());
      heat_.colours.push_back(visualization::heatColour(patch.values[k], full_scale_));
    }
  }
  heat_rest_ = std::move(patch.corners);
  if (!map_.resting())
    moveHeat();
  return {};
}

bool VesselDrawing::move(const motion::MotionMap& map)
{
  if (map.resting() && map_.resting())
    return false;
  // The identity keeps the vertices of the motion before, which return to rest.
  const bool is_other_fade = !map.resting() && (moving_.empty() || !isSame(map.frame().fade, map_.frame().fade));
  if (is_other_fade && !map_.resting())
  {
    map_ = nodes::restingMap();
    moveWall();
  }
  map_ = map;
  if (is_other_fade)
    findMoving();
  moveWall();
  moveHeat();
  return true;
}

void VesselDrawing::findMoving()
{
  moving_.clear();
  moving_rest_.clear();
  for (std::size_t i = 0; i < rest_.size(); ++i)
    if (!map_.outside(rest_[i]))
    {
      moving_.push_back(static_cast<std::uint32_t>(i));
      moving_rest_.push_back(rest_[i]);
    }
}

void VesselDrawing::moveWall()
{
  map_.positions(moving_rest_, moved_);
  for (std::size_t k = 0; k < moving_.size(); ++k)
    wall_.positions[moving_[k]] = moved_[k].cast<float>();
}

void VesselDrawing::moveHeat()
{
  map_.positions(heat_rest_, moved_);
  for (std::size_t k = 0; k < heat_rest_.size(); ++k)
    heat_.positions[k] = moved_[k].cast<float>();
}

void VesselDrawing::cutAway(const Eigen::Vector3d& point, double radius, float opacity)
{
  visualization::cutAway(point, radius, opacity, wall_);
}

}  // namespace endovascular_sim::rviz_plugin
