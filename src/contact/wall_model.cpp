#include "contact/wall_model.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Geometry>

#include "contact/narrow_phase/normal_cone.h"
#include "contact/narrow_phase/smooth_foot.h"
#include "geometry/closest_point_on_triangle.h"

namespace endovascular_sim::contact
{
namespace
{

Bvh::Cone coneOf(const Wall& wall, const WallBounds& bounds, int triangle)
{
  const TriangleSlab& slab = bounds.triangle(triangle);
  Bvh::Cone cone{slab.bulge(), -1.0};
  for (int e : slab.own_edges)
    if (e >= 0)
    {
      const double tilt = angleBetween(wall.normals[triangle], wall.edges[e].normal);
      const double widest = tilt + std::atan(bounds.edge(e).cone_slope);
      cone.reflex_edge = std::max(cone.reflex_edge, coneSlope(widest));
    }
  return cone;
}

}  // namespace

std::shared_ptr<const WallModel> WallModel::create(const geometry::TriangleMesh& mesh, WallShape shape)
{
  return std::shared_ptr<const WallModel>(new WallModel(mesh, shape));
}

WallModel& WallModel::writable(std::shared_ptr<const WallModel>& model)
{
  if (model.use_count() != 1)
    model.reset(new WallModel(*model));
  // Reads by an owner in another thread that has just released the model happen before the caller's writes.
  std::atomic_thread_fence(std::memory_order_acquire);
#ifdef ENDOVASCULAR_SANITIZED
  // The thread sanitizer does not model fences. A copy states the same order to it: the increment of the count is an
  // acquiring operation in libstdc++.
  const std::shared_ptr<const WallModel> acquired = model;
#endif
  return const_cast<WallModel&>(*model);  // models are never created as constant objects
}

WallModel::WallModel(const geometry::TriangleMesh& mesh, WallShape shape) : wall_(mesh), bounds_(wall_), bvh_(wall_)
{
  if (shape == WallShape::kSmooth)
  {
    smooth_ = std::make_unique<const SmoothWall>(wall_);
    bounds_.admitSmoothWall(*smooth_);  // the cones of the tree are open from the start
    return;
  }
  std::vector<Bvh::Cone> cones;
  cones.reserve(wall_.triangles.size());
  for (std::size_t t = 0; t < wall_.triangles.size(); ++t)
    cones.push_back(coneOf(wall_, bounds_, static_cast<int>(t)));
  bvh_.setCones(cones);
}

WallModel::WallModel(const WallModel& other) : wall_(other.wall_), bounds_(other.bounds_), bvh_(other.bvh_, wall_)
{
  if (other.smooth_)
    smooth_ = std::make_unique<const SmoothWall>(*other.smooth_, wall_);
}

double WallModel::signedDistance(const Eigen::Vector3d& point, int hint, int* nearest) const
{
  const Bvh::Nearest found = bvh_.nearest(point, std::numeric_limits<double>::infinity(), hint);
  if (nearest != nullptr)
    *nearest = found.triangle;
  const Eigen::Vector3i& corners = wall_.triangles[found.triangle];
  const geometry::TrianglePoint closest = geometry::closestPointOnTriangle(
      point, wall_.vertices[corners[0]], wall_.vertices[corners[1]], wall_.vertices[corners[2]]);
  const Eigen::Vector3d& normal = closest.vertex >= 0 ? wall_.vertex_normals[corners[closest.vertex]]
                                  : closest.edge >= 0
                                      ? wall_.edges[wall_.triangle_edges[found.triangle][closest.edge]].normal
                                      : wall_.normals[found.triangle];
  const bool is_inside = (point - closest.point).dot(normal) >= 0.0;
  if (smooth_)
    return smoothDistance(point, found, is_inside);
  return is_inside ? found.distance : -found.distance;
}

/** @param nearest the nearest facet: its distance plus the deviation bounds that of the smooth wall
 *  @param is_inside the point's side of the facets, which beyond the deviation is its side of the smooth wall. A walk
 *         can end there at a foot whose normal points to the other side, e.g. across a fold */
double WallModel::smoothDistance(const Eigen::Vector3d& point, const Bvh::Nearest& nearest, bool is_inside) const
{
  const SmoothFootSearch search(*smooth_);
  double height = search.walk(point, nearest.triangle).height;
  if (nearest.distance > smooth_->deviation())
    return is_inside ? std::abs(height) : -std::abs(height);
  std::vector<int> triangles, owners;
  const double reach = std::abs(height) + smooth_->deviation();
  bvh_.collect({point, Eigen::Vector3d::Zero(), reach, 0.0}, {point, Eigen::Vector3d::Zero(), 0.0, 0.0}, triangles,
               owners);
  std::sort(triangles.begin(), triangles.end());
  for (int triangle : triangles)
  {
    if (!smooth_->mayHaveFoot(triangle, bounds_.triangle(triangle).heights(point), std::abs(height)))
      continue;
    const double other = search.walk(point, triangle).height;
    if (std::abs(other) < std::abs(height))
      height = other;
  }
  return height;
}

const NeighbourList::WallMovement& WallModel::moveVertices(const std::vector<int>& indices,
                                                           const std::vector<Eigen::Vector3d>& positions)
{
  if (smooth_)
    throw std::logic_error("a smooth wall does not move");
  movement_.bounds.setEmpty();
  movement_.largest_displacement = 0.0;
  for (std::size_t k = 0; k < indices.size(); ++k)
  {
    movement_.bounds.extend(wall_.vertices[indices[k]]);
    movement_.largest_displacement =
        std::max(movement_.largest_displacement, (positions[k] - wall_.vertices[indices[k]]).norm());
  }
  const Wall::Changes& changes = wall_.moveVertices(indices, positions);
  bounds_.refit(wall_, changes, refit_);
  for (int t : changes.around)
    for (int corner = 0; corner < 3; ++corner)
      movement_.bounds.extend(wall_.vertices[wall_.triangles[t][corner]]);
  bvh_.refit(changes.triangles);
  bvh_.openCones(refit_.first_moved);
  movement_.first = !refit_.first_moved.empty();
  movement_.new_reflex = refit_.new_reflex;
  return movement_;
}

}  // namespace endovascular_sim::contact
