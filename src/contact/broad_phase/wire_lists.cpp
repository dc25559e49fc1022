#include "contact/broad_phase/wire_lists.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kHorizon = 4.0;          // queries before its end in which a list is renewed
constexpr std::size_t kListsAtOnce = 16;  // for which memory is reserved together as the wire enters
constexpr std::size_t kUsualNodes = 512;  // of a wire

/** Index of the node at the other end of the edge behind a node; the tip has no such edge. */
std::size_t nextNode(const Query& query, std::size_t node)
{
  return std::min(node + 1, query.nodes.size() - 1);
}

/** Cutoff of a node's list: the larger one of its edge's ends [m]. */
double listCutoff(const Query& query, std::size_t node, double deviation)
{
  return std::max(cutoffAt(query, node) + deviation, cutoffAt(query, nextNode(query, node)) + deviation);
}

}  // namespace

WireLists::WireLists()
{
  lists_.reserve(kUsualNodes);
}

void WireLists::followWall(const NeighbourList::WallMovement& movement)
{
  for (NeighbourList& list : lists_)
    list.followWall(movement);
}

/** Lists of nodes that have just entered get their memory in groups, so that few steps allocate. */
void WireLists::reserve(std::size_t nodes)
{
  if (nodes <= lists_.size())
    return;
  const std::size_t before = lists_.size();
  lists_.resize((nodes + kListsAtOnce - 1) / kListsAtOnce * kListsAtOnce);
  for (std::size_t k = before; k < lists_.size(); ++k)
    lists_[k].reserve();
}

std::size_t WireLists::update(const Bvh& bvh, const WallBounds& bounds, const Query& query, double deviation)
{
  reserve(query.nodes.size());
  std::size_t built = 0;
  due_.clear();
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
  {
    const Eigen::Vector3d& a = query.nodes[i];
    const Eigen::Vector3d& b = query.nodes[nextNode(query, i)];
    const double cutoff = listCutoff(query, i, deviation);
    NeighbourList& list = listOf(query, i);
    list.follow(a, b, cutoff);
    built += !list.isValid();
    if (list.isValid() && list.queriesLeft() < kHorizon)
      due_.emplace_back(list.queriesLeft(), i);
    list.update(bvh, bounds, a, b, cutoff, scratch_);
  }
  return built + renewDue(bvh, bounds, query, deviation, built);
}

/** Renews some of the lists that expire soon, the nearest ones to their end first. The lists of a wire that is pushed
 *  would otherwise expire together, and one query would pay for all of them. Returns the number of renewed lists. */
std::size_t WireLists::renewDue(const Bvh& bvh, const WallBounds& bounds, const Query& query, double deviation,
                                std::size_t built)
{
  const auto share = static_cast<std::size_t>(std::ceil(static_cast<double>(due_.size()) / kHorizon));
  if (share <= built)
    return 0;
  const auto end = due_.begin() + static_cast<std::ptrdiff_t>(share - built);
  std::partial_sort(due_.begin(), end, due_.end());
  for (auto due = due_.begin(); due != end; ++due)
  {
    const std::size_t i = due->second;
    listOf(query, i).renew(bvh, bounds, query.nodes[i], query.nodes[nextNode(query, i)],
                           listCutoff(query, i, deviation), scratch_);
  }
  return share - built;
}

}  // namespace endovascular_sim::contact
