#include "vessel/repair/remesh.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vessel/repair/editable_mesh.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Edges longer or shorter than these multiples of the facet length are split or collapsed. */
constexpr double kLongest = 4.0 / 3.0;
constexpr double kShortest = 4.0 / 5.0;
/** A collapse may turn a face by this much: cosine. */
constexpr double kLargestTurn = 0.5;
/** Guards beside the spikes of a coarse wall, where several points may be projected to one: a face may become this much
 *  smaller, and this is the least piece of an edge that is split. Smooth walls need none. */
constexpr double kLeastArea = 1e-7;
constexpr double kLeastPiece = 0.05;

class Remesher
{
public:
  /** @param takes_part per vertex; empty: all do */
  Remesher(const geometry::TriangleMesh& mesh, const RemeshWall& wall, const std::vector<char>& takes_part)
    : mesh_(mesh),
      wall_(wall),
      least_area_(takes_part.empty() ? 0.0 : kLeastArea),
      least_piece_(takes_part.empty() ? 0.0 : kLeastPiece)
  {
    for (int v = 0; v < mesh_.vertexCount(); ++v)
    {
      facet_.push_back(0.0);
      normal_.emplace_back(Eigen::Vector3d::Zero());
      if (takes_part.empty() || takes_part[static_cast<std::size_t>(v)] != 0)
        project(v, mesh_.position(v));
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
  /** Whether a vertex may be moved: those that stay have no facet length. */
  bool isFree(int v) const { return facet_[static_cast<std::size_t>(v)] > 0.0; }

  double facet(int a, int b) const
  {
    if (!isFree(a) || !isFree(b))
      return std::max(facet_[static_cast<std::size_t>(a)], facet_[static_cast<std::size_t>(b)]);
    return 0.5 * (facet_[static_cast<std::size_t>(a)] + facet_[static_cast<std::size_t>(b)]);
  }

  double length(int a, int b) const { return (mesh_.position(a) - mesh_.position(b)).norm(); }

  WallPoint onWall(const Eigen::Vector3d& p) const { return wall_.onWall(p); }

  void put(int v, const WallPoint& place)
  {
    mesh_.move(v, place.position);
    facet_[static_cast<std::size_t>(v)] = place.facet;
    normal_[static_cast<std::size_t>(v)] = place.normal;
  }

  void project(int v, const Eigen::Vector3d& p) { put(v, onWall(p)); }

  /** Calls edit(a, b) for the edges of all triangles that exist at the beginning, while they exist. */
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
          if ((!isFree(a) && !isFree(b)) || length(a, b) <= kLongest * facet(a, b))
            return;
          const WallPoint middle = onWall(0.5 * (mesh_.position(a) + mesh_.position(b)));
          // Beside a spike of the wall the middle may be the spike itself.
          const auto sides = mesh_.trianglesAt(a, b);
          for (int near : {a, b, mesh_.opposite(sides[0], a, b), mesh_.opposite(sides[1], a, b)})
            if ((middle.position - mesh_.position(near)).norm() < least_piece_ * length(a, b))
              return;
          mesh_.split(a, b, middle.position);
          facet_.push_back(middle.facet);
          normal_.push_back(middle.normal);
        });
  }

  bool collapseIsGood(int a, int b, const WallPoint& middle) const
  {
    for (const auto& [moved, other] : {std::pair<int, int>{a, b}, std::pair<int, int>{b, a}})
    {
      for (int t : mesh_.around(moved))
      {
        if ((mesh_.triangle(t).array() == other).any())
          continue;
        const Eigen::Vector3d before = mesh_.areaNormal(t);
        const Eigen::Vector3d after = mesh_.areaNormal(t, moved, middle.position);
        const bool was_sliver = before.norm() < 1e-3 * middle.facet * middle.facet;
        if (!was_sliver && before.dot(after) < kLargestTurn * before.norm() * after.norm())
          return false;
        if (after.dot(middle.normal) < kLargestTurn * after.norm() || after.norm() < least_area_ * before.norm())
          return false;
      }
      for (int v : mesh_.neighbours(moved))
        if (v != other && (mesh_.position(v) - middle.position).norm() > kLongest * middle.facet)
          return false;
    }
    return true;
  }

  void collapseShortEdges()
  {
    forEdges(
        [this](int a, int b)
        {
          if (!isFree(a) || !isFree(b) || length(a, b) >= kShortest * facet(a, b) || !mesh_.canCollapse(a, b))
            return;
          const WallPoint middle = onWall(0.5 * (mesh_.position(a) + mesh_.position(b)));
          if (!(middle.facet > 0.0) || !collapseIsGood(a, b, middle))
            return;
          mesh_.collapse(a, b, middle.position);
          put(b, middle);
        });
  }

  double angleAt(int apex, int a, int b) const
  {
    const Eigen::Vector3d u = mesh_.position(a) - mesh_.position(apex);
    const Eigen::Vector3d v = mesh_.position(b) - mesh_.position(apex);
    return std::atan2(u.cross(v).norm(), u.dot(v));
  }

  /** Delaunay's criterion, where the new pair of faces agrees with the wall's normals. */
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
              if (face.dot(normal) < kLargestTurn * face.norm() * normal.norm() || face.norm() < least_area_ * whole)
              {
                mesh_.flip(c, d);
                return;
              }
            }
          });
  }

  const Eigen::Vector3d& normalAt(int v) const { return normal_[static_cast<std::size_t>(v)]; }

  /** Moves every vertex along the wall towards the middle of its triangles, weighted by their size in facets. */
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
        const double local = (facet(c[0], c[1]) + facet(c[1], c[2]) + facet(c[2], c[0])) / 3.0;
        const double weight = mesh_.areaNormal(t).norm() / (local * local);
        middle += weight / 3.0 * (mesh_.position(c[0]) + mesh_.position(c[1]) + mesh_.position(c[2]));
        weights += weight;
      }
      if (!(weights > 0.0))
        continue;
      const Eigen::Vector3d shift = middle / weights - mesh_.position(v);
      const Eigen::Vector3d& n = normalAt(v);
      const WallPoint place = onWall(mesh_.position(v) + 0.7 * (shift - shift.dot(n) * n));
      if (place.facet > 0.0 && keepsFacesUpright(v, place))
        put(v, place);
    }
  }

  bool keepsFacesUpright(int v, const WallPoint& place) const
  {
    for (int t : mesh_.around(v))
    {
      const Eigen::Vector3d before = mesh_.areaNormal(t);
      const Eigen::Vector3d after = mesh_.areaNormal(t, v, place.position);
      if (after.norm() < least_area_ * before.norm())
        return false;
      if (after.dot(place.normal) < 0.2 * after.norm() && after.dot(place.normal) < before.dot(normalAt(v)))
        return false;
    }
    return true;
  }

  EditableMesh mesh_;
  const RemeshWall& wall_;
  double least_area_, least_piece_;
  std::vector<double> facet_;
  std::vector<Eigen::Vector3d> normal_;
};

}  // namespace

geometry::TriangleMesh remesh(const geometry::TriangleMesh& mesh, const RemeshWall& wall, int rounds)
{
  return Remesher(mesh, wall, {}).run(rounds);
}

geometry::TriangleMesh remeshPart(const geometry::TriangleMesh& mesh, const RemeshWall& wall,
                                  const std::vector<char>& takes_part, int rounds)
{
  return Remesher(mesh, wall, takes_part).run(rounds);
}

}  // namespace endovascular_sim::vessel
