#include <algorithm>

#include "contact/detector.h"

// A wall that moves.

namespace endovascular_sim::contact
{

void Detector::moveVertices(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions,
                            std::uint64_t vessel_version)
{
  vessel_version_ = vessel_version;
  if (indices.empty())
    return;
  Eigen::AlignedBox3d moved;  // holds the triangles before and after, and those around them
  double farthest = 0.0;
  for (std::size_t k = 0; k < indices.size(); ++k)
  {
    moved.extend(wall_.vertices[indices[k]]);
    farthest = std::max(farthest, (positions[k] - wall_.vertices[indices[k]]).norm());
  }
  const Wall::Changes& changes = wall_.moveVertices(indices, positions);
  renewPrisms(changes.around);
  for (int t : changes.around)
    for (int corner = 0; corner < 3; ++corner)
      moved.extend(wall_.vertices[wall_.triangles[t][corner]]);
  renewEdges(changes.edges);
  bvh_.refit(changes.triangles);
  bvh_.openCones(now_moving_);
  keepUp(moved, farthest, !now_moving_.empty());
}

/** Notes those that have never moved before. */
void Detector::renewPrisms(const std::vector<int>& changed)
{
  now_moving_.clear();
  for (int t : changed)
  {
    makePrism(t);
    if (!prisms_[t].has_moved)
      now_moving_.push_back(t);
    prisms_[t].has_moved = true;
  }
}

/** Notes those that have become reflex. */
void Detector::renewEdges(const std::vector<int>& changed)
{
  now_reflex_.clear();
  for (int e : changed)
  {
    const bool was_reflex = edge_balls_[e].reflex;
    edge_balls_[e] = ballOf(wall_.edges[e]);
    if (edge_balls_[e].reflex && !was_reflex)
      now_reflex_.push_back(e);
  }
}

}  // namespace endovascular_sim::contact
