#include "contact/broad_phase/bvh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>

#include "common/error.h"
#include "geometry/closest_point_on_triangle.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr float kLaneRounding = 1.00001F;  // exceeds the rounding error of squared bounds
constexpr float kNone = 1e18F;             // m: coordinates of the boxes of empty lanes

/** Single-precision number below x, by at most two units in the last place. */
float roundedDown(double x)
{
  const auto nearest = static_cast<float>(x);
  return nearest - std::numeric_limits<float>::epsilon() * std::abs(nearest) - std::numeric_limits<float>::min();
}

float roundedUp(double x)
{
  return -roundedDown(-x);
}

}  // namespace

struct Bvh::Binary
{
  fcl::BVHModel<fcl::AABB<double>> model;

  bool isLeaf(int node) const { return model.getBV(node).isLeaf(); }
  double surface(int node) const
  {
    const auto& size = model.getBV(node).bv.max_ - model.getBV(node).bv.min_;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

Bvh::Box::Box(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    low[axis] = roundedDown(from[axis]);
    high[axis] = roundedUp(to[axis]);
  }
}

Bvh::Box::Box(const Node& node)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    low[axis] = node.low[axis].minCoeff();
    high[axis] = node.high[axis].maxCoeff();
  }
}

Bvh::Bvh(const Wall& wall) : wall_(&wall)
{
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(wall.triangles.size());
  for (const Eigen::Vector3i& t : wall.triangles)
    triangles.emplace_back(t[0], t[1], t[2]);
  Binary binary;
  binary.model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(wall.vertices.size()));
  binary.model.addSubModel(wall.vertices, triangles);
  if (binary.model.endModel() != fcl::BVH_OK)
    throw InputError("vessel mesh", "", "no bounding volume hierarchy can be built over it: it needs triangles");
  slot_of_.resize(wall.triangles.size());
  copy(binary, 0, {});
  marked_.assign(nodes_.size(), 0);
  openAllCones();
}

/** Copies the subtree of a binary node, opening the largest boxes until there are four. @return index of the copy */
int Bvh::copy(const Binary& binary, int root, Slot above)
{
  std::vector<int> members{root};
  while (members.size() < kWidth)
  {
    const auto rank = [&binary](int node) { return binary.isLeaf(node) ? -1.0 : binary.surface(node); };
    const auto largest =
        std::max_element(members.begin(), members.end(), [&rank](int a, int b) { return rank(a) < rank(b); });
    if (binary.isLeaf(*largest))
      break;
    const auto& opened = binary.model.getBV(*largest);
    *largest = opened.leftChild();
    members.push_back(opened.rightChild());
  }
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  above_.push_back(above);
  for (int axis = 0; axis < 3; ++axis)
  {
    nodes_[index].low[axis].setConstant(kNone);
    nodes_[index].high[axis].setConstant(-kNone);
  }
  nodes_[index].child.fill(-1);
  for (int lane = 0; lane < static_cast<int>(members.size()); ++lane)
  {
    const auto& member = binary.model.getBV(members[lane]);
    const Slot slot{index, lane};
    setBox(slot, Box(member.bv.min_, member.bv.max_));
    if (member.isLeaf())
      slot_of_[member.primitiveId()] = slot;
    const int child = member.isLeaf() ? ~member.primitiveId() : copy(binary, members[lane], slot);
    nodes_[index].child[lane] = child;
  }
  return index;
}

void Bvh::setBox(Slot slot, const Box& box)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    nodes_[slot.node].low[axis][slot.lane] = box.low[axis];
    nodes_[slot.node].high[axis][slot.lane] = box.high[axis];
  }
}

void Bvh::fitTriangle(int triangle)
{
  const Eigen::Vector3i& corners = wall_->triangles[triangle];
  const Eigen::Vector3d& a = wall_->vertices[corners[0]];
  const Eigen::Vector3d& b = wall_->vertices[corners[1]];
  const Eigen::Vector3d& c = wall_->vertices[corners[2]];
  setBox(slot_of_[triangle], Box(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)));
}

void Bvh::refit(const std::vector<int>& triangles)
{
  ancestors_.clear();
  for (int t : triangles)
  {
    fitTriangle(t);
    for (int n = slot_of_[t].node; n >= 0 && !marked_[n]; n = above_[n].node)
    {
      marked_[n] = 1;
      ancestors_.push_back(n);
    }
  }
  std::sort(ancestors_.begin(), ancestors_.end(), std::greater<>());
  for (int n : ancestors_)
  {
    marked_[n] = 0;
    if (above_[n].node >= 0)
      setBox(above_[n], Box(nodes_[n]));
  }
}

Bvh::Lanes Bvh::squaredGaps(const Node& node, const Box& box)
{
  return gaps(node, box, 0).max(0.0F).square() + gaps(node, box, 1).max(0.0F).square() +
         gaps(node, box, 2).max(0.0F).square();
}

double Bvh::distanceTo(int triangle, const Eigen::Vector3d& point) const
{
  const Eigen::Vector3i& corners = wall_->triangles[triangle];
  const geometry::TrianglePoint closest = geometry::closestPointOnTriangle(
      point, wall_->vertices[corners[0]], wall_->vertices[corners[1]], wall_->vertices[corners[2]]);
  return (closest.point - point).norm();
}

Bvh::Nearest Bvh::nearest(const Eigen::Vector3d& point, double max_distance, int hint) const
{
  struct Entry
  {
    int child;
    float bound;  // squared
  };
  std::array<Entry, kMaxDepth> stack;
  int top = 0;
  stack[top++] = {0, 0.0F};
  Nearest best{-1, max_distance};
  const auto squaredBound = [](double distance) { return kLaneRounding * roundedUp(distance * distance); };
  float limit = squaredBound(max_distance);
  // The lowest index wins at equal distances, so the result does not depend on the order of traversal.
  const auto offer = [&](int t)
  {
    const double distance = distanceTo(t, point);
    if (distance < best.distance || (distance == best.distance && (best.triangle < 0 || t < best.triangle)))
      best = {t, distance};
    limit = squaredBound(best.distance);
  };
  if (hint >= 0)
    offer(hint);
  const Box box(point, point);
  while (top > 0)
  {
    const Entry entry = stack[--top];
    if (entry.bound > limit)
      continue;
    if (entry.child < 0)
    {
      offer(~entry.child);
      continue;
    }
    const Node& node = nodes_[entry.child];
    const Lanes bounds = squaredGaps(node, box);
    const int begin = top;
    for (int lane = 0; lane < kWidth; ++lane)
      if (bounds[lane] <= limit && bounds[lane] < kNone)
      {
        // Sorted, the nearest box on top of the stack.
        int at = top++;
        for (; at > begin && stack[at - 1].bound < bounds[lane]; --at)
          stack[at] = stack[at - 1];
        stack[at] = {node.child[lane], bounds[lane]};
      }
  }
  return best;
}

}  // namespace endovascular_sim::contact
