#include <algorithm>
#include <array>
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

/** From the tip, so that nodes that come and go at the wire's other end change nothing. */
int Detector::placeFromTip(const Query& query, std::size_t index)
{
  return static_cast<int>(query.nodes.size() - 1 - index);
}

/** The other end of the edge behind a node; the tip has none. */
std::size_t Detector::nextNode(const Query& query, std::size_t index)
{
  return std::min(index + 1, query.nodes.size() - 1);
}

/** Distance up to which features of a node and the edge behind it are wanted [m]. */
double Detector::listedLimit(const Query& query, std::size_t index)
{
  const std::size_t next = nextNode(query, index);
  return std::max(query.radius[index] + query.marginAt(index), query.radius[next] + query.marginAt(next));
}

void Detector::followNode(const Query& query, std::size_t index, Neighbourhood& near)
{
  near.follow(query.nodes[index], query.nodes[nextNode(query, index)], listedLimit(query, index));
}

/** Notes at each node whether its lists still hold. */
void Detector::followWire(const Query& query)
{
  std::size_t elsewhere = 0;
  for (std::size_t index = 0; index < query.nodes.size(); ++index)
  {
    Neighbourhood& near = near_[placeFromTip(query, index)];
    followNode(query, index, near);
    elsewhere += near.isHere() ? 0 : 1;
  }
  if (elsewhere > kFewElsewhere)
    handOver(query);
  for (std::size_t place = 0; place < query.nodes.size(); ++place)
    lists_renewed_ += near_[place].holds ? 0 : 1;
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
      Neighbourhood& left = left_[from];
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
  for (Neighbourhood& left : left_)
    left.forget();
}

}  // namespace endovascular_sim::contact
