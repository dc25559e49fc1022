#include "nodes/support/vessel_conversions.h"

#include "common/error.h"
#include "nodes/support/contact_conversions.h"
#include "nodes/support/names.h"

namespace endovascular_sim::nodes
{

void toMessage(const vessel::TriangleMesh& mesh, VesselMesh& message)
{
  message.mesh.vertices.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    message.mesh.vertices[v] = toPoint(mesh.vertices[v]);
  message.mesh.triangles.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int corner = 0; corner < 3; ++corner)
      message.mesh.triangles[t].vertex_indices[corner] = static_cast<std::uint32_t>(mesh.triangles[t][corner]);
}

vessel::TriangleMesh fromMessage(const VesselMesh& message)
{
  vessel::TriangleMesh mesh;
  for (const geometry_msgs::Point& vertex : message.mesh.vertices)
    mesh.vertices.push_back(fromMessage(vertex));
  for (const shape_msgs::MeshTriangle& triangle : message.mesh.triangles)
  {
    for (std::uint32_t index : triangle.vertex_indices)
      if (index >= mesh.vertices.size())
        throw InputError(names::kVesselMesh, message.source, "a triangle names a vertex that is not there");
    mesh.triangles.emplace_back(static_cast<int>(triangle.vertex_indices[0]),
                                static_cast<int>(triangle.vertex_indices[1]),
                                static_cast<int>(triangle.vertex_indices[2]));
  }
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

vessel::CentrelineTree fromMessage(const VesselCentreline& message)
{
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

}  // namespace endovascular_sim::nodes
