#include "vessel/prepare/opening_plugs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "common/error.h"
#include "geometry/surface_samples.h"
#include "geometry/vertex_normals.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Number of trial planes of a disc; the plane with the smallest cross-section is taken. */
constexpr int kTrialPlanes = 600;
constexpr int kTrialEdges = 24;
constexpr int kRimEdges = 96;
/** Length limit of the rays that determine the outward side of a disc, in radii of the plug. */
constexpr double kSight = 6.0;
/** Range below a disc within which walls are retained, in depths. */
constexpr double kBelowDisc = 6.0;
/** Longest edge of a classified triangle, in depths; longer triangles are bisected. */
constexpr double kPartLength = 2.0;

/** Direction k of a Fibonacci sphere (golden-angle spiral) with kTrialPlanes points. */
Eigen::Vector3d fibonacciDirection(int k)
{
  const double angle = M_PI * (3.0 - std::sqrt(5.0)) * k;
  const double z = 1.0 - (2.0 * k + 1.0) / kTrialPlanes;
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

Eigen::Vector3d around(const Eigen::Vector3d& axis, int k, int count)
{
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const double angle = 2.0 * M_PI * k / count;
  return std::cos(angle) * u + std::sin(angle) * axis.cross(u);
}

/** Distances to the wall along rays in a plane, limited to the plug's radius [m]. */
std::vector<double> wallDistances(const Plug& plug, const Eigen::Vector3d& normal, const geometry::MeshDistance& walls,
                                  int count)
{
  std::vector<double> result;
  for (int k = 0; k < count; ++k)
  {
    const double hit = walls.rayHit(plug.centre, around(normal, k, count));
    result.push_back(hit < 0.0 ? plug.radius : std::min(hit, plug.radius));
  }
  return result;
}

}  // namespace

Disc fitDisc(const Plug& plug, const geometry::MeshDistance& walls, double overlap, const std::string& source)
{
  Disc disc;
  disc.centre = plug.centre;
  double smallest = 1e300;
  Eigen::Vector3d free = Eigen::Vector3d::Zero();
  for (int k = 0; k < kTrialPlanes; ++k)
  {
    const Eigen::Vector3d normal = fibonacciDirection(k);
    const double hit = walls.rayHit(plug.centre, normal);
    free += (hit < 0.0 ? kSight * plug.radius : std::min(hit, kSight * plug.radius)) * normal;
    double size = 0.0;
    for (double reach : wallDistances(plug, normal, walls, kTrialEdges))
      size += reach < plug.radius ? reach * reach : 1e3 * plug.radius * plug.radius;
    if (size >= smallest)
      continue;
    smallest = size;
    disc.out = normal;
  }
  if (free.dot(disc.out) < 0.0)
    disc.out = -disc.out;
  const std::vector<double> reach = wallDistances(plug, disc.out, walls, kRimEdges);
  disc.reach = *std::max_element(reach.begin(), reach.end());
  if (disc.reach >= plug.radius)
    throw InputError(source, "--plug",
                     "at " + formatLocation(plug.centre) + " is not enclosed by walls within its radius of " +
                         std::to_string(1e3 * plug.radius) +
                         " mm; specify a point in the lumen [m], or a larger radius");
  disc.mesh.vertices.push_back(plug.centre);
  for (int k = 0; k < kRimEdges; ++k)
  {
    disc.mesh.vertices.emplace_back(plug.centre +
                                    (reach[static_cast<std::size_t>(k)] + overlap) * around(disc.out, k, kRimEdges));
    disc.mesh.triangles.emplace_back(0, 1 + k, 1 + (k + 1) % kRimEdges);
  }
  return disc;
}

geometry::TriangleMesh innerWall(const geometry::TriangleMesh& soup, const geometry::TriangleMesh& outside,
                                 double depth, const std::vector<Disc>& discs)
{
  const geometry::SignedMeshDistance outer_wall(outside);
  const auto isBelow = [&](const Eigen::Vector3d& p, const Disc& disc)
  {
    const Eigen::Vector3d from = p - disc.centre;
    const double height = from.dot(disc.out);
    return height < 0.0 && height > -kBelowDisc * depth && (from - height * disc.out).norm() < disc.reach + depth;
  };
  const auto isInner = [&](const Eigen::Vector3d& p)
  {
    return outer_wall.at(p) < -depth ||
           std::any_of(discs.begin(), discs.end(), [&](const Disc& disc) { return isBelow(p, disc); });
  };
  geometry::TriangleMesh kept;
  for (const Eigen::Vector3i& whole : soup.triangles)
  {
    const auto corner = [&](int k) { return soup.vertices[static_cast<std::size_t>(whole[k])]; };
    for (const std::array<Eigen::Vector3d, 3>& part :
         geometry::bisectTriangle({corner(0), corner(1), corner(2)}, kPartLength * depth))
    {
      if (!isInner((part[0] + part[1] + part[2]) / 3.0))
        continue;
      const int first = static_cast<int>(kept.vertices.size());
      kept.vertices.insert(kept.vertices.end(), part.begin(), part.end());
      kept.triangles.emplace_back(first, first + 1, first + 2);
    }
  }
  return kept;
}

}  // namespace endovascular_sim::vessel
