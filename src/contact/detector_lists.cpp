#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "contact/detector.h"
#include "geometry/closest_points_on_segments.h"

// What the wire may meet soon: lists of what is near, made anew when wire or wall have moved.

namespace endovascular_sim::contact
{
namespace
{

constexpr double kRoom = 0.15e-3;       // m by which wire and wall may come closer before what is near is listed anew
constexpr double kFirstRoom = 0.05e-3;  // m the first time, when lists of the whole wire are made at once
// Where it has left its place by so much more than there was room for, a wire snaps aside: it is soon as far off again.
constexpr double kSnap = 0.06e-3;       // m
constexpr double kRoomToSnap = 0.6e-3;  // m; where lists are long, half of it
constexpr double kSlide = 0.5e-3;       // m more that a wire may slide along itself before, when it is expected to
// The same where walls are so fine that long lists cost more to look through than to take over from the next node.
constexpr double kSlideOfLong = 0.25e-3;
constexpr std::size_t kLong = 8;     // entries of lists that are not yet long
constexpr double kSlides = 0.05e-3;  // m since the last list by which it has slid then
constexpr double kListGuard = 1e-8;  // m by which lists hold more than rounding could miss

/** Less by more than rounding could add. */
float lower(double clearance)
{
  return static_cast<float>(clearance - kListGuard);
}

}  // namespace

/** Lists hold more than what can be met. While wire and wall have moved by less than that, they stay; edges that have
 *  become reflex are added, and those that no longer are stand in them to no effect.
 *  @param anew something moves for the first time, which lists may have left out because of how it was turned */
void Detector::keepUp(const Eigen::AlignedBox3d& moved, double farthest, bool anew)
{
  const auto touches = [&moved](const NeighbourList& near)
  {
    const double half = 0.5 * near.length;
    const double room = near.room - near.wall_moved;
    const double far = half + room + near.limit + near.room + kListGuard;
    return near.limit >= 0.0 && room >= 0.0 && moved.exteriorDistance(near.begin + half * near.along) <= far;
  };
  for (NeighbourList& near : near_)
    if (touches(near))
    {
      near.wall_differs = true;
      near.wall_moved = anew ? near.room : near.wall_moved + farthest;
      for (int e : now_reflex_)
      {
        const auto place = std::lower_bound(near.edges.begin(), near.edges.end(), e,
                                            [](const Near& other, int edge) { return other.index < edge; });
        if (place == near.edges.end() || place->index != e)
          near.edges.insert(place, {e, -std::numeric_limits<float>::infinity()});
      }
    }
}

void Detector::NeighbourList::start(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double wanted)
{
  length = (b - a).norm();
  along = length > 0.0 ? Eigen::Vector3d((b - a) / length) : Eigen::Vector3d::Zero();
  const double slid = limit < 0.0 ? 0.0 : (a - listed_at).dot(along);
  reach = std::abs(slid) > kSlides ? (was_long ? kSlideOfLong : kSlide) : 0.0;
  length += reach;
  begin = slid < 0.0 ? Eigen::Vector3d(a - reach * along) : a;
  listed_at = a;
  const bool snaps = limit >= 0.0 && moved - room > kSnap;
  const double usual = snaps ? (was_long ? 0.5 : 1.0) * kRoomToSnap : kRoom;
  room = limit < 0.0 ? kFirstRoom : usual;
  limit = limit < 0.0 || wanted == limit ? wanted : wanted + 0.5 * kLimitSlack;
  moved = wall_moved = 0.0;
  triangles.clear();
  edges.clear();
}

void Detector::renewLists(const Query& query)
{
  for (std::size_t index = 0; index < query.nodes.size(); ++index)
    if (!neighbourhood(query, index).isUpToDate())
      renewList(query, index, collected_);
}

/** Lists anew what can be met where wire or wall have moved by more than the lists have room for. */
void Detector::renewList(const Query& query, std::size_t index, Collected& collected)
{
  NeighbourList& near = near_[placeFromTip(query, index)];
  if (!near.holds)
  {
    near.start(query.nodes[index], query.nodes[nextNode(query, index)], listedLimit(query, index));
    list(near, collected);
  }
  else if (near.wall_differs)
    pack(near);
}

void Detector::list(NeighbourList& near, Collected& collected) const
{
  const double wide = near.limit + near.room + kListGuard;
  const AxisSegment segment(near.begin, near.end());
  collected.triangles.clear();
  collected.ridged.clear();
  bvh_.collect({near.begin, near.reach * near.along, wide, near.room}, {near.begin, segment.along, wide, near.room},
               collected.triangles, collected.ridged);
  for (int t : collected.triangles)
    listTriangle(t, near);
  for (int t : collected.ridged)
    for (int e : prisms_[t].own_edges)
      if (e >= 0)
        listEdge(e, prisms_[t].has_moved, segment, near);
  // Sorted, so that results do not depend on how the tree is walked.
  const auto by_index = [](const Near& one, const Near& other) { return one.index < other.index; };
  std::sort(near.triangles.begin(), near.triangles.end(), by_index);
  std::sort(near.edges.begin(), near.edges.end(), by_index);
  near.was_long = near.triangles.size() + near.edges.size() > kLong;
  pack(near);
}

/** Lays side by side what is listed. */
void Detector::pack(NeighbourList& near) const
{
  const auto lay = [&near](auto& quads, const std::vector<Near>& listed, const auto& shapes)
  {
    quads.clear();
    for (std::size_t k = 0; k < listed.size(); ++k)
    {
      if (k % kQuad == 0)
        quads.emplace_back();
      quads.back().set(k % kQuad, listed[k].index, shapes[listed[k].index], near.begin, listed[k].clear);
    }
  };
  lay(near.prisms, near.triangles, prisms_);
  lay(near.ridges, near.edges, edge_balls_);
  near.wall_differs = false;
}

/** A triangle that the node may meet. */
void Detector::listTriangle(int triangle, NeighbourList& near) const
{
  const TriangleSlab& prism = prisms_[triangle];
  const Eigen::Array4d first = prism.heights(near.begin);
  const Eigen::Array4d last = near.reach > 0.0 ? prism.heights(near.begin + near.reach * near.along) : first;
  const double low = std::min(first[0], last[0]);
  const double high = std::max(first[0], last[0]);
  // Of the places that the node may have, no more than their distance from the triangle.
  const double beside = std::max(0.0, TriangleSlab::outsideOf(first.max(last)));
  const double height = std::max({0.0, low, -high});
  double clear = std::sqrt(height * height + beside * beside) - near.limit;
  if (!prism.has_moved)
    clear = std::max(clear, coneClearance(low, high, beside, prism.bulge(), near.limit));
  if (clear < near.room + kListGuard)
    near.triangles.push_back({triangle, lower(clear)});
}

/** A ridge that the wire's edge may meet. @param has_moved of the triangle that it belongs to; whatever turns the
 *  ridge's normal cone counts for that */
void Detector::listEdge(int wall_edge, bool has_moved, const AxisSegment& segment, NeighbourList& near) const
{
  const double wide = near.limit + near.room + kListGuard;
  if (!mayContact(segment, wall_edge, wide))
    return;
  const EdgeBounds& ball = edge_balls_[wall_edge];
  double clear = has_moved ? 0.0 : ridgeClearance(ball, segment, near.limit);
  if (clear >= near.room + kListGuard)
    return;
  const geometry::SegmentPair pair =
      geometry::closestPointsOfSegments(segment.begin, segment.end, ball.middle - ball.half, ball.middle + ball.half);
  const Eigen::Vector3d apart =
      segment.begin + pair.first * segment.along - ball.middle - (2.0 * pair.second - 1.0) * ball.half;
  clear = std::max(clear, apart.norm() - near.limit);
  if (clear < near.room + kListGuard)
    near.edges.push_back({wall_edge, lower(clear)});
}

/** By how much places and a wall that does not turn have to come closer before one of them is within a limit and
 *  either in the cone above something or behind it [m]; nowhere else does it count as a local minimum.
 *  @param low, high of the places' heights [m]
 *  @param beside by how much they lie beside it at least [m]
 *  @param slope of the cone, as a tangent to the normal; infinite: any */
double Detector::coneClearance(double low, double high, double beside, double slope, double limit)
{
  if (std::isinf(slope))
    return 0.0;
  // A place that comes closer by m is at most m higher, never higher than the limit, and at most m less far beside.
  const double sideways = std::max(beside - limit * slope, (beside - high * slope) / (1.0 + slope)) - kOffTriangle;
  return std::min(low, sideways);
}

/** coneClearance of a segment's places and a mesh edge. */
double Detector::ridgeClearance(const EdgeBounds& ball, const AxisSegment& segment, double limit)
{
  const Eigen::Vector3d from_begin = segment.begin - ball.middle;
  const Eigen::Vector3d from_end = segment.end - ball.middle;
  const auto range = [&from_begin, &from_end](const Eigen::Vector3d& axis) {
    return std::minmax({from_begin.dot(axis), from_end.dot(axis)});
  };
  const auto apart = [&ball](const std::pair<double, double>& places)
  { return std::max(places.first, -places.second) / ball.half_length; };
  const auto heights = range(ball.normal);
  const double across = apart(range(ball.normal.cross(ball.half)));
  const double along = apart(range(ball.half)) - ball.half_length;
  return coneClearance(heights.first, heights.second, std::max({0.0, across, along}), ball.lean, limit);
}

/** Distance to what a point may touch within a limit, infinite or beyond it where that is nothing [m]. */
double Detector::nearestListed(const NeighbourList& near, const Eigen::Vector3d& point, double limit) const
{
  double nearest = std::numeric_limits<double>::infinity();
  const TrianglePacket::Place place(point, near.begin, limit, near.moved);
  forEachInSight(near.prisms, place, [&](int t) { nearest = std::min(nearest, bvh_.distanceTo(t, point)); });
  return nearest;
}

}  // namespace endovascular_sim::contact
