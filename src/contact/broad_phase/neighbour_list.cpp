#include "contact/broad_phase/neighbour_list.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/closest_points_on_segments.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kSkin = 0.15e-3;       // m
constexpr double kFirstSkin = 0.05e-3;  // m, of a node's first list: those of the whole wire are built at once
// A node whose displacement exceeds the skin by kSnap since the last query moves in a snap-through. It will move as far
// again in the next queries and gets a larger skin.
constexpr double kSnap = 0.06e-3;             // m
constexpr double kSnapSkin = 0.6e-3;          // m; half of it for long lists
constexpr double kSlide = 0.5e-3;             // m: interval along the wire for a node that slides
constexpr double kSlideOfLongList = 0.25e-3;  // m: on fine meshes long lists cost more to search than to rebuild
constexpr double kSlides = 0.05e-3;           // m along the wire since the last rebuild from which a node slides
constexpr std::size_t kLong = 8;              // entries above which a list is long
constexpr double kCutoffSlack = 0.1e-3;       // m: half of it is added to a cutoff that changes, as a balloon's does
// Largest excess of a list's cutoff over the needed one [m]. It is larger than the widening of the cutoff at a fast
// node, so the list remains valid when the node slows down.
constexpr double kCutoffExcess = 0.6e-3;
constexpr double kListGuard = 1e-8;        // m: exceeds all rounding errors of distances
constexpr std::size_t kUsualEntries = 16;  // of a list

/** Single-precision clearance below the exact one by more than rounding errors. */
float roundedDown(double clearance)
{
  return static_cast<float>(clearance - kListGuard);
}

/** A segment in which an edge of the wire lies. */
struct AxisSegment
{
  AxisSegment(const Eigen::Vector3d& from, const Eigen::Vector3d& to) : begin(from), end(to), along(to - from)
  {
    const double squared = along.squaredNorm();
    if (squared > 0.0)
      inverse_square = 1.0 / squared;
  }

  Eigen::Vector3d begin, end, along;  ///< along: end − begin
  double inverse_square = 0.0;        ///< of its length [1/m²]; 0 for a point
};

/** Cheap rejection test: whether a reflex mesh edge may come within a cutoff of a segment. A segment whose ends are
 *  both higher above the mesh edge than the cutoff is higher everywhere. */
bool mayContact(const AxisSegment& segment, const EdgeBounds& bounds, double cutoff)
{
  if (!bounds.reflex)
    return false;
  const Eigen::Vector3d from_begin = segment.begin - bounds.middle;
  const Eigen::Vector3d from_end = segment.end - bounds.middle;
  if (from_begin.dot(bounds.normal) > cutoff && from_end.dot(bounds.normal) > cutoff)
    return false;
  const double t = geometry::clampedParameter(-from_begin.dot(segment.along) * segment.inverse_square);
  const double far = cutoff + bounds.half_length;
  return (from_begin + t * segment.along).squaredNorm() <= far * far;
}

/** Displacement before a point within the cutoff can lie in a normal cone or behind its feature, for a feature that
 *  does not turn. There is no local minimum elsewhere [m].
 *  @param low, high bounds of the points' heights [m]
 *  @param beside lower bound of the points' lateral distances from the feature [m]
 *  @param slope tangent of the cone's half angle; infinite: unbounded */
double coneClearance(double low, double high, double beside, double slope, double cutoff)
{
  if (std::isinf(slope))
    return 0.0;
  // A displacement m raises a point by at most m, never above the cutoff, and reduces its lateral distance by at most
  // m.
  const double sideways = std::max(beside - cutoff * slope, (beside - high * slope) / (1.0 + slope)) - kOffTriangle;
  return std::min(low, sideways);
}

/** coneClearance for the points of a segment and a mesh edge. */
double edgeConeClearance(const EdgeBounds& bounds, const AxisSegment& segment, double cutoff)
{
  const Eigen::Vector3d from_begin = segment.begin - bounds.middle;
  const Eigen::Vector3d from_end = segment.end - bounds.middle;
  const auto range = [&from_begin, &from_end](const Eigen::Vector3d& axis) {
    return std::minmax({from_begin.dot(axis), from_end.dot(axis)});
  };
  const auto apart = [&bounds](const std::pair<double, double>& coordinates)
  { return std::max(coordinates.first, -coordinates.second) / bounds.half_length; };
  const auto heights = range(bounds.normal);
  const double across = apart(range(bounds.normal.cross(bounds.half)));
  const double along = apart(range(bounds.half)) - bounds.half_length;
  return coneClearance(heights.first, heights.second, std::max({0.0, across, along}), bounds.cone_slope, cutoff);
}

/** Displacement of wire and wall below which a triangle cannot be a contact of the node [m].
 *  @param begin, end ends of the interval in which the node may lie [m] */
double triangleClearance(const TriangleSlab& slab, const Eigen::Vector3d& begin, const Eigen::Vector3d& end,
                         double cutoff)
{
  const Eigen::Array4d first = slab.heights(begin);
  const Eigen::Array4d last = slab.heights(end);
  const double low = std::min(first[0], last[0]);
  const double high = std::max(first[0], last[0]);
  // Lower bound of the lateral distance over the interval.
  const double beside = std::max(0.0, TriangleSlab::distanceBeyond(first.max(last)));
  const double height = std::max({0.0, low, -high});
  const double clearance = std::sqrt(height * height + beside * beside) - (cutoff - slab.before_cutoff);
  return slab.has_moved ? clearance : std::max(clearance, coneClearance(low, high, beside, slab.bulge(), cutoff));
}

/** Displacement of wire and wall below which a reflex edge cannot be a contact of the wire's edge; infinite for
 *  clearances above the skin that need not be exact [m].
 *  @param has_moved whether the edge's owner has ever moved; every movement that turns the edge's cone sets it */
double edgeClearance(const EdgeBounds& bounds, bool has_moved, const AxisSegment& segment, double cutoff, double skin)
{
  const double infinity = std::numeric_limits<double>::infinity();
  if (!mayContact(segment, bounds, cutoff + skin + kListGuard))
    return infinity;
  const double clearance = has_moved ? 0.0 : edgeConeClearance(bounds, segment, cutoff);
  if (clearance >= skin + kListGuard)
    return infinity;
  const geometry::SegmentPair pair = geometry::closestPointsOfSegments(
      segment.begin, segment.end, bounds.middle - bounds.half, bounds.middle + bounds.half);
  const Eigen::Vector3d apart =
      segment.begin + pair.first * segment.along - bounds.middle - (2.0 * pair.second - 1.0) * bounds.half;
  return std::max(clearance, apart.norm() - cutoff);
}

}  // namespace

void NeighbourList::reserve()
{
  // Resized first, so that the memory is touched here and not in the first steps.
  const auto touch = [](auto& list, std::size_t count)
  {
    list.resize(count);
    list.clear();
  };
  touch(triangles_, kUsualEntries);
  touch(edges_, kUsualEntries);
  touch(triangle_packets_, kUsualEntries / kPacketSize);
  touch(edge_packets_, kUsualEntries / kPacketSize);
}

/** Squared distance from a point to the part of the segment up to a distance from its begin [m²]. */
inline double NeighbourList::squaredDistanceTo(const Eigen::Vector3d& point, double farthest) const
{
  const Eigen::Vector3d from = point - begin_;
  return (from - std::max(0.0, std::min(farthest, from.dot(along_))) * along_).squaredNorm();
}

void NeighbourList::follow(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double cutoff)
{
  // The distance to a segment is convex: between the edge's ends it is at most the larger of theirs.
  const double before = displacement_;
  displacement_ = std::sqrt(std::max(squaredDistanceTo(a, slide_), squaredDistanceTo(b, length_))) + wall_displacement_;
  growth_ = displacement_ - before;
  valid_ = displacement_ < skin_ && cutoff <= cutoff_ && cutoff >= cutoff_ - kCutoffExcess;
}

double NeighbourList::queriesLeft() const
{
  return growth_ > 0.0 ? (skin_ - displacement_) / growth_ : std::numeric_limits<double>::infinity();
}

void NeighbourList::followWall(const WallMovement& movement)
{
  const double half = 0.5 * length_;
  const double left = skin_ - wall_displacement_;
  const double far = half + left + cutoff_ + skin_ + kListGuard;
  if (cutoff_ < 0.0 || left < 0.0 || movement.bounds.exteriorDistance(begin_ + half * along_) > far)
    return;
  packets_outdated_ = true;
  wall_displacement_ = movement.first ? skin_ : wall_displacement_ + movement.largest_displacement;
  for (int e : movement.new_reflex)
  {
    const auto at = std::lower_bound(edges_.begin(), edges_.end(), e,
                                     [](const Entry& entry, int edge) { return entry.index < edge; });
    if (at == edges_.end() || at->index != e)
      edges_.insert(at, {e, -std::numeric_limits<float>::infinity()});
  }
}

void NeighbourList::update(const Bvh& bvh, const WallBounds& bounds, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           double cutoff, Scratch& scratch)
{
  if (!valid_)
    renew(bvh, bounds, a, b, cutoff, scratch);
  else if (packets_outdated_)
    pack(bounds);
}

void NeighbourList::renew(const Bvh& bvh, const WallBounds& bounds, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          double cutoff, Scratch& scratch)
{
  start(a, b, cutoff);
  rebuild(bvh, bounds, scratch);
}

/** Chooses the segment, the cutoff and the skin of a new list by the wire's motion since the last one. */
void NeighbourList::start(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double cutoff)
{
  const bool first = cutoff_ < 0.0;
  length_ = (b - a).norm();
  along_ = length_ > 0.0 ? Eigen::Vector3d((b - a) / length_) : Eigen::Vector3d::Zero();
  const double slid = first ? 0.0 : (a - built_at_).dot(along_);
  slide_ = std::abs(slid) > kSlides ? (was_long_ ? kSlideOfLongList : kSlide) : 0.0;
  length_ += slide_;
  begin_ = slid < 0.0 ? Eigen::Vector3d(a - slide_ * along_) : a;
  built_at_ = a;
  const bool snaps = !first && displacement_ - skin_ > kSnap;
  const double usual = snaps ? (was_long_ ? 0.5 : 1.0) * kSnapSkin : kSkin;
  skin_ = first ? kFirstSkin : usual;
  cutoff_ = first || cutoff == cutoff_ ? cutoff : cutoff + 0.5 * kCutoffSlack;
  displacement_ = wall_displacement_ = growth_ = 0.0;
  triangles_.clear();
  edges_.clear();
}

void NeighbourList::rebuild(const Bvh& bvh, const WallBounds& bounds, Scratch& scratch)
{
  const double reach = cutoff_ + skin_ + kListGuard;
  const Eigen::Vector3d last_begin = begin_ + slide_ * along_;
  const AxisSegment segment(begin_, begin_ + length_ * along_);
  scratch.triangles.clear();
  scratch.owners.clear();
  bvh.collect({begin_, slide_ * along_, reach, skin_}, {begin_, segment.along, reach, skin_}, scratch.triangles,
              scratch.owners);
  const auto add = [this](int index, double clearance, std::vector<Entry>& entries)
  {
    if (clearance < skin_ + kListGuard)
      entries.push_back({index, roundedDown(clearance)});
  };
  for (int t : scratch.triangles)
    add(t, triangleClearance(bounds.triangle(t), begin_, last_begin, cutoff_), triangles_);
  for (int t : scratch.owners)
    for (int e : bounds.triangle(t).own_edges)
      if (e >= 0)
        add(e,
            edgeClearance(bounds.edge(e), bounds.triangle(t).has_moved, segment,
                          cutoff_ - bounds.triangle(t).before_cutoff, skin_),
            edges_);
  // Sorted, so that results do not depend on the order of the tree's traversal.
  const auto by_index = [](const Entry& one, const Entry& other) { return one.index < other.index; };
  std::sort(triangles_.begin(), triangles_.end(), by_index);
  std::sort(edges_.begin(), edges_.end(), by_index);
  was_long_ = triangles_.size() + edges_.size() > kLong;
  pack(bounds);
}

void NeighbourList::pack(const WallBounds& bounds)
{
  const auto pack = [this](auto& packets, const std::vector<Entry>& entries, const auto& shapes, const auto& clearance)
  {
    packets.clear();
    for (std::size_t k = 0; k < entries.size(); ++k)
    {
      if (k % kPacketSize == 0)
        packets.emplace_back();
      const auto& shape = shapes[entries[k].index];
      packets.back().set(k % kPacketSize, entries[k].index, shape, begin_, clearance(shape, entries[k].clearance));
    }
  };
  pack(triangle_packets_, triangles_, bounds.triangles(),
       [](const TriangleSlab& /*slab*/, float clearance) { return clearance; });
  pack(edge_packets_, edges_, bounds.edges(),
       [](const EdgeBounds& edge, float clearance) { return edge.reflex ? clearance : kNeverReached; });
  packets_outdated_ = false;
}

}  // namespace endovascular_sim::contact
