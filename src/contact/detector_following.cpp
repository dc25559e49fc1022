#include <algorithm>
#include <cmath>
#include <cstddef>

#include "contact/detector.h"

// Validity of the neighbour lists: the displacement of the wire since they were built.

namespace endovascular_sim::contact
{

/** Squared distance from a point to the segment up to a distance from its begin [m²]. */
inline double Detector::NeighbourList::squaredDistanceTo(const Eigen::Vector3d& point, double farthest) const
{
  const Eigen::Vector3d from = point - begin;
  return (from - std::max(0.0, std::min(farthest, from.dot(along))) * along).squaredNorm();
}

inline void Detector::NeighbourList::follow(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double wanted)
{
  // The distance to a segment is convex: between the edge's ends it is no larger than at them.
  moved = std::sqrt(std::max(squaredDistanceTo(a, reach), squaredDistanceTo(b, length))) + wall_moved;
  holds = moved < room && wanted <= limit && wanted >= limit - kLimitKept;
}

inline void Detector::followNode(const Query& query, std::size_t index, NeighbourList& near)
{
  near.follow(query.nodes[index], query.nodes[nextNode(query, index)], listedLimit(query, index));
}

/** Updates the validity of every node's lists. */
void Detector::followWire(const Query& query)
{
  for (std::size_t index = 0; index < query.nodes.size(); ++index)
    followNode(query, index, near_[placeFromTip(query, index)]);
}

}  // namespace endovascular_sim::contact
