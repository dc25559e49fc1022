#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "contact/detector.h"

// Lists go with the wire: a node finds what was listed about where it is, whatever number it has by now.

namespace endovascular_sim::contact
{
namespace
{

constexpr std::size_t kFewElsewhere = 4;  // nodes that are elsewhere without others having come or gone
constexpr int kNearby = 3;                // numbers by which a node's may have changed since its neighbour's has

}  // namespace

/** From a place of the segment no farther than that from its begin [m²]. */
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

/** Notes at each node whether its lists still hold. */
void Detector::followWire(const Query& query)
{
  std::size_t elsewhere = 0;
  for (std::size_t index = 0; index < query.nodes.size(); ++index)
  {
    NeighbourList& near = near_[placeFromTip(query, index)];
    followNode(query, index, near);
    elsewhere += near.isHere() ? 0 : 1;
  }
  if (elsewhere > kFewElsewhere)
    handOver(query);
  for (std::size_t place = 0; place < query.nodes.size(); ++place)
    if (!near_[place].holds)
    {
      slideOn(query, place);
      lists_renewed_ += near_[place].holds ? 0 : 1;
    }
}

void Detector::Trail::drop(End end)
{
  first_ = end == End::kRear ? (first_ + 1) % ring_.size() : first_;
  --count_;
}

Detector::NeighbourList& Detector::Trail::extend(End end)
{
  if (count_ == ring_.size())
    drop(end == End::kRear ? End::kFront : End::kRear);
  first_ = end == End::kRear ? (first_ + ring_.size() - 1) % ring_.size() : first_;
  ++count_;
  return at(end);
}

/** A node that has slid out of its lists leaves them to the next one that comes there, and takes those that were left
 *  where it is now. */
void Detector::slideOn(const Query& query, std::size_t place)
{
  NeighbourList& near = near_[place];
  const std::size_t index = query.nodes.size() - 1 - place;
  const double past = near.past(query.nodes[index]);
  if (near.reach == 0.0 || !near.isHere() || (past >= 0.0 && past <= near.reach))
    return;
  const bool forwards = past > 0.0;
  Trail& before = trails_[place];
  Trail& behind = trails_[place + 1];
  NeighbourList& left = forwards ? behind.extend(Trail::End::kFront) : before.extend(Trail::End::kRear);
  std::swap(near, left);
  const bool taken = forwards ? takeOver(query, index, before, Trail::End::kRear, near)
                              : takeOver(query, index, behind, Trail::End::kFront, near);
  if (!taken)
    near.comeAfter(left);
}

/** Lists of a trail that hold where a node is now, if there are any; what it has passed by is lost. */
bool Detector::takeOver(const Query& query, std::size_t index, Trail& trail, Trail::End end, NeighbourList& near)
{
  for (; !trail.empty(); trail.drop(end))
  {
    NeighbourList& there = trail.at(end);
    const double past = there.past(query.nodes[index]);
    const double entered = end == Trail::End::kRear ? past : there.reach - past;
    if (entered < -there.room)
      return false;
    followNode(query, index, there);
    if (!there.holds)
      continue;
    std::swap(near, there);
    trail.drop(end);
    return true;
  }
  return false;
}

/** Where nodes have come or gone, all those behind have other numbers than when they were listed: hands each node the
 *  lists that were made about where it is, if there are any. */
void Detector::handOver(const Query& query)
{
  constexpr std::array<int, 2 * kNearby + 1> kSteps{0, 1, -1, 2, -2, 3, -3};
  near_.swap(left_);
  near_.resize(std::max(near_.size(), left_.size()));
  int shift = 0;
  for (std::size_t index = query.nodes.size(); index-- > 0;)
  {
    const int place = placeFromTip(query, index);
    for (const int step : kSteps)
    {
      const int from = place + shift + step;
      if (from < 0 || from >= static_cast<int>(left_.size()))
        continue;
      NeighbourList& left = left_[from];
      followNode(query, index, left);
      if (!left.isHere())
        continue;
      std::swap(near_[place], left);
      shift += step;
      break;
    }
  }
  // Old lists of the same number still tell about how long the new ones will be.
  for (std::size_t place = 0; place < query.nodes.size(); ++place)
    if (near_[place].limit < 0.0 && left_[place].limit >= 0.0)
    {
      std::swap(near_[place], left_[place]);
      near_[place].holds = false;
    }
  for (NeighbourList& left : left_)
    left.forget();
}

}  // namespace endovascular_sim::contact
