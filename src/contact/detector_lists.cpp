#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "contact/detector.h"
#include "contact/segment_pair.h"

// What the wire may meet soon: lists of what is near, made anew when wire or wall have moved.

namespace endovascular_sim::contact
{
namespace
{

constexpr double kRoom = 0.25e-3;  // m by which wire and wall may come closer before what is near is listed anew
// m by which the distance that is wanted may fall short of the one that was listed, where it changes (a balloon does).
constexpr double kLimitSlack = 0.1e-3;
constexpr std::size_t kUsual = 16;   // entries of a list
constexpr double kListGuard = 1e-8;  // m by which lists hold more than rounding could miss

/** How far wire and wall may come closer before something at a distance is within a limit, rounded down [m]. */
float clearance(double distance, double limit)
{
  return static_cast<float>(distance - limit - kListGuard);
}

}  // namespace

/** From the tip, so that nodes that come and go at the wire's other end change nothing. */
int Detector::placeFromTip(const Query& query, std::size_t index)
{
  return static_cast<int>(query.nodes.size() - 1 - index);
}

/** Lists hold more than what can be met. While wire and wall have moved by less than that, they stay; edges that have
 *  become reflex are added, and those that no longer are stand in them to no effect. */
void Detector::keepUp(const Eigen::AlignedBox3d& moved, double farthest)
{
  const auto touches = [&moved](const Neighbourhood& near)
  {
    const double half = 0.5 * (near.end - near.begin).norm();
    const double room = kRoom - near.wall_moved;
    const double far = half + room + near.limit + kRoom + kListGuard;
    return near.limit >= 0.0 && room >= 0.0 && moved.exteriorDistance(0.5 * (near.begin + near.end)) <= far;
  };
  for (Neighbourhood& near : near_)
    if (touches(near))
    {
      near.wall_moved += farthest;
      for (int e : now_reflex_)
      {
        const auto place = std::lower_bound(near.edges.begin(), near.edges.end(), e,
                                            [](const Near& other, int edge) { return other.index < edge; });
        if (place == near.edges.end() || place->index != e)
          near.edges.insert(place, {e, -std::numeric_limits<float>::infinity()});
      }
    }
}

void Detector::makeRoom(const Query& query)
{
  while (near_.size() < query.nodes.size())
  {
    near_.emplace_back();
    near_.back().triangles.reserve(kUsual);
    near_.back().edges.reserve(kUsual);
  }
}

bool Detector::Neighbourhood::follows(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double wanted)
{
  const double wire_moved = std::sqrt(std::max((a - begin).squaredNorm(), (b - end).squaredNorm()));
  moved = wire_moved + wall_moved;
  return moved < kRoom && wanted <= limit && wanted >= limit - kLimitSlack;
}

void Detector::Neighbourhood::start(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double wanted)
{
  begin = a;
  end = b;
  limit = limit < 0.0 || wanted == limit ? wanted : wanted + 0.5 * kLimitSlack;
  moved = wall_moved = 0.0;
  triangles.clear();
  edges.clear();
}

/** Of a node and the wire's edge that begins there; the tip has none. */
const Detector::Neighbourhood& Detector::neighbourhood(const Query& query, std::size_t index)
{
  const std::size_t next = std::min(index + 1, query.nodes.size() - 1);
  const double limit = std::max(query.radius[index], query.radius[next]) + query.margin;
  Neighbourhood& near = near_[placeFromTip(query, index)];
  if (!near.follows(query.nodes[index], query.nodes[next], limit))
  {
    near.start(query.nodes[index], query.nodes[next], limit);
    list(near);
  }
  return near;
}

void Detector::list(Neighbourhood& near)
{
  const double wide = near.limit + kRoom + kListGuard;
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(wide);
  collected_.clear();
  bvh_.collectBox(near.begin.cwiseMin(near.end) - around, near.begin.cwiseMax(near.end) + around, collected_);
  for (int t : collected_)
  {
    const Eigen::Array4d above = prisms_[t].heights(near.begin);
    const double end_height = prisms_[t].heights(near.end)[0];
    if (std::min(above[0], end_height) > wide || std::max(above[0], end_height) < -wide)
      continue;
    const double beyond = std::max(0.0, outsideOf(above));
    const double distance = std::sqrt(above[0] * above[0] + beyond * beyond);  // or less
    if (distance <= wide)
      near.triangles.push_back({t, clearance(distance, near.limit)});
    listEdges(t, near, wide);
  }
  // Sorted, so that results do not depend on how the tree is walked.
  const auto by_index = [](const Near& one, const Near& other) { return one.index < other.index; };
  std::sort(near.triangles.begin(), near.triangles.end(), by_index);
  std::sort(near.edges.begin(), near.edges.end(), by_index);
}

void Detector::listEdges(int triangle, Neighbourhood& near, double wide) const
{
  const Eigen::Vector3d along = near.end - near.begin;
  for (int e : prisms_[triangle].own_edges)
  {
    if (e < 0 || !canMeet(near.begin, near.end, e, wide, wide))
      continue;
    const Eigen::Vector3d& end0 = wall_.vertices[wall_.edges[e].vertices[0]];
    const Eigen::Vector3d& end1 = wall_.vertices[wall_.edges[e].vertices[1]];
    const SegmentPair pair = closestPointsOfSegments(near.begin, near.end, end0, end1);
    const Eigen::Vector3d apart = near.begin + pair.first * along - end0 - pair.second * (end1 - end0);
    const double distance = apart.norm();
    if (distance <= wide)
      near.edges.push_back({e, clearance(distance, near.limit)});
  }
}

double Detector::nearestListed(const Neighbourhood& near, const Eigen::Vector3d& point) const
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const Near& one : near.triangles)
    nearest = std::min(nearest, bvh_.distanceTo(one.index, point));
  return nearest;
}

}  // namespace endovascular_sim::contact
