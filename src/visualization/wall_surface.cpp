#include "visualization/wall_surface.h"

#include <algorithm>
#include <cmath>

#include "geometry/vertex_normals.h"

namespace endovascular_sim::visualization
{
namespace
{

constexpr double kLargestCoordinate = 1e3;  ///< [m]; single precision holds the square

}  // namespace

const char* problemOfMesh(const geometry::TriangleMesh& mesh)
{
  if (mesh.triangles.empty() || mesh.vertices.empty())
    return "empty";
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    if (!vertex.allFinite() || vertex.cwiseAbs().maxCoeff() > kLargestCoordinate)
      return "not finite";
  const auto vertices = static_cast<std::int64_t>(mesh.vertices.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    if (triangle.minCoeff() < 0 || triangle.maxCoeff() >= vertices)
      return "a triangle refers to a vertex that does not exist";
  return nullptr;
}

Surface wallSurface(const geometry::TriangleMesh& mesh, const TranslucentColour& colour)
{
  Surface surface;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    surface.positions.push_back(vertex.cast<float>());
  for (const Eigen::Vector3d& normal : geometry::angleWeightedNormals(mesh))
    // A vertex without a triangle, or with degenerate ones only, has no normal.
    surface.normals.push_back(normal.allFinite() ? Eigen::Vector3f(normal.cast<float>()) : Eigen::Vector3f::UnitZ());
  surface.colours.assign(surface.positions.size(), colour);
  surface.triangles.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      surface.triangles.push_back(static_cast<std::uint32_t>(triangle[k]));
  return surface;
}

void cutAway(const Eigen::Vector3d& point, double radius, float opacity, Surface& surface)
{
  const Eigen::Vector3f centre = point.cast<float>();
  const auto outer = static_cast<float>(radius);
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
  {
    float share = 1.0F;
    if (outer > 0.0F)
    {
      const float x = std::clamp(2.0F * (surface.positions[i] - centre).norm() / outer - 1.0F, 0.0F, 1.0F);
      share = x * x * (3.0F - 2.0F * x);
    }
    surface.colours[i].opacity = share * opacity;
  }
}

TranslucentColour heatColour(double value, double full_scale)
{
  // The first colour of the scale, grey, is that of an instrument without force.
  const double third = full_scale / 3.0;
  const bool is_valid = full_scale > 0.0 && std::isfinite(value);
  const double share = is_valid ? std::clamp(value / third, 0.0, 1.0) : 0.0;
  return {forceColour(std::max(value, third), full_scale), static_cast<float>(share)};
}

std::string branchLabel(const std::string& name)
{
  std::string label = name;
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

}  // namespace endovascular_sim::visualization
