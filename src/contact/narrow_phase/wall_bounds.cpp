#include "contact/narrow_phase/wall_bounds.h"

#include <limits>

namespace endovascular_sim::contact
{

WallBounds::WallBounds(const Wall& wall)
{
  slabs_.resize(wall.triangles.size());
  for (std::size_t t = 0; t < slabs_.size(); ++t)
    setTriangleSlab(wall, static_cast<int>(t), slabs_[t]);
  edges_.reserve(wall.edges.size());
  for (const WallEdge& edge : wall.edges)
    edges_.push_back(makeEdgeBounds(wall, edge));
}

void WallBounds::admitSmoothWall(const SmoothWall& smooth)
{
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < slabs_.size(); ++t)
  {
    slabs_[t].edge_slope = slabs_[t].corner_slope = infinity;
    slabs_[t].before_cutoff = smooth.deviation() - smooth.deviationOf(static_cast<int>(t));
  }
  for (EdgeBounds& edge : edges_)
    edge.cone_slope = infinity;
}

void WallBounds::refit(const Wall& wall, const Wall::Changes& changes, Refit& refit)
{
  refit.first_moved.clear();
  for (int t : changes.around)
  {
    setTriangleSlab(wall, t, slabs_[t]);
    if (!slabs_[t].has_moved)
      refit.first_moved.push_back(t);
    slabs_[t].has_moved = true;
  }
  refit.new_reflex.clear();
  for (int e : changes.edges)
  {
    const bool was_reflex = edges_[e].reflex;
    edges_[e] = makeEdgeBounds(wall, wall.edges[e]);
    if (edges_[e].reflex && !was_reflex)
      refit.new_reflex.push_back(e);
  }
}

}  // namespace endovascular_sim::contact
