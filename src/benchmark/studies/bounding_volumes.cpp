#include "benchmark/studies/bounding_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/kDOP.h>

#include "common/error.h"
#include "common/time/processor_time.h"
#include "geometry/closest_point_on_triangle.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr int kMaxDepth = 128;

double gap(double value, double low, double high)
{
  return std::max(0.0, std::max(low - value, value - high));
}

/** Slabs of a k-DOP in the order of FCL: the axes, diagonals of two axes and (k = 24) of three axes. */
template <int K>
struct DopVolume
{
  static constexpr int kSlabs = K / 2;

  struct Point
  {
    std::array<double, kSlabs> along;
  };

  explicit DopVolume(const fcl::KDOP<double, K>& from)
  {
    for (int slab = 0; slab < kSlabs; ++slab)
    {
      low[slab] = from.dist(slab);
      high[slab] = from.dist(slab + kSlabs);
    }
  }

  static Point prepare(const Eigen::Vector3d& p)
  {
    const std::array<double, 12> all = {p.x(),
                                        p.y(),
                                        p.z(),
                                        p.x() + p.y(),
                                        p.x() + p.z(),
                                        p.y() + p.z(),
                                        p.x() - p.y(),
                                        p.x() - p.z(),
                                        p.y() - p.z(),
                                        p.x() + p.y() - p.z(),
                                        p.x() + p.z() - p.y(),
                                        p.y() + p.z() - p.x()};
    Point point;
    std::copy_n(all.begin(), kSlabs, point.along.begin());
    return point;
  }

  double bound(const Point& p) const
  {
    double axial = 0.0;
    double of_two = 0.0;
    double of_three = 0.0;
    for (int slab = 0; slab < 3; ++slab)
      axial = std::max(axial, gap(p.along[slab], low[slab], high[slab]));
    for (int slab = 3; slab < std::min(9, kSlabs); ++slab)
      of_two = std::max(of_two, gap(p.along[slab], low[slab], high[slab]));
    for (int slab = 9; slab < kSlabs; ++slab)
      of_three = std::max(of_three, gap(p.along[slab], low[slab], high[slab]));
    return std::max({axial, of_two * M_SQRT1_2, of_three / std::sqrt(3.0)});
  }

  std::array<double, kSlabs> low, high;
};

struct BoxVolume
{
  using Point = Eigen::Vector3d;
  explicit BoxVolume(const fcl::AABB<double>& from) : low(from.min_), high(from.max_) {}
  static Point prepare(const Eigen::Vector3d& p) { return p; }
  double bound(const Point& p) const { return (low - p).cwiseMax(p - high).cwiseMax(0.0).norm(); }

  Eigen::Vector3d low, high;
};

struct OrientedVolume
{
  using Point = Eigen::Vector3d;
  explicit OrientedVolume(const fcl::OBB<double>& from) : axes(from.axis), centre(from.To), half(from.extent) {}
  static Point prepare(const Eigen::Vector3d& p) { return p; }
  double bound(const Point& p) const
  {
    return ((axes.transpose() * (p - centre)).cwiseAbs() - half).cwiseMax(0.0).norm();
  }

  Eigen::Matrix3d axes;
  Eigen::Vector3d centre, half;
};

/** Flat tree of any bounding volume. */
template <typename Volume, typename FclVolume>
class Tree
{
public:
  explicit Tree(const geometry::TriangleMesh& mesh) : mesh_(mesh)
  {
    std::vector<fcl::Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const Eigen::Vector3i& t : mesh.triangles)
      triangles.emplace_back(t[0], t[1], t[2]);
    fcl::BVHModel<FclVolume> model;
    model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
    model.addSubModel(mesh.vertices, triangles);
    if (model.endModel() != fcl::BVH_OK)
      throw InputError("vessel mesh", "", "no bounding volume hierarchy can be built over it");
    nodes_.reserve(static_cast<std::size_t>(model.getNumBVs()));
    for (int n = 0; n < model.getNumBVs(); ++n)
    {
      const auto& from = model.getBV(n);
      const bool leaf = from.isLeaf();
      nodes_.push_back({Volume(from.bv), leaf ? -1 : from.leftChild(), leaf ? from.primitiveId() : -1});
    }
  }

  void collect(const Eigen::Vector3d& centre, double radius)
  {
    const typename Volume::Point point = Volume::prepare(centre);
    std::array<int, kMaxDepth> stack;
    int top = 0;
    stack[top++] = 0;
    while (top > 0)
    {
      const Node& node = nodes_[static_cast<std::size_t>(stack[--top])];
      ++tests;
      if (node.volume.bound(point) > radius)
        continue;
      if (node.left < 0)
        ++leaves;
      else
      {
        stack[top++] = node.left + 1;
        stack[top++] = node.left;
      }
    }
  }

  double nearest(const Eigen::Vector3d& centre)
  {
    const typename Volume::Point point = Volume::prepare(centre);
    struct Entry
    {
      int node;
      double bound;
    };
    std::array<Entry, kMaxDepth> stack;
    int top = 0;
    stack[top++] = {0, 0.0};
    double best = 1e300;
    while (top > 0)
    {
      const Entry entry = stack[--top];
      if (entry.bound >= best)
        continue;
      const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
      if (node.left < 0)
      {
        ++leaves;
        best = std::min(best, distanceTo(node.triangle, centre));
        continue;
      }
      tests += 2;
      Entry left{node.left, nodes_[static_cast<std::size_t>(node.left)].volume.bound(point)};
      Entry right{node.left + 1, nodes_[static_cast<std::size_t>(node.left) + 1].volume.bound(point)};
      if (left.bound > right.bound)
        std::swap(left, right);
      stack[top++] = right;
      stack[top++] = left;
    }
    return best;
  }

  std::uint64_t tests = 0;
  std::uint64_t leaves = 0;

private:
  struct Node
  {
    Volume volume;
    int left;
    int triangle;
  };

  double distanceTo(int triangle, const Eigen::Vector3d& p) const
  {
    const Eigen::Vector3i& c = mesh_.triangles[static_cast<std::size_t>(triangle)];
    return (geometry::closestPointOnTriangle(p, mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]])
                .point -
            p)
        .norm();
  }

  const geometry::TriangleMesh& mesh_;
  std::vector<Node> nodes_;
};

template <typename Work>
double fastest(int repeats, std::size_t queries, Work work)
{
  double best = 1e300;
  for (int k = 0; k < repeats; ++k)
  {
    const double start = processorSeconds();
    work();
    best = std::min(best, 1e6 * (processorSeconds() - start));
  }
  return best / static_cast<double>(queries);
}

template <typename Volume, typename FclVolume>
VolumeResult measure(const std::string& name, const geometry::TriangleMesh& mesh,
                     const std::vector<Eigen::Vector3d>& points, double radius, int repeats)
{
  VolumeResult result;
  result.name = name;
  result.bytes = sizeof(Volume);
  const double start = processorSeconds();
  Tree<Volume, FclVolume> tree(mesh);
  result.build_ms = 1e3 * (processorSeconds() - start);
  const double queries = static_cast<double>(points.size()) * repeats;
  const auto per_query = [&](double& tests, double& leaves)
  {
    tests = static_cast<double>(tree.tests) / queries;
    leaves = static_cast<double>(tree.leaves) / queries;
    tree.tests = tree.leaves = 0;
  };
  result.collect_us = fastest(repeats, points.size(),
                              [&]
                              {
                                for (const Eigen::Vector3d& p : points)
                                  tree.collect(p, radius);
                              });
  per_query(result.collect_tests, result.collect_leaves);
  double sum = 0.0;
  result.nearest_us = fastest(repeats, points.size(),
                              [&]
                              {
                                for (const Eigen::Vector3d& p : points)
                                  sum += tree.nearest(p);
                              });
  per_query(result.nearest_tests, result.nearest_leaves);
  result.mean_distance = sum / queries;
  return result;
}

}  // namespace

std::vector<VolumeResult> compareBoundingVolumes(const geometry::TriangleMesh& mesh,
                                                 const std::vector<Eigen::Vector3d>& points, double radius, int repeats)
{
  return {measure<DopVolume<16>, fcl::KDOP<double, 16>>("16-DOP", mesh, points, radius, repeats),
          measure<DopVolume<18>, fcl::KDOP<double, 18>>("18-DOP", mesh, points, radius, repeats),
          measure<DopVolume<24>, fcl::KDOP<double, 24>>("24-DOP", mesh, points, radius, repeats),
          measure<BoxVolume, fcl::AABB<double>>("axis-aligned box", mesh, points, radius, repeats),
          measure<OrientedVolume, fcl::OBB<double>>("oriented box", mesh, points, radius, repeats)};
}

}  // namespace endovascular_sim::benchmark
