#include "vessel/centreline/medial_spheres.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <numeric>
#include <thread>
#include <tuple>

#include <Eigen/Geometry>

#include "geometry/kd_tree.h"
#include "geometry/mesh_topology.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr int kDeepestSplit = 9;
/** Longest edge of a sampled triangle, in local radii of the lumen; longer triangles are bisected. */
constexpr double kSampleSpacing = 0.7;
/** Largest number of sampled triangles; larger meshes are sampled with a stride. */
constexpr std::size_t kMaxTriangles = 40000;
/** Minimum gain of distance per step length away from the nearest wall. The gain is smaller at the ridge. */
constexpr double kMinGain = 0.3;
/** Cosine of the smallest separation angle of a medial sphere in a lumen (110°). Spheres in grooves between facets and
 *  in the rims of flat caps have smaller angles. */
constexpr double kWidestGroove = -0.34;
/** Smallest radius of a lumen [m]. It admits no instrument: a 0.014" wire has a radius of 0.18 mm. */
constexpr double kNarrowestLumen = 0.2e-3;
constexpr std::size_t kSamplesPerBlock = 256;
constexpr std::size_t kBlocksPerThread = 8;  ///< least number of blocks that a thread is started for
constexpr std::size_t kMaxThreads = 8;
/** Bisection depth of a triangle without any medial sphere. */
constexpr int kDeepestBlindSplit = 3;

/** Medial sphere opposite to a point of the wall: ascent of the distance to the wall, from the middle of the chord
 *  across the lumen to the ridge.
 *  @return a sphere of radius 0 in a groove or a too narrow lumen */
MedialSphere ascendToRidge(const Eigen::Vector3d& p, const Eigen::Vector3d& inward,
                           const geometry::MeshDistance& distance)
{
  // Offset of the ray's origin, so that the ray does not hit its own triangle.
  const double offset = 1e-9;
  const double across = distance.rayHit(p + offset * inward, inward);
  if (!(across > 0.0))
    return {};
  Eigen::Vector3d centre = p + 0.5 * across * inward;
  geometry::ClosestPoint wall = distance.closest(centre);
  Eigen::Vector3d rejected = centre;
  for (double step = 0.3 * wall.distance; step > 0.03 * wall.distance && wall.distance > 0.0;)
  {
    const Eigen::Vector3d trial = centre + step * (centre - wall.point) / wall.distance;
    if (distance.isNearer(trial, wall.distance + kMinGain * step))
    {
      rejected = trial;
      step *= 0.5;
      continue;
    }
    centre = trial;
    wall = distance.closest(trial);
  }
  const Eigen::Vector3d other_wall = distance.closest(rejected).point;
  const Eigen::Vector3d to_wall = (wall.point - centre).normalized();
  const Eigen::Vector3d to_other = (other_wall - centre).normalized();
  const bool in_groove = to_wall.dot(to_other) > kWidestGroove || wall.distance < kNarrowestLumen;
  return in_groove ? MedialSphere{} : MedialSphere{centre, wall.distance};
}

/** Triangle of the mesh, or a part of it. */
struct Facet
{
  Eigen::Vector3d a, b, c;
  int depth;
  double radius;  // of the last sphere found on a containing part; 0 if there is none
};

void sampleFacet(const Facet& whole, const geometry::MeshDistance& distance, std::vector<MedialSphere>& spheres)
{
  const Eigen::Vector3d normal = (whole.b - whole.a).cross(whole.c - whole.a);
  if (normal.norm() == 0.0)
    return;
  const Eigen::Vector3d inward = -normal.normalized();
  std::vector<Facet> open{whole};
  while (!open.empty())
  {
    const Facet f = open.back();
    open.pop_back();
    const MedialSphere sphere = ascendToRidge((f.a + f.b + f.c) / 3.0, inward, distance);
    if (sphere.radius > 0.0)
      spheres.push_back(sphere);
    const double ab = (f.b - f.a).norm();
    const double bc = (f.c - f.b).norm();
    const double ca = (f.a - f.c).norm();
    const double longest = std::max({ab, bc, ca});
    const double radius = sphere.radius > 0.0 ? sphere.radius : f.radius;
    const int deepest = radius > 0.0 ? kDeepestSplit : kDeepestBlindSplit;
    if (f.depth >= deepest || longest <= kSampleSpacing * radius)
      continue;
    // Longest-edge bisection.
    Facet g = f;
    if (bc == longest)
      g = {f.b, f.c, f.a, f.depth, 0.0};
    else if (ca == longest)
      g = {f.c, f.a, f.b, f.depth, 0.0};
    const Eigen::Vector3d middle = 0.5 * (g.a + g.b);
    open.push_back({g.a, middle, g.c, f.depth + 1, radius});
    open.push_back({middle, g.b, g.c, f.depth + 1, radius});
  }
}

std::vector<Eigen::Vector3d> centresOf(const std::vector<MedialSphere>& spheres)
{
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(spheres.size());
  for (const MedialSphere& sphere : spheres)
    centres.push_back(sphere.centre);
  return centres;
}

}  // namespace

std::vector<MedialSphere> medialSpheres(const geometry::TriangleMesh& mesh, const geometry::MeshDistance& distance,
                                        const ProgressReport& progress)
{
  const std::size_t stride = mesh.triangles.size() / kMaxTriangles + 1;
  const std::size_t samples = (mesh.triangles.size() + stride - 1) / stride;
  std::vector<std::vector<MedialSphere>> blocks((samples + kSamplesPerBlock - 1) / kSamplesPerBlock);
  std::atomic<std::size_t> next{0};
  const auto work = [&](const ProgressReport& report)
  {
    for (std::size_t block = next++; block < blocks.size(); block = next++)
    {
      reportProgress(report, "centreline", static_cast<double>(block) / static_cast<double>(blocks.size()));
      const std::size_t end = std::min(samples, (block + 1) * kSamplesPerBlock);
      for (std::size_t sample = block * kSamplesPerBlock; sample < end; ++sample)
      {
        const Eigen::Vector3i& t = mesh.triangles[sample * stride];
        const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
        sampleFacet({at(0), at(1), at(2), 0, 0.0}, distance, blocks[block]);
      }
    }
  };
  std::vector<std::future<void>> helpers;
  const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t k = 1; k < std::min({processors, blocks.size() / kBlocksPerThread, kMaxThreads}); ++k)
    helpers.push_back(std::async(std::launch::async, work, ProgressReport()));
  work(progress);
  for (std::future<void>& helper : helpers)
    helper.get();
  std::vector<MedialSphere> spheres;
  for (const std::vector<MedialSphere>& block : blocks)
    spheres.insert(spheres.end(), block.begin(), block.end());
  return spheres;
}

std::vector<MedialSphere> thinSpheres(std::vector<MedialSphere> spheres, double cover)
{
  std::stable_sort(spheres.begin(), spheres.end(),
                   [](const MedialSphere& a, const MedialSphere& b) { return a.radius > b.radius; });
  const std::vector<Eigen::Vector3d> centres = centresOf(spheres);
  const geometry::KdTree tree(centres);
  std::vector<bool> dropped(spheres.size(), false);
  std::vector<MedialSphere> kept;
  for (std::size_t i = 0; i < spheres.size(); ++i)
  {
    if (dropped[i])
      continue;
    kept.push_back(spheres[i]);
    tree.within(spheres[i].centre, spheres[i].radius,
                [&](int index)
                {
                  const auto j = static_cast<std::size_t>(index);
                  const bool much_smaller = spheres[j].radius < cover * spheres[i].radius;
                  if (much_smaller || (centres[j] - centres[i]).norm() <= cover * spheres[i].radius)
                    dropped[j] = true;
                });
  }
  return kept;
}

std::vector<std::vector<int>> overlappingSpheres(const std::vector<MedialSphere>& spheres)
{
  const std::vector<Eigen::Vector3d> centres = centresOf(spheres);
  const geometry::KdTree tree(centres);
  std::vector<std::vector<int>> neighbours(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i)
    tree.within(spheres[i].centre, 2.0 * spheres[i].radius,
                [&](int index)
                {
                  const auto j = static_cast<std::size_t>(index);
                  // Every pair is processed once, from its larger (or earlier) sphere.
                  const bool is_first =
                      spheres[j].radius < spheres[i].radius || (spheres[j].radius == spheres[i].radius && j > i);
                  if (!is_first || (centres[i] - centres[j]).norm() >= spheres[i].radius + spheres[j].radius)
                    return;
                  neighbours[i].push_back(index);
                  neighbours[j].push_back(static_cast<int>(i));
                });
  for (std::vector<int>& list : neighbours)
    std::sort(list.begin(), list.end());
  return neighbours;
}

void connectComponents(const std::vector<MedialSphere>& spheres, const geometry::MeshDistance& distance,
                       std::vector<std::vector<int>>& neighbours)
{
  geometry::DisjointSets components(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (int j : neighbours[i])
      components.join(static_cast<int>(i), j);
  const std::vector<Eigen::Vector3d> centres = centresOf(spheres);
  const geometry::KdTree tree(centres);
  std::vector<std::tuple<double, int, int>> gaps;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    tree.within(centres[i], 3.0 * spheres[i].radius,
                [&](int j)
                {
                  const MedialSphere& other = spheres[static_cast<std::size_t>(j)];
                  const double gap = (other.centre - centres[i]).norm() - other.radius - spheres[i].radius;
                  if (other.radius <= spheres[i].radius && gap <= spheres[i].radius &&
                      components.find(j) != components.find(static_cast<int>(i)))
                    gaps.emplace_back(gap, static_cast<int>(i), j);
                });
  std::sort(gaps.begin(), gaps.end());
  for (const auto& [gap, a, b] : gaps)
  {
    const auto i = static_cast<std::size_t>(a);
    const auto j = static_cast<std::size_t>(b);
    const Eigen::Vector3d offset = centres[j] - centres[i];
    const double hit =
        components.find(a) == components.find(b) ? 0.0 : distance.rayHit(centres[i], offset.normalized());
    if (hit >= 0.0 && hit <= offset.norm())
      continue;
    components.join(a, b);
    neighbours[i].insert(std::lower_bound(neighbours[i].begin(), neighbours[i].end(), b), b);
    neighbours[j].insert(std::lower_bound(neighbours[j].begin(), neighbours[j].end(), a), a);
  }
}

}  // namespace endovascular_sim::vessel
