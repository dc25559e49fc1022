#include "vessel/repair/lumen_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/text/format.h"
#include "vessel/repair/mesh_size.h"
#include "vessel/repair/wall_probes.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kLeastShare = 0.15;      // of the area; a wall as thick as the radius of its lumen has a third
constexpr double kLeastWidth = 1.5;       // of the enclosed lumen, in thicknesses
constexpr double kLeastExtent = 1.0;      // of the sheet along itself, in thicknesses; 0.5 in a round lumen
constexpr double kEnclosed = 0.7;         // share of directions that end on the wall
constexpr double kEnclosedSphere = 0.96;  // the same for a surface without handles: a wall with one opening, no C
constexpr int kTangents = 8;
constexpr int kDirections = 64;

/** True if the solid at a probe is a sheet: along its middle, all rays are long. */
bool isSheet(const WallProbe& probe, const geometry::MeshDistance& distance)
{
  const Eigen::Vector3d middle = probe.point + 0.5 * probe.across * probe.inward;
  const Eigen::Vector3d u = probe.inward.unitOrthogonal();
  const Eigen::Vector3d v = probe.inward.cross(u);
  for (int k = 0; k < kTangents; ++k)
  {
    const double angle = 2.0 * M_PI * k / kTangents;
    const double hit = distance.rayHit(middle, std::cos(angle) * u + std::sin(angle) * v);
    if (hit >= 0.0 && hit < kLeastExtent * probe.across)
      return false;
  }
  return true;
}

/** Share of the directions from a point that end on the wall; the directions are a Fibonacci lattice. */
double enclosure(const Eigen::Vector3d& point, const geometry::MeshDistance& distance)
{
  int hits = 0;
  for (int k = 0; k < kDirections; ++k)
  {
    const double z = 1.0 - (2.0 * k + 1.0) / kDirections;
    const double angle = M_PI * (3.0 - std::sqrt(5.0)) * k;
    const double r = std::sqrt(1.0 - z * z);
    hits += distance.rayHit(point, {r * std::cos(angle), r * std::sin(angle), z}) >= 0.0 ? 1 : 0;
  }
  return static_cast<double>(hits) / kDirections;
}

double median(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

ThickWall thickWallOf(const std::vector<WallProbe>& probes, const geometry::MeshDistance& distance, int genus)
{
  const double enclosed = genus > 0 ? kEnclosed : kEnclosedSphere;
  std::vector<double> thicknesses;
  std::vector<double> widths;
  for (const WallProbe& probe : probes)
  {
    if (probe.across <= 0.0 || probe.outside < kLeastWidth * probe.across || !isSheet(probe, distance) ||
        enclosure(probe.point - 0.5 * probe.outside * probe.inward, distance) < enclosed)
      continue;
    thicknesses.push_back(probe.across);
    widths.push_back(probe.outside);
  }
  ThickWall wall;
  if (thicknesses.empty())
    return wall;
  wall.share = static_cast<double>(thicknesses.size()) / static_cast<double>(probes.size());
  wall.thickness = median(thicknesses);
  wall.width = median(widths);
  return wall;
}

}  // namespace

bool ThickWall::found() const
{
  return share >= kLeastShare;
}

std::string ThickWall::text() const
{
  return formatted(
      "the surface is a wall %.2g mm thick around a lumen %.2g mm wide, so that instruments would run inside the "
      "wall; make its inner side the vessel: vessel_prepare --hollow --open all, with a --plug at each opening "
      "(docs/VESSELS.md, \"Thick walls\")",
      1e3 * thickness, 1e3 * width);
}

ThickWall findThickWall(const geometry::TriangleMesh& mesh, const MeshReport& report)
{
  const geometry::MeshDistance distance(mesh);
  return thickWallOf(probeWall(mesh, distance), distance, report.genus);
}

void requireLumen(const geometry::TriangleMesh& mesh, double unit, const std::string& source)
{
  const geometry::MeshDistance distance(mesh);
  const std::vector<WallProbe> probes = probeWall(mesh, distance);
  const MeshReport report = checkMesh(mesh);
  if (const ThickWall wall = thickWallOf(probes, distance, report.genus); wall.found())
    throw InputError(source, "", wall.text());
  requirePlausibleWidth(lumenWidth(probes), report, unit, source);
}

}  // namespace endovascular_sim::vessel
