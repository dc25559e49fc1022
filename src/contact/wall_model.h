#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "contact/broad_phase/bvh.h"
#include "contact/broad_phase/neighbour_list.h"
#include "contact/narrow_phase/narrow_phase.h"
#include "contact/narrow_phase/wall_bounds.h"
#include "contact/wall/smooth_wall.h"
#include "contact/wall/wall.h"
#include "contact/wall/wall_law.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::contact
{

/** A vessel's wall prepared for contact detection: adjacency, normals and curvature, bounds of its features, bounding
 *  volume hierarchy.
 *
 *  A model is constant once it is shared: any number of detectors, also in different threads, search the same model. A
 *  detector that moves the wall writes to a model of its own, see writable(). */
class WallModel
{
public:
  /** @param mesh watertight and oriented, normals out of the lumen */
  static std::shared_ptr<const WallModel> create(const geometry::TriangleMesh& mesh,
                                                 WallShape shape = WallShape::kFacets);

  /** Copy on write: gives access to a model that no other owner holds.
   *  @param model replaced by a copy if it is shared; a model without another owner is not copied */
  static WallModel& writable(std::shared_ptr<const WallModel>& model);

  WallModel& operator=(const WallModel&) = delete;

  const Wall& wall() const { return wall_; }
  const WallBounds& bounds() const { return bounds_; }
  const Bvh& bvh() const { return bvh_; }
  /** The smooth surface; null for a wall of facets. */
  const SmoothWall* smooth() const { return smooth_.get(); }
  /** Bound of the distance between the wall and its facets [m]; 0 for a wall of facets. */
  double deviation() const { return smooth_ ? smooth_->deviation() : 0.0; }
  NarrowPhase narrowPhase() const { return NarrowPhase(wall_, bounds_); }

  /** Signed distance from a point to the wall, positive inside the lumen [m]. For a smooth wall that of the nearest
   *  foot; beyond the wall's deviation from its facets, that of the foot reached from the nearest facet.
   *  @param hint triangle to start the search with, or −1; the result does not depend on it
   *  @param nearest receives the nearest triangle, unless it is null */
  double signedDistance(const Eigen::Vector3d& point, int hint = -1, int* nearest = nullptr) const;

  /** Moves vertices and refits everything. The model is afterwards, bit for bit, that of the moved mesh, but for the
   *  tree's topology and its cones, which no result depends on. The cost depends on the number of moved vertices only.
   *  @pre the wall is one of facets
   *  @param indices distinct vertices of the mesh
   *  @param positions new positions, one per index [m]
   *  @return the movement as neighbour lists need it; valid until the next call */
  const NeighbourList::WallMovement& moveVertices(const std::vector<int>& indices,
                                                  const std::vector<Eigen::Vector3d>& positions);

private:
  WallModel(const geometry::TriangleMesh& mesh, WallShape shape);
  WallModel(const WallModel& other);
  double smoothDistance(const Eigen::Vector3d& point, const Bvh::Nearest& nearest, bool is_inside) const;

  Wall wall_;
  WallBounds bounds_;
  Bvh bvh_;
  std::unique_ptr<const SmoothWall> smooth_;
  WallBounds::Refit refit_;
  NeighbourList::WallMovement movement_;
};

}  // namespace endovascular_sim::contact
