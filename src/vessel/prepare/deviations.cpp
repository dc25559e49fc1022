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

/** Samples of the surfaces stand this many voxels apart. */
constexpr double kSampleSpacing = 2.0;
/** A wall deeper than this inside the united input, or farther outside of a hollow, is not the lumen's, in voxels: more
 *  than the grid's error, which rounds a right-angled crease by half a voxel's diagonal. */
constexpr double kBuried = 0.75;
/** Winding numbers look at every triangle: no more than this many points are asked for. */
constexpr int kMostWindings = 3000;
/** How far beside a wall its two sides are looked at, in voxels. */
constexpr double kBeside = 0.05;
/** Walls face each other when their normals are this close to parallel: cosine. */
constexpr double kFacing = 0.8;

/** The pieces of a soup, for asking whether a point lies in any of them. */
class Pieces
{
public:
  explicit Pieces(const geometry::TriangleMesh& soup) : pieces_(separatePieces(soup))
  {
    for (geometry::TriangleMesh& piece : pieces_)
      alignFaces(piece);
  }

  bool contain(const Eigen::Vector3d& p) const
  {
    return std::any_of(pieces_.begin(), pieces_.end(),
                       [&p](const geometry::TriangleMesh& piece)
                       { return std::abs(geometry::windingNumber(piece, p)) > 0.5; });
  }

private:
  std::vector<geometry::TriangleMesh> pieces_;
};

/** Distances of the input's outer wall from the result, and their samples. */
void fromInput(const InputSurfaces& input, const geometry::TriangleMesh& result, PrepareReport& report)
{
  const geometry::SidedMesh united(input.united);
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

  // The far ones may be walls buried by less than that, beside a seam of two pieces. Found out from the farthest on.
  const Pieces pieces(input.soup);
  std::vector<std::size_t> order(outer.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b)
            { return distances[a] > distances[b] || (distances[a] == distances[b] && a < b); });
  const double beside = kBeside * input.voxel;
  std::vector<bool> buried(outer.size(), false);
  for (std::size_t k = 0; k < std::min<std::size_t>(order.size(), kMostWindings); ++k)
  {
    const geometry::SurfaceSample& sample = outer[order[k]];
    if (!pieces.contain(sample.point + beside * sample.normal) ||
        !pieces.contain(sample.point - beside * sample.normal))
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

void fromResult(const InputSurfaces& input, const geometry::TriangleMesh& result, PrepareReport& report)
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

/** A narrow space seen from one of its walls. */
struct Look
{
  Eigen::Vector3d middle;
  double width;
};

/** Where the ray to one side of a wall meets another wall that faces it. */
bool lookAcross(const geometry::SurfaceSample& sample, const Eigen::Vector3d& direction,
                const geometry::MeshDistance& soup, double widest, const geometry::TriangleMesh& mesh, Look& look)
{
  const double hair = 1e-7;
  const double hit = soup.rayHit(sample.point + hair * direction, direction);
  if (!(hit > 0.0) || hit > widest)
    return false;
  const geometry::ClosestPoint other = soup.closest(sample.point + (hit + hair) * direction);
  const Eigen::Vector3i& t = mesh.triangles[static_cast<std::size_t>(other.triangle)];
  const auto at = [&](int k) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0));
  if (std::abs(normal.dot(direction)) < kFacing * normal.norm())
    return false;
  look = {sample.point + (0.5 * hit + hair) * direction, hit};
  return true;
}

}  // namespace

void measureDeviations(const InputSurfaces& input, const geometry::TriangleMesh& result, PrepareReport& report)
{
  fromInput(input, result, report);
  fromResult(input, result, report);
}

NarrowGaps measureGaps(const InputSurfaces& input, const geometry::TriangleMesh& result)
{
  const geometry::MeshDistance soup(input.soup);
  std::vector<Look> looks;
  for (const geometry::SurfaceSample& sample :
       geometry::sampleSurface(input.soup, kSampleSpacing * input.voxel, 0, input.own_triangles))
    for (double side : {1.0, -1.0})
    {
      Look look;
      if (lookAcross(sample, side * sample.normal, soup, 2.0 * input.voxel, input.soup, look))
        looks.push_back(look);
    }
  const Pieces pieces(input.soup);
  const geometry::SidedMesh wall(result);
  NarrowGaps gaps;
  const std::size_t stride = looks.size() / kMostWindings + 1;
  for (std::size_t k = 0; k < looks.size(); k += stride)
  {
    if (pieces.contain(looks[k].middle))
      continue;
    const bool kept = wall.at(looks[k].middle) > 0.0;
    ++(kept ? gaps.kept : gaps.closed);
    if (kept && (gaps.narrowest_kept == 0.0 || looks[k].width < gaps.narrowest_kept))
      gaps.narrowest_kept = looks[k].width;
    if (!kept && looks[k].width > gaps.widest_closed)
    {
      gaps.widest_closed = looks[k].width;
      gaps.closed_place = looks[k].middle;
    }
  }
  return gaps;
}

}  // namespace endovascular_sim::vessel
