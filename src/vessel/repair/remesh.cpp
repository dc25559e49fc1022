#include "vessel/repair/remesh.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vessel/repair/editable_mesh.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Ratios to the target edge length above and below which edges are split or collapsed. */
constexpr double kLongest = 4.0 / 3.0;
constexpr double kShortest = 4.0 / 5.0;
/** Cosine of the largest rotation of a face normal by a collapse or flip. */
constexpr double kMaxRotation = 0.5;
/** Guards at the creases of a coarse wall, where several points may have the same projection: minimum ratio of a face's
 *  new area to the old one, and minimum relative length of the parts of a split edge. Smooth targets need no guards. */
constexpr double kMinAreaRatio = 1e-7;
constexpr double kMinSplitRatio = 0.05;

/** Incremental isotropic remeshing. */
class Remesher
{
public:
  /** @param is_free per vertex, nonzero if it may move; empty if all vertices may move */
  Remesher(const geometry::TriangleMesh& mesh, const RemeshTarget& target, const std::vector<char>& is_free)
    : mesh_(mesh),
      target_(target),
      min_area_ratio_(is_free.empty() ? 0.0 : kMinAreaRatio),
      min_split_ratio_(is_free.empty() ? 0.0 : kMinSplitRatio)
  {
    for (int v = 0; v < mesh_.vertexCount(); ++v)
    {
      edge_length_.push_back(0.0);
      normal_.emplace_back(Eigen::Vector3d::Zero());
      if (is_free.empty() || is_free[static_cast<std::size_t>(v)] != 0)
        place(v, target_.project(mesh_.position(v)));
    }
  }

  geometry::TriangleMesh run(int rounds)
  {
    for (int round = 0; round < rounds; ++round)
    {
      splitLongEdges();
      collapseShortEdges();
      flipEdges();
      relax();
    }
    flipEdges();
    return mesh_.compact();
  }

private:
  /** True if a vertex may move; fixed vertices have no edge length. */
  bool isFree(int v) const { return edge_length_[static_cast<std::size_t>(v)] > 0.0; }

  double targetLength(int a, int b) const
  {
    if (!isFree(a) || !isFree(b))
      return std::max(edge_length_[static_cast<std::size_t>(a)], edge_length_[static_cast<std::size_t>(b)]);
    return 0.5 * (edge_length_[static_cast<std::size_t>(a)] + edge_length_[static_cast<std::size_t>(b)]);
  }

  double length(int a, int b) const { return (mesh_.position(a) - mesh_.position(b)).norm(); }

  void place(int v, const TargetPoint& target)
  {
    mesh_.move(v, target.position);
    edge_length_[static_cast<std::size_t>(v)] = target.edge_length;
    normal_[static_cast<std::size_t>(v)] = target.normal;
  }

  /** Calls edit(a, b) for every edge of the triangles that exist at the time of the call. */
  template <typename Edit>
  void forEdges(Edit edit)
  {
    const int count = mesh_.triangleCount();
    for (int t = 0; t < count; ++t)
      for (int k = 0; k < 3 && mesh_.aliveTriangle(t); ++k)
      {
        const int a = mesh_.triangle(t)[k];
        const int b = mesh_.triangle(t)[(k + 1) % 3];
        if (a < b)
          edit(a, b);
      }
  }

  void splitLongEdges()
  {
    forEdges(
        [this](int a, int b)
        {
          if ((!isFree(a) && !isFree(b)) || length(a, b) <= kLongest * targetLength(a, b))
            return;
          const TargetPoint middle = target_.project(0.5 * (mesh_.position(a) + mesh_.position(b)));
          // At a crease, the projected midpoint may coincide with a corner.
          const auto sides = mesh_.trianglesAt(a, b);
          for (int near : {a, b, mesh_.opposite(sides[0], a, b), mesh_.opposite(sides[1], a, b)})
            if ((middle.position - mesh_.position(near)).norm() < min_split_ratio_ * length(a, b))
              return;
          mesh_.split(a, b, middle.position);
          edge_length_.push_back(middle.edge_length);
          normal_.push_back(middle.normal);
        });
  }

  bool collapseIsValid(int a, int b, const TargetPoint& middle) const
  {
    for (const auto& [moved, other] : {std::pair<int, int>{a, b}, std::pair<int, int>{b, a}})
    {
      for (int t : mesh_.around(moved))
      {
        if ((mesh_.triangle(t).array() == other).any())
          continue;
        const Eigen::Vector3d before = mesh_.areaNormal(t);
        const Eigen::Vector3d after = mesh_.areaNormal(t, moved, middle.position);
        const bool was_sliver = before.norm() < 1e-3 * middle.edge_length * middle.edge_length;
        if (!was_sliver && before.dot(after) < kMaxRotation * before.norm() * after.norm())
          return false;
        if (after.dot(middle.normal) < kMaxRotation * after.norm() || after.norm() < min_area_ratio_ * before.norm())
          return false;
      }
      for (int v : mesh_.neighbours(moved))
        if (v != other && (mesh_.position(v) - middle.position).norm() > kLongest * middle.edge_length)
          return false;
    }
    return true;
  }

  void collapseShortEdges()
  {
    forEdges(
        [this](int a, int b)
        {
          if (!isFree(a) || !isFree(b) || length(a, b) >= kShortest * targetLength(a, b) || !mesh_.canCollapse(a, b))
            return;
          const TargetPoint middle = target_.project(0.5 * (mesh_.position(a) + mesh_.position(b)));
          if (!(middle.edge_length > 0.0) || !collapseIsValid(a, b, middle))
            return;
          mesh_.collapse(a, b, middle.position);
          place(b, middle);
        });
  }

  double angleAt(int apex, int a, int b) const
  {
    const Eigen::Vector3d u = mesh_.position(a) - mesh_.position(apex);
    const Eigen::Vector3d v = mesh_.position(b) - mesh_.position(apex);
    return std::atan2(u.cross(v).norm(), u.dot(v));
  }

  /** Delaunay flips whose new faces agree with the target's normals. */
  void flipEdges()
  {
    for (int sweep = 0; sweep < 3; ++sweep)
      forEdges(
          [this](int a, int b)
          {
            if (!isFree(a) && !isFree(b))
              return;
            const auto sides = mesh_.trianglesAt(a, b);
            const int c = mesh_.opposite(sides[0], a, b);
            const int d = mesh_.opposite(sides[1], a, b);
            if (angleAt(c, a, b) + angleAt(d, a, b) <= M_PI + 1e-6)
              return;
            const double whole = mesh_.areaNormal(sides[0]).norm() + mesh_.areaNormal(sides[1]).norm();
            if (!mesh_.flip(a, b))
              return;
            const Eigen::Vector3d normal = normalAt(a) + normalAt(b) + normalAt(c) + normalAt(d);
            for (int t : sides)
            {
              const Eigen::Vector3d face = mesh_.areaNormal(t);
              if (face.dot(normal) < kMaxRotation * face.norm() * normal.norm() ||
                  face.norm() < min_area_ratio_ * whole)
              {
                mesh_.flip(c, d);
                return;
              }
            }
          });
  }

  const Eigen::Vector3d& normalAt(int v) const { return normal_[static_cast<std::size_t>(v)]; }

  /** Tangential smoothing towards the centroid of the adjacent triangles, weighted by area over squared edge length. */
  void relax()
  {
    const int count = mesh_.vertexCount();
    for (int v = 0; v < count; ++v)
    {
      if (!mesh_.aliveVertex(v) || !isFree(v))
        continue;
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      double weights = 0.0;
      for (int t : mesh_.around(v))
      {
        const Eigen::Vector3i& c = mesh_.triangle(t);
        const double local = (targetLength(c[0], c[1]) + targetLength(c[1], c[2]) + targetLength(c[2], c[0])) / 3.0;
        const double weight = mesh_.areaNormal(t).norm() / (local * local);
        middle += weight / 3.0 * (mesh_.position(c[0]) + mesh_.position(c[1]) + mesh_.position(c[2]));
        weights += weight;
      }
      if (!(weights > 0.0))
        continue;
      const Eigen::Vector3d shift = middle / weights - mesh_.position(v);
      const Eigen::Vector3d& n = normalAt(v);
      const TargetPoint target = target_.project(mesh_.position(v) + 0.7 * (shift - shift.dot(n) * n));
      if (target.edge_length > 0.0 && preservesOrientation(v, target))
        place(v, target);
    }
  }

  bool preservesOrientation(int v, const TargetPoint& target) const
  {
    for (int t : mesh_.around(v))
    {
      const Eigen::Vector3d before = mesh_.areaNormal(t);
      const Eigen::Vector3d after = mesh_.areaNormal(t, v, target.position);
      if (after.norm() < min_area_ratio_ * before.norm())
        return false;
      if (after.dot(target.normal) < 0.2 * after.norm() && after.dot(target.normal) < before.dot(normalAt(v)))
        return false;
    }
    return true;
  }

  EditableMesh mesh_;
  const RemeshTarget& target_;
  double min_area_ratio_, min_split_ratio_;
  std::vector<double> edge_length_;
  std::vector<Eigen::Vector3d> normal_;
};

}  // namespace

geometry::TriangleMesh remesh(const geometry::TriangleMesh& mesh, const RemeshTarget& target, int rounds)
{
  return Remesher(mesh, target, {}).run(rounds);
}

geometry::TriangleMesh remeshRegion(const geometry::TriangleMesh& mesh, const RemeshTarget& target,
                                    const std::vector<char>& is_free, int rounds)
{
  return Remesher(mesh, target, is_free).run(rounds);
}

}  // namespace endovascular_sim::vessel
