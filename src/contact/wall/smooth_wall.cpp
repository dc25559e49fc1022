#include "contact/wall/smooth_wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/loop_subdivision.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kCreaseAngle = 0.35;      // rad: mean disagreement of the quadrics around a crease vertex
constexpr double kLeastRise = 0.4;         // of a corner's quadric along the directions of its triangle
constexpr double kLargestBend = 0.5;       // 4 |q q''| / q'² of the distance to a corner's quadric
constexpr double kLargestDeviation = 0.1;  // of the triangle's longest edge
constexpr double kWidestDihedral = 0.42;   // rad: refinement of coarser meshes
constexpr int kMostLevels = 2;
constexpr double kCreaseOfFacets = 1.2;  // rad between a triangle and the mean normal at a crease of a coarse mesh
constexpr int kParts = 4;                // of every edge, for bounds
constexpr double kFlat = 1e-6;           // rad: angle between triangles below which their edge is never sharp
constexpr double kTiltFactor = 1.25;     // of the largest sampled angle, for a bound
constexpr double kTiltSlack = 0.03;      // rad, the same
constexpr double kLeastBulge = 2.0;      // 1/m: curvature of a bulge
constexpr double kLargestTilt = 1.3;     // rad, above which the tilt is unbounded

/** Weights w_i of the corners' quadrics. They and their derivatives across an edge depend, on that edge, on its own
 * ends only. */
Eigen::Vector3d blendOf(const Eigen::Vector3d& weights)
{
  const Eigen::Vector3d squares = weights.cwiseProduct(weights);
  return squares / squares.sum();
}

/** Distance along a direction to a quadric: the root of q + q' h − bend/2 h² next to 0. @param from vector from the
 *  quadric's vertex */
double heightOver(const VertexQuadric& quadric, const Eigen::Vector3d& from, const Eigen::Vector3d& along)
{
  const Eigen::Vector3d bent = quadric.bend * from;
  const double height = quadric.normal.dot(from) - 0.5 * from.dot(bent);
  const double rise = (quadric.normal - bent).dot(along);
  const double bend = along.dot(quadric.bend * along);
  return -2.0 * height / (rise + std::sqrt(std::max(0.0, rise * rise + 2.0 * bend * height)));
}

/** Range of a quadratic function over a triangle, from its values at the corners and at the middles of the edges: that
 * of its Bézier coefficients. */
std::pair<double, double> rangeOfQuadratic(const std::array<double, 3>& corner, const std::array<double, 3>& middle)
{
  std::pair<double, double> range = std::minmax({corner[0], corner[1], corner[2]});
  for (int k = 0; k < 3; ++k)
  {
    const double control = 2.0 * middle[k] - 0.5 * (corner[k] + corner[(k + 1) % 3]);
    range = {std::min(range.first, control), std::max(range.second, control)};
  }
  return range;
}

}  // namespace

SmoothWall::SmoothWall(const Wall& wall) : wall_(wall), quadrics_(fitVertexQuadrics(wall))
{
  crease_.assign(wall.vertices.size(), 0);
  const std::vector<double> disagreement = quadricDisagreement(wall, quadrics_);
  for (std::size_t v = 0; v < crease_.size(); ++v)
    crease_[v] = disagreement[v] > kCreaseAngle ? 1 : 0;
  markCreases();
  sharp_.assign(wall.edges.size(), 0);
  for (std::size_t e = 0; e < sharp_.size(); ++e)
  {
    const WallEdge& edge = wall.edges[e];
    const bool at_crease = crease_[edge.vertices[0]] != 0 || crease_[edge.vertices[1]] != 0;
    sharp_[e] = at_crease && std::abs(edge.reflex_angle) > kFlat ? 1 : 0;
  }
  boundTilts();
}

SmoothWall::SmoothWall(const SmoothWall& other, const Wall& wall)
  : wall_(wall),
    quadrics_(other.quadrics_),
    crease_(other.crease_),
    sharp_(other.sharp_),
    deviations_(other.deviations_),
    tilts_(other.tilts_),
    deviation_(other.deviation_)
{
}

/** Adds creases until every corner that is none has a bounded distance to its quadric. A crease takes the pseudo-normal
 *  as direction, which changes the bounds of its triangles and of no other ones; the set only grows. */
void SmoothWall::markCreases()
{
  deviations_.assign(wall_.triangles.size(), 0.0);
  std::vector<char> known(crease_.size(), 0);  // creases that the quadrics contain
  for (bool first = true; first || known != crease_; first = false)
  {
    std::vector<char> is_new(crease_.size(), 0);
    for (std::size_t v = 0; v < crease_.size(); ++v)
      if (crease_[v] != known[v])
      {
        quadrics_[v] = {wall_.vertex_normals[v], Eigen::Matrix3d::Zero()};
        is_new[v] = 1;
      }
    known = crease_;
    for (std::size_t t = 0; t < deviations_.size(); ++t)
    {
      const Eigen::Vector3i& corners = wall_.triangles[t];
      if (first || is_new[corners[0]] != 0 || is_new[corners[1]] != 0 || is_new[corners[2]] != 0)
        deviations_[t] = boundOf(static_cast<int>(t));
    }
  }
  deviation_ = *std::max_element(deviations_.begin(), deviations_.end());
}

/** Bounds of a corner's distance |h| over a part of a triangle; infinite where it is unbounded. With
 * the value q of the quadric at a point, its derivative q' along the direction and half of the second derivative c, |h|
 * = 2 |q|/(q' + √(q'² − 4 c q)). Value and derivative are quadratic functions of the coordinates.
 *  @param part barycentric coordinates of the part's corners */
SmoothWall::HeightBound SmoothWall::boundAt(int triangle, int corner, const std::array<Eigen::Vector3d, 3>& part) const
{
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector3i& corners = wall_.triangles[triangle];
  const VertexQuadric& quadric = quadrics_[corners[corner]];
  const Eigen::Vector3d& origin = wall_.vertices[corners[corner]];
  const auto set = [&](const Eigen::Vector3d& weights, double& height, double& rise)
  {
    const Eigen::Vector3d from = pointOf(triangle, weights) - origin;
    height = quadric.height(from);
    rise = quadric.gradient(from).dot(direction(triangle, weights));
  };
  std::array<double, 3> height, middle_height, rise, middle_rise;
  double most = 0.0;              // of the corner's coordinate in the part
  double least_other = infinity;  // of the sum of the squares of the others
  for (int k = 0; k < 3; ++k)
  {
    set(part[k], height[k], rise[k]);
    set(0.5 * (part[k] + part[(k + 1) % 3]), middle_height[k], middle_rise[k]);
    most = std::max(most, part[k][corner]);
  }
  least_other = 0.5 * (1.0 - most) * (1.0 - most);
  const double weight = most * most / (most * most + least_other);
  const auto heights = rangeOfQuadratic(height, middle_height);
  const double least_rise = rangeOfQuadratic(rise, middle_rise).first;
  const double largest = std::max(-heights.first, heights.second);
  const double bend = 2.0 * quadric.bend.norm() * largest / (least_rise * least_rise);  // directions are at most unit
  if (!(least_rise >= kLeastRise) || !(bend <= kLargestBend))
    return {infinity, infinity};
  const double bound = 2.0 * largest / (least_rise * (1.0 + std::sqrt(1.0 - bend)));
  return {bound, weight * bound};
}

/** Bound of the displacement over a triangle, from its parts. Sets the corners whose quadric is not bounded by a share
 * of the longest edge to creases. */
double SmoothWall::boundOf(int triangle)
{
  const Eigen::Vector3i& corners = wall_.triangles[triangle];
  double longest = 0.0;
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (wall_.vertices[corners[k]] - wall_.vertices[corners[(k + 1) % 3]]).norm());
  double bound = 0.0;
  const auto add = [&](const std::array<Eigen::Vector3d, 3>& part)
  {
    double sum = 0.0;
    double largest = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      if (crease_[corners[k]] != 0)
        continue;
      const HeightBound height = boundAt(triangle, k, part);
      if (!(height.share <= kLargestDeviation * longest))
      {
        crease_[corners[k]] = 1;
        continue;
      }
      sum += height.share;
      largest = std::max(largest, height.whole);
    }
    bound = std::max(bound, std::min(sum, largest));
  };
  const auto at = [](int i, int j) -> Eigen::Vector3d { return Eigen::Vector3d(kParts - i - j, i, j) / kParts; };
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; i + j < kParts; ++j)
    {
      add({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + j + 1 < kParts)
        add({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return bound;
}

/** Samples the angles between every triangle's normal and those of its patch, of the directions of its corners, and of
 *  the patches beside it where they meet: at a bulge, the offset of a foot on the border lies between both. */
void SmoothWall::boundTilts()
{
  std::vector<double> widest(wall_.triangles.size(), 0.0);
  const auto widen = [&](int triangle, const Eigen::Vector3d& normal)
  { widest[triangle] = std::max(widest[triangle], angleBetween(normal, wall_.normals[triangle])); };
  for (int t = 0; t < static_cast<int>(widest.size()); ++t)
    for (int i = 0; i <= kParts; ++i)
      for (int j = 0; i + j <= kParts; ++j)
      {
        const Eigen::Vector3d normal = at(t, Eigen::Vector3d(kParts - i - j, i, j) / kParts).normal;
        widen(t, normal);
        const Eigen::Vector3i multiple(kParts - i - j, i, j);
        for (int k = 0; k < 3; ++k)
          if (multiple[(k + 2) % 3] == 0)
            for (int other : wall_.edges[wall_.triangle_edges[t][k]].triangles)
              widen(other, normal);
      }
  for (const WallEdge& edge : wall_.edges)
    for (int vertex : edge.vertices)
      for (int t : edge.triangles)
      {
        widen(t, quadrics_[vertex].normal);
        if (crease_[vertex] != 0)
          for (int e : wall_.vertex_edges[vertex])
            for (int other : wall_.edges[e].triangles)
              widen(t, wall_.normals[other]);
      }
  tilts_.clear();
  for (double angle : widest)
  {
    const double bound = kTiltFactor * angle + kTiltSlack;
    tilts_.push_back(bound < kLargestTilt ? std::sin(bound) : 1.0);
  }
}

/** With the displacement H along the direction and the signed distance D along the normal, the point's height over the
 *  triangle's plane is at least |D| cos − |H|, and its foot lies at most (|H| + |D|) sin beyond the border. */
bool SmoothWall::mayHaveFoot(int triangle, const Eigen::Array4d& heights, double cutoff) const
{
  const double away = deviations_[triangle];
  const double height = std::abs(heights[0]);
  if (height > cutoff + away)
    return false;
  const double sine = tilts_[triangle];
  const double farthest = sine < 1.0 ? std::min(cutoff, (height + away) / std::sqrt(1.0 - sine * sine)) : cutoff;
  return -std::min({heights[1], heights[2], heights[3]}) <= (away + farthest) * sine;
}

Eigen::Vector3d SmoothWall::pointOf(int triangle, const Eigen::Vector3d& weights) const
{
  const Eigen::Vector3i& c = wall_.triangles[triangle];
  return weights[0] * wall_.vertices[c[0]] + weights[1] * wall_.vertices[c[1]] + weights[2] * wall_.vertices[c[2]];
}

Eigen::Vector3d SmoothWall::direction(int triangle, const Eigen::Vector3d& weights) const
{
  const Eigen::Vector3i& c = wall_.triangles[triangle];
  return weights[0] * quadrics_[c[0]].normal + weights[1] * quadrics_[c[1]].normal +
         weights[2] * quadrics_[c[2]].normal;
}

/** Σ w_i h_i, the displacement along the direction. */
double SmoothWall::displacement(int triangle, const Eigen::Vector3d& blend, const Eigen::Vector3d& point,
                                const Eigen::Vector3d& direction) const
{
  const Eigen::Vector3i& c = wall_.triangles[triangle];
  double sum = 0.0;
  for (int k = 0; k < 3; ++k)
    if (crease_[c[k]] == 0 && blend[k] != 0.0)
      sum += blend[k] * heightOver(quadrics_[c[k]], point - wall_.vertices[c[k]], direction);
  return sum;
}

Eigen::Vector3d SmoothWall::positionAt(int triangle, const Eigen::Vector3d& weights) const
{
  const Eigen::Vector3d point = pointOf(triangle, weights);
  const Eigen::Vector3d along = direction(triangle, weights);
  return point + displacement(triangle, blendOf(weights), point, along) * along;
}

SmoothWall::Point SmoothWall::at(int triangle, const Eigen::Vector3d& weights) const
{
  const Eigen::Vector3i& c = wall_.triangles[triangle];
  const double squares = weights.squaredNorm();
  const Eigen::Vector3d foot = pointOf(triangle, weights);
  const Eigen::Vector3d along = direction(triangle, weights);
  Eigen::Matrix<double, 3, 2> foot_change, along_change;
  for (int k = 0; k < 2; ++k)
  {
    foot_change.col(k) = wall_.vertices[c[k + 1]] - wall_.vertices[c[0]];
    along_change.col(k) = quadrics_[c[k + 1]].normal - quadrics_[c[0]].normal;
  }
  const Eigen::RowVector2d squares_change = 2.0 * (weights.tail<2>().transpose().array() - weights[0]);
  double height = 0.0;
  Eigen::RowVector2d height_change = Eigen::RowVector2d::Zero();
  Point point;
  point.curvature.setZero();
  for (int k = 0; k < 3; ++k)
  {
    if (crease_[c[k]] != 0)
      continue;  // its height is 0
    const VertexQuadric& quadric = quadrics_[c[k]];
    const double blend = weights[k] * weights[k] / squares;
    Eigen::RowVector2d blend_change = -blend / squares * squares_change;
    if (k == 0)
      blend_change.array() -= 2.0 * weights[0] / squares;
    else
      blend_change[k - 1] += 2.0 * weights[k] / squares;
    const Eigen::Vector3d from = foot - wall_.vertices[c[k]];
    const double own = heightOver(quadric, from, along);
    const Eigen::Vector3d gradient = quadric.gradient(from + own * along);
    const Eigen::RowVector2d own_change =
        gradient.transpose() * (foot_change + own * along_change) / -gradient.dot(along);
    height += blend * own;
    height_change += own * blend_change + blend * own_change;
    point.curvature += blend / gradient.norm() * quadric.bend;
  }
  point.position = foot + height * along;
  point.tangents = foot_change + along * height_change + height * along_change;
  // The triangles are oriented with their normals out of the lumen.
  point.normal = point.tangents.col(1).cross(point.tangents.col(0)).normalized();
  const Eigen::Matrix3d tangential = Eigen::Matrix3d::Identity() - point.normal * point.normal.transpose();
  point.curvature = (tangential * point.curvature * tangential).eval();
  return point;
}

bool SmoothWall::mayBulge(int edge, const Eigen::Vector3d& along) const
{
  const std::array<int, 2>& ends = wall_.edges[edge].vertices;
  const auto convex = [&](int vertex)
  { return along.dot(quadrics_[vertex].bend * along) < -kLeastBulge * along.squaredNorm(); };
  return isSharp(edge) || convex(ends[0]) || convex(ends[1]);
}

double SmoothWall::creaseShare() const
{
  return crease_.empty()
             ? 0.0
             : static_cast<double>(std::count(crease_.begin(), crease_.end(), 1)) / static_cast<double>(crease_.size());
}

geometry::TriangleMesh refinedForSmoothWall(geometry::TriangleMesh mesh)
{
  std::vector<double> angles;
  for (const WallEdge& edge : Wall(mesh).edges)
    angles.push_back(std::abs(edge.reflex_angle));
  const auto large = angles.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(angles.size()));
  std::nth_element(angles.begin(), large, angles.end());
  int levels = 0;
  for (double angle = *large; angle > kWidestDihedral && levels < kMostLevels; angle *= 0.5)
    ++levels;
  return geometry::normalSubdivision(std::move(mesh), levels, kCreaseOfFacets);
}

geometry::TriangleMesh tessellate(const SmoothWall& smooth, int parts)
{
  const Wall& wall = smooth.wall();
  geometry::TriangleMesh mesh;
  std::map<std::array<int, 6>, int> known;  // corner and its multiple, sorted: the same from both triangles of an edge
  const auto vertexAt = [&](int triangle, const std::array<int, 3>& multiple)
  {
    std::array<std::pair<int, int>, 3> named;
    for (int k = 0; k < 3; ++k)
      named[k] = {multiple[k] > 0 ? wall.triangles[triangle][k] : -1, multiple[k]};
    std::sort(named.begin(), named.end());
    const std::array<int, 6> key = {named[0].first,  named[0].second, named[1].first,
                                    named[1].second, named[2].first,  named[2].second};
    const auto [entry, is_new] = known.emplace(key, static_cast<int>(mesh.vertices.size()));
    if (is_new)
      mesh.vertices.push_back(
          smooth.positionAt(triangle, Eigen::Vector3d(multiple[0], multiple[1], multiple[2]) / parts));
    return entry->second;
  };
  for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t)
    for (int i = 0; i < parts; ++i)
      for (int j = 0; i + j < parts; ++j)
      {
        const int k = parts - i - j;
        const int a = vertexAt(t, {k, i, j});
        const int b = vertexAt(t, {k - 1, i + 1, j});
        const int c = vertexAt(t, {k - 1, i, j + 1});
        mesh.triangles.emplace_back(a, b, c);
        if (i + j + 1 < parts)
          mesh.triangles.emplace_back(b, vertexAt(t, {k - 2, i + 1, j + 1}), c);
      }
  return mesh;
}

}  // namespace endovascular_sim::contact
