#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "contact/wall.h"

namespace endovascular_sim::contact
{

/** Bounding volume hierarchy of 18-DOPs over the wall's triangles.
 *
 *  FCL builds the tree; the walk is ours: FCL's own sphere query copies and refits the whole model on every call and
 *  reports no depth for it (docs/CONTACT.md). */
class Bvh
{
public:
  explicit Bvh(const Wall& wall);
  ~Bvh();
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;

  /** Appends every triangle whose 18-DOP is closer than @p radius to the point: a superset of those in the ball. */
  void collect(const Eigen::Vector3d& point, double radius, std::vector<int>& triangles) const;

  /** The triangle nearest to a point. */
  struct Nearest
  {
    int triangle = -1;      ///< −1 when none is closer than the given distance
    double distance = 0.0;  ///< [m]
  };
  Nearest nearest(const Eigen::Vector3d& point, double max_distance) const;

private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
  const Wall* wall_;
};

}  // namespace endovascular_sim::contact
