#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "contact/broad_phase/neighbour_list.h"
#include "contact/contract/contact_set.h"

namespace endovascular_sim::contact
{

/** Neighbour lists of a wire: one per node and the edge behind it. */
class WireLists
{
public:
  WireLists();

  /** Updates the lists of all nodes. Results of a search do not depend on earlier queries.
   *  @param deviation largest distance of the wall from its facets; it is added to every cutoff [m]
   *  @return number of lists that were built */
  std::size_t update(const Bvh& bvh, const WallBounds& bounds, const Query& query, double deviation);

  /** Accounts for a movement of the wall. */
  void followWall(const NeighbourList::WallMovement& movement);

  /** List of a node and the edge behind it. Lists are indexed from the tip: nodes that enter or leave at the proximal
   *  end change no other node's list. */
  const NeighbourList& of(const Query& query, std::size_t node) const { return lists_[query.nodes.size() - 1 - node]; }

private:
  NeighbourList& listOf(const Query& query, std::size_t node) { return lists_[query.nodes.size() - 1 - node]; }
  void reserve(std::size_t nodes);
  std::size_t renewDue(const Bvh& bvh, const WallBounds& bounds, const Query& query, double deviation,
                       std::size_t built);

  std::vector<NeighbourList> lists_;  ///< per node, from the tip
  NeighbourList::Scratch scratch_;
  std::vector<std::pair<double, std::size_t>> due_;  ///< remaining queries and node of the lists that expire soon
};

/** Distance from the axis up to which features of a node are needed [m]. */
inline double cutoffAt(const Query& query, std::size_t node)
{
  return query.radius[node] + query.margin[node];
}

}  // namespace endovascular_sim::contact
