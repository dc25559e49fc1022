#include "geometry/mesh_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/closest_point_on_triangle.h"

namespace endovascular_sim::geometry
{
namespace
{

constexpr int kLeafSize = 4;
constexpr int kDiscSize = 64;          // largest number of triangles of a node with a disc
constexpr double kDiscMargin = 1e-12;  // above the rounding of distances [m]

const Eigen::Vector3d& corner(const TriangleMesh& mesh, int t, int k)
{
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][k])];
}

/** Distance along the ray to the triangle; −1 without a hit. T. Möller, B. Trumbore, "Fast, minimum storage
 *  ray/triangle intersection", 1997. */
double rayTriangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, const Eigen::Vector3d& a,
                   const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d across = direction.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0.0)
    return -1.0;
  const Eigen::Vector3d from = origin - a;
  const double u = from.dot(across) / determinant;
  const Eigen::Vector3d q = from.cross(ab);
  const double v = direction.dot(q) / determinant;
  if (u < 0.0 || v < 0.0 || u + v > 1.0)
    return -1.0;
  return ac.dot(q) / determinant;
}

/** Distance along the ray to its entry into the box (slab test); 1e300 without a hit. */
double rayBox(const Eigen::Vector3d& origin, const Eigen::Vector3d& inverse, const Eigen::AlignedBox3d& box)
{
  const Eigen::Array3d t0 = (box.min() - origin).array() * inverse.array();
  const Eigen::Array3d t1 = (box.max() - origin).array() * inverse.array();
  const double enter = t0.min(t1).maxCoeff();
  const double leave = t0.max(t1).minCoeff();
  return leave >= std::max(enter, 0.0) ? std::max(enter, 0.0) : 1e300;
}

}  // namespace

MeshDistance::MeshDistance(const TriangleMesh& mesh) : order_(mesh.triangles.size())
{
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(order_.size());
  for (int t : order_)
    centres.emplace_back((corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3.0);
  nodes_.reserve(order_.size());
  discs_.reserve(order_.size());
  if (!order_.empty())
    build(0, static_cast<int>(order_.size()), mesh, centres);
  corners_.reserve(order_.size());
  for (int t : order_)
    corners_.push_back({corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2)});
}

double MeshDistance::Disc::squaredDistance(const Eigen::Vector3d& p) const
{
  const Eigen::Vector3d from = p - centre;
  const double height = from.dot(axis);
  const double above = std::max(0.0, std::abs(height) - half_thickness);
  const double beside = std::max(0.0, std::sqrt(std::max(0.0, from.squaredNorm() - height * height)) - radius);
  return above * above + beside * beside;
}

MeshDistance::Disc MeshDistance::discOf(int begin, int end, const TriangleMesh& mesh) const
{
  Disc disc;
  Eigen::AlignedBox3d box;
  for (int k = begin; k < end; ++k)
  {
    const int t = order_[static_cast<std::size_t>(k)];
    for (int i = 0; i < 3; ++i)
      box.extend(corner(mesh, t, i));
    disc.axis += (corner(mesh, t, 1) - corner(mesh, t, 0)).cross(corner(mesh, t, 2) - corner(mesh, t, 0));
  }
  const double length = disc.axis.norm();
  if (!(length > 0.0) || !std::isfinite(length))
    return {};
  disc.axis /= length;
  disc.centre = box.center();
  double squared_radius = 0.0;
  for (int k = begin; k < end; ++k)
    for (int i = 0; i < 3; ++i)
    {
      const Eigen::Vector3d from = corner(mesh, order_[static_cast<std::size_t>(k)], i) - disc.centre;
      const double height = from.dot(disc.axis);
      disc.half_thickness = std::max(disc.half_thickness, std::abs(height));
      squared_radius = std::max(squared_radius, (from - height * disc.axis).squaredNorm());
    }
  disc.half_thickness += kDiscMargin;
  disc.radius = std::sqrt(squared_radius) + kDiscMargin;
  return disc;
}

int MeshDistance::build(int begin, int end, const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& centres)
{
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  discs_.push_back(end - begin <= kDiscSize ? discOf(begin, end, mesh) : Disc());
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d spread;
  for (int k = begin; k < end; ++k)
  {
    const int t = order_[static_cast<std::size_t>(k)];
    for (int i = 0; i < 3; ++i)
      box.extend(corner(mesh, t, i));
    spread.extend(centres[static_cast<std::size_t>(t)]);
  }
  int right = -1;
  if (end - begin > kLeafSize)
  {
    int axis = 0;
    spread.sizes().maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b)
                     {
                       const double x = centres[static_cast<std::size_t>(a)][axis];
                       const double y = centres[static_cast<std::size_t>(b)][axis];
                       return x < y || (x == y && a < b);
                     });
    build(begin, middle, mesh, centres);
    right = build(middle, end, mesh, centres);
  }
  nodes_[static_cast<std::size_t>(index)] = {box, begin, end, right};
  return index;
}

ClosestPoint MeshDistance::closest(const Eigen::Vector3d& p, double limit) const
{
  ClosestPoint best;
  double best_squared = limit < 1e150 ? limit * limit : 1e300;
  std::array<std::pair<double, int>, 96> stack;
  std::size_t depth = 0;
  if (!nodes_.empty())
    stack[depth++] = {nodes_[0].box.squaredExteriorDistance(p), 0};
  while (depth > 0)
  {
    const auto [nearest, index] = stack[--depth];
    if (nearest >= best_squared)
      continue;
    const Disc& disc = discs_[static_cast<std::size_t>(index)];
    if (disc.radius >= 0.0 && disc.squaredDistance(p) >= best_squared)
      continue;
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.right >= 0)
    {
      // The nearer child is visited first.
      const double left = nodes_[static_cast<std::size_t>(index) + 1].box.squaredExteriorDistance(p);
      const double right = nodes_[static_cast<std::size_t>(node.right)].box.squaredExteriorDistance(p);
      const bool left_first = left <= right;
      stack[depth++] = left_first ? std::pair(right, node.right) : std::pair(left, index + 1);
      stack[depth++] = left_first ? std::pair(left, index + 1) : std::pair(right, node.right);
      continue;
    }
    for (int k = node.begin; k < node.end; ++k)
    {
      const auto& [a, b, c] = corners_[static_cast<std::size_t>(k)];
      const Eigen::Vector3d q = closestPointOnTriangle(p, a, b, c).point;
      const double squared = (q - p).squaredNorm();
      if (squared < best_squared)
      {
        best_squared = squared;
        best = {q, std::sqrt(squared), order_[static_cast<std::size_t>(k)]};
      }
    }
  }
  return best;
}

bool MeshDistance::isNearer(const Eigen::Vector3d& p, double limit) const
{
  // Boxes are compared by squares: a margin above their rounding keeps the result equal to that of closest().
  const double squared_limit = limit * limit * (1.0 + 1e-12);
  std::array<int, 96> stack;
  std::size_t depth = 0;
  if (!nodes_.empty() && nodes_[0].box.squaredExteriorDistance(p) <= squared_limit)
    stack[depth++] = 0;
  while (depth > 0)
  {
    const int index = stack[--depth];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.right >= 0)
    {
      const double left = nodes_[static_cast<std::size_t>(index) + 1].box.squaredExteriorDistance(p);
      const double right = nodes_[static_cast<std::size_t>(node.right)].box.squaredExteriorDistance(p);
      const bool left_first = left <= right;
      if (std::max(left, right) <= squared_limit)
        stack[depth++] = left_first ? node.right : index + 1;
      if (std::min(left, right) <= squared_limit)
        stack[depth++] = left_first ? index + 1 : node.right;
      continue;
    }
    for (int k = node.begin; k < node.end; ++k)
    {
      const auto& [a, b, c] = corners_[static_cast<std::size_t>(k)];
      if ((closestPointOnTriangle(p, a, b, c).point - p).norm() < limit)
        return true;
    }
  }
  return false;
}

double MeshDistance::rayHit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const
{
  double best = 1e299;
  const Eigen::Vector3d inverse = direction.cwiseInverse();
  std::array<int, 96> stack;
  int depth = 0;
  if (!nodes_.empty())
    stack[static_cast<std::size_t>(depth++)] = 0;
  while (depth > 0)
  {
    const int index = stack[static_cast<std::size_t>(--depth)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (rayBox(origin, inverse, node.box) > best)
      continue;
    if (node.right >= 0)
    {
      stack[static_cast<std::size_t>(depth++)] = node.right;
      stack[static_cast<std::size_t>(depth++)] = index + 1;
      continue;
    }
    for (int k = node.begin; k < node.end; ++k)
    {
      const auto& [a, b, c] = corners_[static_cast<std::size_t>(k)];
      const double hit = rayTriangle(origin, direction, a, b, c);
      if (hit >= 0.0 && hit < best)
        best = hit;
    }
  }
  return best < 1e299 ? best : -1.0;
}

double windingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& p)
{
  double half_angles = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    const Eigen::Vector3d a = corner(mesh, static_cast<int>(t), 0) - p;
    const Eigen::Vector3d b = corner(mesh, static_cast<int>(t), 1) - p;
    const Eigen::Vector3d c = corner(mesh, static_cast<int>(t), 2) - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    half_angles += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles / (2.0 * M_PI);
}

}  // namespace endovascular_sim::geometry
