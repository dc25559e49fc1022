#include "fluoroscopy/projection/vessel_projection.h"

#include "fluoroscopy/projection/signed_depth.h"

namespace endovascular_sim::fluoroscopy
{

void requireVesselInFrontOfSource(const XRayGeometry& geometry, const geometry::TriangleMesh& mesh)
{
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    projectCorner(geometry, vertex);
}

std::vector<double> vesselPathLength(const XRayGeometry& geometry, const geometry::TriangleMesh& mesh)
{
  const int n = geometry.pixels();
  std::vector<double> sum(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0.0);
  std::vector<Corner> corners;
  corners.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    corners.push_back(projectCorner(geometry, vertex));
  for (const Eigen::Vector3i& t : mesh.triangles)
    addTriangle(corners[static_cast<std::size_t>(t[0])], corners[static_cast<std::size_t>(t[1])],
                corners[static_cast<std::size_t>(t[2])], geometry.pose().source_to_detector, n, sum);
  depthsToLengths(geometry, sum);
  return sum;
}

}  // namespace endovascular_sim::fluoroscopy
