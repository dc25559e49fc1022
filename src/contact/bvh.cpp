#include "contact/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/kDOP.h>

#include "common/error.h"
#include "vessel/triangle_point.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr int kMaxDepth = 128;
constexpr double kBoundRounding = 1.0 + 1e-12;  // so that no bound's rounding hides the nearest triangle

}  // namespace

Bvh::Bvh(const Wall& wall) : wall_(&wall)
{
  using Dop = fcl::KDOP<double, 2 * kSlabs>;
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(wall.triangles.size());
  for (const Eigen::Vector3i& t : wall.triangles)
    triangles.emplace_back(t[0], t[1], t[2]);
  fcl::BVHModel<Dop> model;
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(wall.vertices.size()));
  model.addSubModel(wall.vertices, triangles);
  if (model.endModel() != fcl::BVH_OK)
    throw InputError("vessel mesh", "", "no bounding volume hierarchy can be built over it: it needs triangles");
  nodes_.resize(static_cast<std::size_t>(model.getNumBVs()));
  for (std::size_t n = 0; n < nodes_.size(); ++n)
  {
    const auto& from = model.getBV(static_cast<int>(n));
    for (int slab = 0; slab < kSlabs; ++slab)
    {
      nodes_[n].low[slab] = from.bv.dist(slab);
      nodes_[n].high[slab] = from.bv.dist(slab + kSlabs);
    }
    if (from.isLeaf())
      nodes_[n].triangle = from.primitiveId();
    else
      nodes_[n].left = from.leftChild();
  }
}

std::array<double, Bvh::kSlabs> Bvh::slabCoordinates(const Eigen::Vector3d& p)
{
  return {p.x(),         p.y(),         p.z(),         p.x() + p.y(), p.x() + p.z(),
          p.y() + p.z(), p.x() - p.y(), p.x() - p.z(), p.y() - p.z()};
}

/** Lower bound of the distance from a point to an 18-DOP: the distance to the box of its axes or, where that is within
 *  @p wanted, the widest gap over its diagonals when that is more [m]. The box decides most of all cases. */
double Bvh::distanceBound(const Node& node, const std::array<double, kSlabs>& coordinates, double wanted)
{
  const auto gap = [&](int slab)
  { return std::max(0.0, std::max(node.low[slab] - coordinates[slab], coordinates[slab] - node.high[slab])); };
  const double x = gap(0);
  const double y = gap(1);
  const double z = gap(2);
  const double box = std::sqrt(x * x + y * y + z * z);
  if (box > wanted)
    return box;
  double diagonal = 0.0;
  for (int slab = 3; slab < kSlabs; ++slab)
    diagonal = std::max(diagonal, gap(slab));
  return std::max(box, diagonal * M_SQRT1_2);
}

void Bvh::collect(const Eigen::Vector3d& point, double radius, std::vector<int>& triangles) const
{
  const std::array<double, kSlabs> coordinates = slabCoordinates(point);
  std::array<int, kMaxDepth> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0)
  {
    const Node& node = nodes_[stack[--top]];
    if (distanceBound(node, coordinates, radius) > kBoundRounding * radius)
      continue;
    if (node.left < 0)
      triangles.push_back(node.triangle);
    else
    {
      stack[top++] = node.left + 1;
      stack[top++] = node.left;
    }
  }
}

double Bvh::distanceTo(int triangle, const Eigen::Vector3d& point) const
{
  const Eigen::Vector3i& corners = wall_->triangles[triangle];
  const vessel::TrianglePoint closest = vessel::closestPointOnTriangle(
      point, wall_->vertices[corners[0]], wall_->vertices[corners[1]], wall_->vertices[corners[2]]);
  return (closest.point - point).norm();
}

Bvh::Nearest Bvh::nearest(const Eigen::Vector3d& point, double max_distance, int near) const
{
  const std::array<double, kSlabs> coordinates = slabCoordinates(point);
  struct Entry
  {
    int node;
    double bound;
  };
  std::array<Entry, kMaxDepth> stack;
  int top = 0;
  stack[top++] = {0, 0.0};
  Nearest best{-1, max_distance};
  // Equal distances go to the lowest triangle, so that the answer does not depend on the order of the walk.
  const auto offer = [&best, &point, this](int t)
  {
    const double distance = distanceTo(t, point);
    if (distance < best.distance || (distance == best.distance && (best.triangle < 0 || t < best.triangle)))
      best = {t, distance};
  };
  if (near >= 0)
    offer(near);
  while (top > 0)
  {
    const Entry entry = stack[--top];
    if (entry.bound > kBoundRounding * best.distance)
      continue;
    const Node& node = nodes_[entry.node];
    if (node.left < 0)
    {
      offer(node.triangle);
      continue;
    }
    Entry left{node.left, distanceBound(nodes_[node.left], coordinates, best.distance)};
    Entry right{node.left + 1, distanceBound(nodes_[node.left + 1], coordinates, best.distance)};
    if (left.bound > right.bound)
      std::swap(left, right);
    stack[top++] = right;
    stack[top++] = left;
  }
  return best;
}

}  // namespace endovascular_sim::contact
