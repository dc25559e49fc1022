#include "contact/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/kDOP.h>

#include "common/error.h"
#include "contact/closest_point.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr int kSlabs = 9;  // 18-DOP: x, y, z, x+y, x+z, y+z, x−y, x−z, y−z
constexpr int kMaxDepth = 128;
using Dop = fcl::KDOP<double, 2 * kSlabs>;

std::array<double, kSlabs> slabCoordinates(const Eigen::Vector3d& p)
{
  return {p.x(),         p.y(),         p.z(),         p.x() + p.y(), p.x() + p.z(),
          p.y() + p.z(), p.x() - p.y(), p.x() - p.z(), p.y() - p.z()};
}

/** Lower bound of the distance from a point to an 18-DOP: the widest gap over its slabs [m]. */
double distanceBound(const Dop& dop, const std::array<double, kSlabs>& coordinates)
{
  double axial = 0.0;
  double diagonal = 0.0;
  for (int slab = 0; slab < 3; ++slab)
    axial = std::max(axial, std::max(dop.dist(slab) - coordinates[slab], coordinates[slab] - dop.dist(slab + kSlabs)));
  for (int slab = 3; slab < kSlabs; ++slab)
    diagonal =
        std::max(diagonal, std::max(dop.dist(slab) - coordinates[slab], coordinates[slab] - dop.dist(slab + kSlabs)));
  return std::max(axial, diagonal * M_SQRT1_2);
}

}  // namespace

struct Bvh::Tree
{
  fcl::BVHModel<Dop> model;
};

Bvh::Bvh(const Wall& wall) : tree_(std::make_unique<Tree>()), wall_(&wall)
{
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(wall.triangles.size());
  for (const Eigen::Vector3i& t : wall.triangles)
    triangles.emplace_back(t[0], t[1], t[2]);
  tree_->model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(wall.vertices.size()));
  tree_->model.addSubModel(wall.vertices, triangles);
  if (tree_->model.endModel() != fcl::BVH_OK)
    throw InputError("vessel mesh", "", "no bounding volume hierarchy can be built over it: it needs triangles");
}

Bvh::~Bvh() = default;
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;

void Bvh::collect(const Eigen::Vector3d& point, double radius, std::vector<int>& triangles) const
{
  const std::array<double, kSlabs> coordinates = slabCoordinates(point);
  std::array<int, kMaxDepth> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0)
  {
    const auto& node = tree_->model.getBV(stack[--top]);
    if (distanceBound(node.bv, coordinates) > radius)
      continue;
    if (node.isLeaf())
      triangles.push_back(node.primitiveId());
    else
    {
      stack[top++] = node.rightChild();
      stack[top++] = node.leftChild();
    }
  }
}

Bvh::Nearest Bvh::nearest(const Eigen::Vector3d& point, double max_distance) const
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
  while (top > 0)
  {
    const Entry entry = stack[--top];
    // Equal distances go to the lowest triangle, so that the answer does not depend on the order of the walk.
    if (entry.bound > best.distance)
      continue;
    const auto& node = tree_->model.getBV(entry.node);
    if (node.isLeaf())
    {
      const int t = node.primitiveId();
      const Eigen::Vector3i& corners = wall_->triangles[t];
      const double distance = (closestPointOnTriangle(point, wall_->vertices[corners[0]], wall_->vertices[corners[1]],
                                                      wall_->vertices[corners[2]])
                                   .point -
                               point)
                                  .norm();
      if (distance < best.distance || (distance == best.distance && (best.triangle < 0 || t < best.triangle)))
        best = {t, distance};
      continue;
    }
    Entry left{node.leftChild(), distanceBound(tree_->model.getBV(node.leftChild()).bv, coordinates)};
    Entry right{node.rightChild(), distanceBound(tree_->model.getBV(node.rightChild()).bv, coordinates)};
    if (left.bound > right.bound)
      std::swap(left, right);
    stack[top++] = right;
    stack[top++] = left;
  }
  return best;
}

}  // namespace endovascular_sim::contact
