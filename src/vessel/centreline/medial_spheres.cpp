#include "vessel/centreline/medial_spheres.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <Eigen/Geometry>

#include "geometry/kd_tree.h"
#include "geometry/mesh_topology.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr int kDeepestSplit = 9;
/** A triangle longer than this many local radii is sampled in parts. */
constexpr double kSampleSpacing = 0.7;
/** More triangles than this are sampled by every second, third, … one. */
constexpr std::size_t kMostTriangles = 40000;
/** A step away from the nearest wall must gain this fraction of its length: less is the ridge. */
constexpr double kLeastGain = 0.3;
/** Cosine of the smallest angle at which a ball in the middle of a lumen sees the walls that hold it (110°). Smaller
 * ones fill grooves between facets and the rims of flat caps. */
constexpr double kWidestGroove = -0.34;
/** A lumen narrower than this admits no instrument: 0.014" wires have a radius of 0.18 mm [m]. */
constexpr double kNarrowestLumen = 0.2e-3;
/** A triangle whose samples all lie in grooves is not cut more often than this. */
constexpr int kDeepestBlindSplit = 3;

/** From half-way across the lumen away from the nearest wall, up to the ridge of the distance.
 *  @return a ball of radius 0 where that is in a groove or too narrow */
MedialSphere climb(const Eigen::Vector3d& p, const Eigen::Vector3d& inward, const geometry::MeshDistance& distance)
{
  // Started a hair inside, so that the ray does not hit its own triangle.
  const double hair = 1e-9;
  const double across = distance.rayHit(p + hair * inward, inward);
  if (!(across > 0.0))
    return {};
  Eigen::Vector3d centre = p + 0.5 * across * inward;
  geometry::ClosestPoint wall = distance.closest(centre);
  Eigen::Vector3d other_wall = wall.point;
  for (double step = 0.3 * wall.distance; step > 0.03 * wall.distance && wall.distance > 0.0;)
  {
    const Eigen::Vector3d trial = centre + step * (centre - wall.point) / wall.distance;
    const geometry::ClosestPoint trial_wall = distance.closest(trial);
    if (trial_wall.distance < wall.distance + kLeastGain * step)
    {
      other_wall = trial_wall.point;
      step *= 0.5;
      continue;
    }
    centre = trial;
    wall = trial_wall;
  }
  const Eigen::Vector3d to_wall = (wall.point - centre).normalized();
  const Eigen::Vector3d to_other = (other_wall - centre).normalized();
  const bool in_groove = to_wall.dot(to_other) > kWidestGroove || wall.distance < kNarrowestLumen;
  return in_groove ? MedialSphere{} : MedialSphere{centre, wall.distance};
}

/** A triangle or a part of one. */
struct Facet
{
  Eigen::Vector3d a, b, c;
  int depth;
  double radius;  // of the last ball found on a larger part, 0 before the first
};

void sampleFacet(const Facet& whole, const geometry::MeshDistance& distance, std::vector<MedialSphere>& balls)
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
    const MedialSphere ball = climb((f.a + f.b + f.c) / 3.0, inward, distance);
    if (ball.radius > 0.0)
      balls.push_back(ball);
    const double ab = (f.b - f.a).norm();
    const double bc = (f.c - f.b).norm();
    const double ca = (f.a - f.c).norm();
    const double longest = std::max({ab, bc, ca});
    const double radius = ball.radius > 0.0 ? ball.radius : f.radius;
    const int deepest = radius > 0.0 ? kDeepestSplit : kDeepestBlindSplit;
    if (f.depth >= deepest || longest <= kSampleSpacing * radius)
      continue;
    // Across the longest side.
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

std::vector<Eigen::Vector3d> centresOf(const std::vector<MedialSphere>& balls)
{
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(balls.size());
  for (const MedialSphere& ball : balls)
    centres.push_back(ball.centre);
  return centres;
}

}  // namespace

std::vector<MedialSphere> medialBalls(const geometry::TriangleMesh& mesh, const geometry::MeshDistance& distance)
{
  std::vector<MedialSphere> balls;
  const std::size_t stride = mesh.triangles.size() / kMostTriangles + 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += stride)
  {
    const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])]; };
    sampleFacet({at(0), at(1), at(2), 0, 0.0}, distance, balls);
  }
  return balls;
}

std::vector<MedialSphere> thinBalls(std::vector<MedialSphere> balls, double cover)
{
  std::stable_sort(balls.begin(), balls.end(),
                   [](const MedialSphere& a, const MedialSphere& b) { return a.radius > b.radius; });
  const std::vector<Eigen::Vector3d> centres = centresOf(balls);
  const geometry::PointTree tree(centres);
  std::vector<bool> dropped(balls.size(), false);
  std::vector<MedialSphere> kept;
  for (std::size_t i = 0; i < balls.size(); ++i)
  {
    if (dropped[i])
      continue;
    kept.push_back(balls[i]);
    tree.within(balls[i].centre, balls[i].radius,
                [&](int index)
                {
                  const auto j = static_cast<std::size_t>(index);
                  const bool much_smaller = balls[j].radius < cover * balls[i].radius;
                  if (much_smaller || (centres[j] - centres[i]).norm() <= cover * balls[i].radius)
                    dropped[j] = true;
                });
  }
  return kept;
}

std::vector<std::vector<int>> overlappingBalls(const std::vector<MedialSphere>& balls)
{
  const std::vector<Eigen::Vector3d> centres = centresOf(balls);
  const geometry::PointTree tree(centres);
  std::vector<std::vector<int>> neighbours(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i)
    tree.within(balls[i].centre, 2.0 * balls[i].radius,
                [&](int index)
                {
                  const auto j = static_cast<std::size_t>(index);
                  // Found from the larger one; of equals from the earlier one.
                  const bool mine = balls[j].radius < balls[i].radius || (balls[j].radius == balls[i].radius && j > i);
                  if (!mine || (centres[i] - centres[j]).norm() >= balls[i].radius + balls[j].radius)
                    return;
                  neighbours[i].push_back(index);
                  neighbours[j].push_back(static_cast<int>(i));
                });
  for (std::vector<int>& list : neighbours)
    std::sort(list.begin(), list.end());
  return neighbours;
}

void joinParts(const std::vector<MedialSphere>& balls, const geometry::MeshDistance& distance,
               std::vector<std::vector<int>>& neighbours)
{
  geometry::DisjointSets parts(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (int j : neighbours[i])
      parts.join(static_cast<int>(i), j);
  const std::vector<Eigen::Vector3d> centres = centresOf(balls);
  const geometry::PointTree tree(centres);
  std::vector<std::tuple<double, int, int>> gaps;
  for (std::size_t i = 0; i < balls.size(); ++i)
    tree.within(centres[i], 3.0 * balls[i].radius,
                [&](int j)
                {
                  const MedialSphere& other = balls[static_cast<std::size_t>(j)];
                  const double gap = (other.centre - centres[i]).norm() - other.radius - balls[i].radius;
                  if (other.radius <= balls[i].radius && gap <= balls[i].radius &&
                      parts.find(j) != parts.find(static_cast<int>(i)))
                    gaps.emplace_back(gap, static_cast<int>(i), j);
                });
  std::sort(gaps.begin(), gaps.end());
  for (const auto& [gap, a, b] : gaps)
  {
    const auto i = static_cast<std::size_t>(a);
    const auto j = static_cast<std::size_t>(b);
    const Eigen::Vector3d way = centres[j] - centres[i];
    const double hit = parts.find(a) == parts.find(b) ? 0.0 : distance.rayHit(centres[i], way.normalized());
    if (hit >= 0.0 && hit <= way.norm())
      continue;
    parts.join(a, b);
    neighbours[i].insert(std::lower_bound(neighbours[i].begin(), neighbours[i].end(), b), b);
    neighbours[j].insert(std::lower_bound(neighbours[j].begin(), neighbours[j].end(), a), a);
  }
}

}  // namespace endovascular_sim::vessel
