#include "vessel/prepare/deviations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "geometry/mesh_distance.h"
#include "geometry/vertex_normals.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Spacing of the surface samples, in voxels. */
constexpr double kSampleSpacing = 2.0;
/** Depth below the union's surface, in voxels, beyond which a wall of the input is not the wall of the lumen. It
 *  exceeds the error of the grid, which rounds a right-angled crease by half a voxel diagonal. */
constexpr double kBuried = 0.75;
/** Largest number of winding number queries; each costs a pass over all triangles. */
constexpr int kMaxWindingQueries = 3000;
/** Offset from a wall of the queries on its two sides, in voxels. */
constexpr double kSideOffset = 0.05;
/** Minimum absolute cosine between the normals of walls that face each other. */
constexpr double kFacing = 0.8;

/** Components of a triangle soup as solids, for point containment. */
class ComponentSolids
{
public:
  explicit ComponentSolids(const geometry::TriangleMesh& soup) : components_(splitComponents(soup))
  {
    for (geometry::TriangleMesh& component : components_)
      alignFaces(component);
  }

  /** True if any component contains the point. */
  bool contain(const Eigen::Vector3d& p) const
  {
    return std::any_of(components_.begin(), components_.end(),
                       [&p](const geometry::TriangleMesh& component)
                       { return std::abs(geometry::windingNumber(component, p)) > 0.5; });
  }

private:
  std::vector<geometry::TriangleMesh> components_;
};

/** Sample of a narrow gap between two walls. */
struct GapSample
{
  Eigen::Vector3d middle;
  double width;
};

/** Measures the gap on one side of a wall by a ray.
 *  @return false without a facing wall within @p widest */
bool measureGap(const geometry::SurfaceSample& sample, const Eigen::Vector3d& direction,
                const geometry::MeshDistance& soup, double widest, const geometry::TriangleMesh& mesh, GapSample& gap)
{
  const double offset = 1e-7;
  const double hit = soup.rayHit(sample.point + offset * direction, direction);
  if (!(hit > 0.0) || hit > widest)
    return false;
  const geometry::ClosestPoint other = soup.closest(sample.point + (hit + offset) * direction);
  const Eigen::Vector3i& t = mesh.triangles[static_cast<std::size_t>(other.triangle)];
  const auto at = [&](int k) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0));
  if (std::abs(normal.dot(direction)) < kFacing * normal.norm())
    return false;
  gap = {sample.point + (0.5 * hit + offset) * direction, hit};
  return true;
}

}  // namespace

void measureInputToResult(const InputSurfaces& input, const geometry::TriangleMesh& result, PrepareReport& report)
{
  const geometry::SignedMeshDistance united(input.united);
  const geometry::MeshDistance wall(result);
  std::vector<geometry::SurfaceSample> outer;
  std::vector<double> distances;
  for (const geometry::SurfaceSample& sample :
       geometry::sampleSurface(input.soup, kSampleSpacing * input.voxel, 0, input.own_triangles))
    if ((report.hollow ? -1.0 : 1.0) * united.at(sample.point) < -kBuried * input.voxel)
      report.inner_area += sample.area;
    else
    {
      outer.push_back(sample);
      distances.push_back(wall.closest(sample.point).distance);
    }

  // Samples with large distances may be inner walls above kBuried, near the seam of two components. They are tested by
  // winding numbers, in the order of decreasing distance.
  const ComponentSolids solids(input.soup);
  std::vector<std::size_t> order(outer.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b)
            { return distances[a] > distances[b] || (distances[a] == distances[b] && a < b); });
  const double offset = kSideOffset * input.voxel;
  std::vector<bool> buried(outer.size(), false);
  for (std::size_t k = 0; k < std::min<std::size_t>(order.size(), kMaxWindingQueries); ++k)
  {
    const geometry::SurfaceSample& sample = outer[order[k]];
    if (!solids.contain(sample.point + offset * sample.normal) ||
        !solids.contain(sample.point - offset * sample.normal))
      break;
    buried[order[k]] = true;
  }
  std::vector<geometry::SurfaceSample> kept;
  std::vector<double> kept_distances;
  for (std::size_t k = 0; k < outer.size(); ++k)
    if (buried[k])
      report.inner_area += outer[k].area;
    else
    {
      kept.push_back(outer[k]);
      kept_distances.push_back(distances[k]);
    }
  report.input_to_result = geometry::deviationOf(kept, kept_distances, report.max_distance);
}

void measureResultToInput(const InputSurfaces& input, const geometry::TriangleMesh& result, PrepareReport& report)
{
  const geometry::MeshDistance soup(input.soup);
  std::vector<geometry::SurfaceSample> own;
  std::vector<double> distances;
  for (const geometry::SurfaceSample& sample : geometry::sampleSurface(result, kSampleSpacing * input.voxel))
  {
    const geometry::ClosestPoint closest = soup.closest(sample.point);
    if (static_cast<std::size_t>(closest.triangle) >= input.own_triangles)
    {
      report.lid_area += sample.area;
      continue;
    }
    own.push_back(sample);
    distances.push_back(closest.distance);
  }
  report.result_to_input = geometry::deviationOf(own, distances, report.max_distance);
}

NarrowGaps measureGaps(const InputSurfaces& input, const geometry::TriangleMesh& result)
{
  const geometry::MeshDistance soup(input.soup);
  std::vector<GapSample> samples;
  for (const geometry::SurfaceSample& sample :
       geometry::sampleSurface(input.soup, kSampleSpacing * input.voxel, 0, input.own_triangles))
    for (double side : {1.0, -1.0})
    {
      GapSample gap;
      if (measureGap(sample, side * sample.normal, soup, 2.0 * input.voxel, input.soup, gap))
        samples.push_back(gap);
    }
  const ComponentSolids solids(input.soup);
  const geometry::SignedMeshDistance wall(result);
  NarrowGaps gaps;
  const std::size_t stride = samples.size() / kMaxWindingQueries + 1;
  for (std::size_t k = 0; k < samples.size(); k += stride)
  {
    if (solids.contain(samples[k].middle))
      continue;
    const bool kept = wall.at(samples[k].middle) > 0.0;
    ++(kept ? gaps.kept : gaps.closed);
    if (kept && (gaps.narrowest_kept == 0.0 || samples[k].width < gaps.narrowest_kept))
      gaps.narrowest_kept = samples[k].width;
    if (!kept && samples[k].width > gaps.widest_closed)
    {
      gaps.widest_closed = samples[k].width;
      gaps.closed_location = samples[k].middle;
    }
  }
  return gaps;
}

}  // namespace endovascular_sim::vessel
