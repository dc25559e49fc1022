#pragma once

#include <vector>

#include "contact/narrow_phase/edge_bounds.h"
#include "contact/narrow_phase/triangle_slab.h"
#include "contact/wall/smooth_wall.h"
#include "contact/wall/wall.h"

namespace endovascular_sim::contact
{

/** Bounds of all triangles and edges of a wall. */
class WallBounds
{
public:
  explicit WallBounds(const Wall& wall);

  const TriangleSlab& triangle(int index) const { return slabs_[index]; }
  const EdgeBounds& edge(int index) const { return edges_[index]; }
  const std::vector<TriangleSlab>& triangles() const { return slabs_; }
  const std::vector<EdgeBounds>& edges() const { return edges_; }

  /** Features whose bounds a movement of the wall has changed in kind. */
  struct Refit
  {
    std::vector<int> first_moved;  ///< triangles that had never moved before
    std::vector<int> new_reflex;   ///< edges that have become reflex
  };
  /** Recomputes the bounds of the changed triangles and edges. */
  void refit(const Wall& wall, const Wall::Changes& changes, Refit& refit);

  /** Makes the bounds hold for a smooth wall: opens all cones, and ends every triangle's reach by its own deviation. */
  void admitSmoothWall(const SmoothWall& smooth);

private:
  std::vector<TriangleSlab> slabs_;
  std::vector<EdgeBounds> edges_;
};

}  // namespace endovascular_sim::contact
