#include "nodes/conversions/vessel_conversions.h"

#include <cmath>

#include "common/error.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

void toMessage(const geometry::TriangleMesh& mesh, VesselMesh& message)
{
  message.mesh.vertices.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    message.mesh.vertices[v] = toPoint(mesh.vertices[v]);
  message.mesh.triangles.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int corner = 0; corner < 3; ++corner)
      message.mesh.triangles[t].vertex_indices[corner] = static_cast<std::uint32_t>(mesh.triangles[t][corner]);
  message.content_hash = mesh.hash();
}

geometry::TriangleMesh fromMessage(const VesselMesh& message)
{
  geometry::TriangleMesh mesh;
  mesh.vertices.reserve(message.mesh.vertices.size());
  mesh.triangles.reserve(message.mesh.triangles.size());
  for (const geometry_msgs::Point& vertex : message.mesh.vertices)
  {
    requirePosition(vertex, names::kVesselMesh, "vertices");
    mesh.vertices.push_back(fromMessage(vertex));
  }
  for (const shape_msgs::MeshTriangle& triangle : message.mesh.triangles)
  {
    for (std::uint32_t index : triangle.vertex_indices)
      if (index >= mesh.vertices.size())
        throw InputError(names::kVesselMesh, message.source,
                         "triangle " + std::to_string(mesh.triangles.size()) + " has a vertex that does not exist");
    mesh.triangles.emplace_back(static_cast<int>(triangle.vertex_indices[0]),
                                static_cast<int>(triangle.vertex_indices[1]),
                                static_cast<int>(triangle.vertex_indices[2]));
  }
  if (mesh.triangles.empty())
    throw InputError(names::kVesselMesh, message.source, "must have triangles");
  if (mesh.hash() != message.content_hash)
    throw InputError(names::kVesselMesh, "content_hash", "does not match the mesh: the message is damaged");
  return mesh;
}

void toMessage(const vessel::CentrelineTree& tree, VesselCentreline& message)
{
  message.branches.clear();
  for (const vessel::CentrelineBranch& branch : tree.branches)
  {
    VesselCentrelineBranch to;
    to.name = branch.name;
    to.parent = branch.parent;
    for (const Eigen::Vector3d& point : branch.points)
      to.points.push_back(toPoint(point));
    to.radii = branch.radii;
    message.branches.push_back(to);
  }
}

void toMessage(const std::vector<vessel::PlacedLesion>& lesions, VesselCentreline& message)
{
  message.lesions.clear();
  for (const vessel::PlacedLesion& lesion : lesions)
  {
    VesselLesion to;
    to.branch = static_cast<std::uint32_t>(lesion.branch);
    to.begin = lesion.begin;
    to.middle = lesion.middle;
    to.end = lesion.end;
    to.healthy_diameter = lesion.healthy_diameter;
    to.narrowed_diameter = lesion.narrowed_diameter;
    message.lesions.push_back(to);
  }
}

std::vector<vessel::PlacedLesion> lesionsFromMessage(const VesselCentreline& message)
{
  std::vector<vessel::PlacedLesion> lesions;
  for (const VesselLesion& from : message.lesions)
  {
    if (from.branch >= message.branches.size())
      throw InputError(names::kVesselCentreline, "lesions", "a lesion is on a branch that does not exist");
    for (const double value : {from.begin, from.middle, from.end, from.healthy_diameter, from.narrowed_diameter})
      if (!(std::abs(value) <= kFarthest))
        throw InputError(names::kVesselCentreline, "lesions", "must have finite lengths and diameters");
    vessel::PlacedLesion lesion;
    lesion.branch = static_cast<int>(from.branch);
    lesion.begin = from.begin;
    lesion.middle = from.middle;
    lesion.end = from.end;
    lesion.healthy_diameter = from.healthy_diameter;
    lesion.narrowed_diameter = from.narrowed_diameter;
    lesions.push_back(lesion);
  }
  return lesions;
}

namespace
{

/** @throws InputError for a branch without a line, or whose parents form a circle */
void requireTree(const VesselCentreline& message)
{
  const auto size = static_cast<std::int64_t>(message.branches.size());
  for (const VesselCentrelineBranch& branch : message.branches)
  {
    if (branch.points.size() < 2 || branch.points.size() != branch.radii.size())
      throw InputError(names::kVesselCentreline, branch.name,
                       "must have at least two points, and one radius for each of them");
    for (const geometry_msgs::Point& point : branch.points)
      requirePosition(point, names::kVesselCentreline, branch.name);
    for (const double radius : branch.radii)
      requireRadius(radius, names::kVesselCentreline, branch.name);
    std::int64_t parent = branch.parent;
    for (std::int64_t k = 0; k <= size && parent >= 0; ++k)
    {
      if (parent >= size || k == size)
        throw InputError(names::kVesselCentreline, branch.name,
                         "must have a parent among the branches, none of which is its own ancestor");
      parent = message.branches[static_cast<std::size_t>(parent)].parent;
    }
  }
}

}  // namespace

vessel::CentrelineTree fromMessage(const VesselCentreline& message)
{
  requireTree(message);
  vessel::CentrelineTree tree;
  for (const VesselCentrelineBranch& from : message.branches)
  {
    vessel::CentrelineBranch branch;
    branch.name = from.name;
    branch.parent = from.parent;
    for (const geometry_msgs::Point& point : from.points)
      branch.points.push_back(fromMessage(point));
    branch.radii = from.radii;
    tree.branches.push_back(branch);
  }
  return tree;
}

namespace
{

void toMessage(const intervention::RoundBody& body, std::vector<geometry_msgs::Point>& axis,
               std::vector<double>& radius)
{
  axis.clear();
  for (const Eigen::Vector3d& point : body.axis)
    axis.push_back(toPoint(point));
  radius = body.radii;
}

intervention::RoundBody bodyFromMessage(const std::vector<geometry_msgs::Point>& axis,
                                        const std::vector<double>& radius)
{
  if (axis.size() != radius.size() || axis.size() == 1)
    throw InputError(names::kBalloonLoad, "axis, radius", "must have the same length, other than one point");
  return roundBody(axis, radius, names::kBalloonLoad);
}

}  // namespace

void toMessage(const intervention::BalloonLoad& load, BalloonLoad& message)
{
  message.pressure = load.pressure;
  toMessage(load.balloon, message.axis, message.radius);
  toMessage(load.sleeve.value_or(intervention::RoundBody()), message.stent_axis, message.stent_radius);
}

intervention::BalloonLoad loadFromMessage(const BalloonLoad& message)
{
  intervention::BalloonLoad load;
  load.pressure = message.pressure;
  if (!std::isfinite(load.pressure))
    throw InputError(names::kBalloonLoad, "pressure", "must be finite");
  load.balloon = bodyFromMessage(message.axis, message.radius);
  if (!message.stent_axis.empty())
    load.sleeve = bodyFromMessage(message.stent_axis, message.stent_radius);
  return load;
}

void toMessage(const intervention::WallDisplacement& displacement, WallDisplacement& message)
{
  message.index.assign(displacement.indices.begin(), displacement.indices.end());
  message.position.clear();
  for (const Eigen::Vector3d& position : displacement.positions)
    message.position.push_back(toPoint(position));
}

intervention::WallDisplacement fromMessage(const WallDisplacement& message, std::size_t vertices)
{
  if (message.index.size() != message.position.size())
    throw InputError(names::kWallDisplacement, "index, position", "must have the same length");
  for (const std::uint32_t index : message.index)
    if (index >= vertices)
      throw InputError(names::kWallDisplacement, "index",
                       "vertex " + std::to_string(index) + " does not exist: the mesh has " + std::to_string(vertices));
  intervention::WallDisplacement displacement;
  displacement.indices.assign(message.index.begin(), message.index.end());
  for (const geometry_msgs::Point& position : message.position)
  {
    requirePosition(position, names::kWallDisplacement, "position");
    displacement.positions.push_back(fromMessage(position));
  }
  return displacement;
}

}  // namespace endovascular_sim::nodes
