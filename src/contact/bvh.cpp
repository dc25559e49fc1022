#include "contact/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>

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
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(wall.triangles.size());
  for (const Eigen::Vector3i& t : wall.triangles)
    triangles.emplace_back(t[0], t[1], t[2]);
  fcl::BVHModel<fcl::AABB<double>> model;
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(wall.vertices.size()));
  model.addSubModel(wall.vertices, triangles);
  if (model.endModel() != fcl::BVH_OK)
    throw InputError("vessel mesh", "", "no bounding volume hierarchy can be built over it: it needs triangles");
  nodes_.resize(static_cast<std::size_t>(model.getNumBVs()));
  for (std::size_t n = 0; n < nodes_.size(); ++n)
  {
    const auto& from = model.getBV(static_cast<int>(n));
    for (int axis = 0; axis < 3; ++axis)
    {
      nodes_[n].low[axis] = from.bv.min_[axis];
      nodes_[n].high[axis] = from.bv.max_[axis];
    }
    if (from.isLeaf())
      nodes_[n].triangle = from.primitiveId();
    else
      nodes_[n].left = from.leftChild();
  }
  parent_.assign(nodes_.size(), -1);
  leaf_of_.assign(wall.triangles.size(), -1);
  marked_.assign(nodes_.size(), 0);
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].left < 0)
      leaf_of_[nodes_[n].triangle] = static_cast<int>(n);
    else
      parent_[nodes_[n].left] = parent_[nodes_[n].left + 1] = static_cast<int>(n);
}

void Bvh::fitLeaf(Node& leaf) const
{
  const Eigen::Vector3i& corners = wall_->triangles[leaf.triangle];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = wall_->vertices[corners[0]][axis];
    const double b = wall_->vertices[corners[1]][axis];
    const double c = wall_->vertices[corners[2]][axis];
    leaf.low[axis] = std::min({a, b, c});
    leaf.high[axis] = std::max({a, b, c});
  }
}

void Bvh::refit(const std::vector<int>& triangles)
{
  ancestors_.clear();
  for (int t : triangles)
  {
    fitLeaf(nodes_[leaf_of_[t]]);
    for (int n = parent_[leaf_of_[t]]; n >= 0 && !marked_[n]; n = parent_[n])
    {
      marked_[n] = 1;
      ancestors_.push_back(n);
    }
  }
  std::sort(ancestors_.begin(), ancestors_.end(), std::greater<>());
  for (int n : ancestors_)
  {
    marked_[n] = 0;
    Node& node = nodes_[n];
    const Node& left = nodes_[node.left];
    const Node& right = nodes_[node.left + 1];
    for (int axis = 0; axis < 3; ++axis)
    {
      node.low[axis] = std::min(left.low[axis], right.low[axis]);
      node.high[axis] = std::max(left.high[axis], right.high[axis]);
    }
  }
}

double Bvh::squaredDistance(const Node& node, const Eigen::Vector3d& point)
{
  double squared = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double gap = std::max(0.0, std::max(node.low[axis] - point[axis], point[axis] - node.high[axis]));
    squared += gap * gap;
  }
  return squared;
}

void Bvh::collect(const Eigen::Vector3d& point, double radius, std::vector<int>& triangles) const
{
  const double limit = kBoundRounding * radius * radius;
  std::array<int, kMaxDepth> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0)
  {
    const Node& node = nodes_[stack[--top]];
    if (squaredDistance(node, point) > limit)
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

void Bvh::collectBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::vector<int>& triangles) const
{
  std::array<int, kMaxDepth> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0)
  {
    const Node& node = nodes_[stack[--top]];
    if (node.low[0] > high[0] || node.high[0] < low[0] || node.low[1] > high[1] || node.high[1] < low[1] ||
        node.low[2] > high[2] || node.high[2] < low[2])
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
  struct Entry
  {
    int node;
    double bound;  // squared
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
    if (entry.bound > kBoundRounding * best.distance * best.distance)
      continue;
    const Node& node = nodes_[entry.node];
    if (node.left < 0)
    {
      offer(node.triangle);
      continue;
    }
    Entry left{node.left, squaredDistance(nodes_[node.left], point)};
    Entry right{node.left + 1, squaredDistance(nodes_[node.left + 1], point)};
    if (left.bound > right.bound)
      std::swap(left, right);
    stack[top++] = right;
    stack[top++] = left;
  }
  return best;
}

}  // namespace endovascular_sim::contact
