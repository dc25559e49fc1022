#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include "contact/broad_phase/bvh.h"

// Normal cones of the tree and the query that uses them.

namespace endovascular_sim::contact
{
namespace
{

constexpr std::size_t kBatch = 128;        // triangles that are appended at once
constexpr float kFarOff = 1e3F;            // m
constexpr float kOpen = 1e6F;              // tangent of an unbounded cone
constexpr double kWidestCone = 1.2;        // rad: wider cones are opened
constexpr double kConeRounding = 1e-4;     // rad
constexpr float kPointRounding = 0.5e-6F;  // m
constexpr float kSquareRounding = 1e-5F;   // of squared distances
constexpr std::uint8_t kAllLanes = 0xF;
constexpr float kWideBox = 1.2e-3F;  // m: cones of boxes with a larger radius seldom cull

/** Tangent of a cone widened by an angle [rad]; infinite: unbounded. */
double widened(double tangent, double angle)
{
  const double whole = std::atan(tangent) + angle;
  return whole > kWidestCone ? std::numeric_limits<double>::infinity() : std::tan(whole);
}

float laneTangent(double tangent)
{
  const double rounded = tangent < 0.0 ? -1.0 : widened(tangent, kConeRounding);
  return std::isinf(rounded) ? kOpen : static_cast<float>(rounded);
}

}  // namespace

void Bvh::openAllCones()
{
  Cones open;
  for (Lanes& axis : open.axis)
    axis.setZero();
  open.radius.setZero();
  open.bottom.setConstant(kFarOff);
  open.top.setConstant(-kFarOff);
  open.facet.setConstant(kOpen);
  open.reflex_edge.setConstant(kOpen);
  cones_.assign(nodes_.size(), open);
  has_cones_.assign(nodes_.size(), 0);
  reflex_lanes_.assign(nodes_.size(), kAllLanes);
}

void Bvh::setCone(Slot slot, const Eigen::Vector3d& axis, const Cone& cone)
{
  Cones& cones = cones_[slot.node];
  for (int k = 0; k < 3; ++k)
    cones.axis[k][slot.lane] = static_cast<float>(axis[k]);
  cones.facet[slot.lane] = laneTangent(cone.facet);
  cones.reflex_edge[slot.lane] = laneTangent(cone.reflex_edge);
  if (cone.reflex_edge < 0.0)
    reflex_lanes_[slot.node] &= static_cast<std::uint8_t>(~(1U << slot.lane));
}

void Bvh::setCones(const std::vector<Cone>& cones)
{
  openAllCones();
  for (std::size_t t = 0; t < cones.size(); ++t)
    setCone(slot_of_[t], wall_->normals[t], cones[t]);
  for (int n = static_cast<int>(nodes_.size()) - 1; n > 0; --n)
    widenCone(n);
  for (int t = 0; t < static_cast<int>(cones.size()); ++t)
    for (Slot slot = slot_of_[t]; slot.node >= 0; slot = above_[slot.node])
      enclose(t, slot);
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    has_cones_[n] = (cones_[n].radius < kWideBox && cones_[n].facet < kOpen).any() ? 1 : 0;
}

/** Widens the cylinder around a cone's axis so that it contains a triangle. */
void Bvh::enclose(int triangle, Slot slot)
{
  const Node& node = nodes_[slot.node];
  Cones& cones = cones_[slot.node];
  const int lane = slot.lane;
  for (int vertex : wall_->triangles[triangle])
  {
    double height = 0.0;
    double squared = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      const double from = wall_->vertices[vertex][k] - 0.5F * (node.low[k][lane] + node.high[k][lane]);
      height += from * cones.axis[k][lane];
      squared += from * from;
    }
    const double beside = std::sqrt(std::max(0.0, squared - height * height));
    cones.radius[lane] = std::max(cones.radius[lane], static_cast<float>(beside) + kPointRounding);
    cones.bottom[lane] = std::min(cones.bottom[lane], static_cast<float>(height) - kPointRounding);
    cones.top[lane] = std::max(cones.top[lane], static_cast<float>(height) + kPointRounding);
  }
}

/** Sets the cone of a node's slot in its parent to the union of the node's cones. */
void Bvh::widenCone(int index)
{
  const Node& node = nodes_[index];
  const Cones& cones = cones_[index];
  const auto axisOf = [&cones](int lane)
  { return Eigen::Vector3d(cones.axis[0][lane], cones.axis[1][lane], cones.axis[2][lane]); };
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  for (int lane = 0; lane < kWidth; ++lane)
    axis += axisOf(lane);
  axis.normalize();
  Cone cone{0.0, -1.0};
  for (int lane = 0; lane < kWidth; ++lane)
  {
    if (node.low[0][lane] > node.high[0][lane])
      continue;
    const double tilt = angleBetween(axis, axisOf(lane).normalized());
    cone.facet = std::max(cone.facet, widened(cones.facet[lane], tilt));
    if (ownsReflexEdge(index, lane))
      cone.reflex_edge = std::max(cone.reflex_edge, widened(cones.reflex_edge[lane], tilt));
  }
  setCone(above_[index], axis, cone);
}

void Bvh::openCones(const std::vector<int>& triangles)
{
  for (int t : triangles)
    for (Slot slot = slot_of_[t]; slot.node >= 0; slot = above_[slot.node])
    {
      cones_[slot.node].facet[slot.lane] = cones_[slot.node].reflex_edge[slot.lane] = kOpen;
      reflex_lanes_[slot.node] |= static_cast<std::uint8_t>(1U << slot.lane);
    }
}

struct Bvh::SegmentTest
{
  explicit SegmentTest(const QuerySegment& segment)
    : box(segment.begin.cwiseMin(segment.begin + segment.along) - Eigen::Vector3d::Constant(segment.cutoff),
          segment.begin.cwiseMax(segment.begin + segment.along) + Eigen::Vector3d::Constant(segment.cutoff)),
      cutoff(static_cast<float>(segment.cutoff) + kPointRounding),
      skin(static_cast<float>(segment.skin) + kPointRounding)
  {
    for (int k = 0; k < 3; ++k)
    {
      begin[k] = static_cast<float>(segment.begin[k]);
      along[k] = static_cast<float>(segment.along[k]);
    }
    squared = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];
  }

  /** Positive for boxes beyond the cutoff. */
  EIGEN_STRONG_INLINE Lanes apart(const Node& node) const
  {
    return gaps(node, box, 0).max(gaps(node, box, 1)).max(gaps(node, box, 2));
  }

  /** Positive for boxes that contain no closest feature: all points of the segment, wherever displaced within the skin,
   *  lie in front of the box (no normal there is tilted off the axis by more than the cone's angle) and beside all its
   *  cones. */
  EIGEN_STRONG_INLINE Lanes culled(const Node& node, const Cones& cones, const Lanes& tangents) const
  {
    Lanes height = Lanes::Zero();  // of the segment's begin over the boxes' centres, along the axis
    Lanes climb = Lanes::Zero();   // from begin to end
    Lanes from2 = Lanes::Zero();
    Lanes onto = Lanes::Zero();
    for (int k = 0; k < 3; ++k)
    {
      const Lanes from = begin[k] - 0.5F * (node.low[k] + node.high[k]);
      height += from * cones.axis[k];
      climb += along[k] * cones.axis[k];
      from2 += from * from;
      onto += along[k] * from;
    }
    const Lanes reach = cones.radius + skin;
    const Lanes low = height.min(height + climb) - cones.top - skin;
    const Lanes high = height.max(height + climb) - cones.bottom + skin;
    // Least squared distance from the axis, rounded down.
    const Lanes cross = onto - height * climb;
    const Lanes flat2 = (squared - climb * climb).max(1e-20F);
    const Lanes t = (-cross / flat2).max(0.0F).min(1.0F);
    const Lanes beside2 =
        from2 - height * height + t * (2.0F * cross + t * flat2) - kSquareRounding * (from2 + squared);
    const Lanes width = reach + (low > cutoff * tangents).select(tangents * high.min(cutoff), kOpen);
    return beside2 - width * width;
  }

  Box box;
  std::array<float, 3> begin, along;
  float squared;       // of the segment's length [m²]
  float cutoff, skin;  // [m]
};

void Bvh::collect(const QuerySegment& facets, const QuerySegment& reflex_edges, std::vector<int>& triangles,
                  std::vector<int>& owners) const
{
  const SegmentTest facet_test(facets);
  const SegmentTest edge_test(reflex_edges);
  std::array<int, kMaxDepth> stack;
  int top = 0;
  stack[top++] = 0;
  std::array<int, kBatch> found, found_owners;
  std::size_t count = 0;
  std::size_t owner_count = 0;
  const auto flush = [](const std::array<int, kBatch>& from, std::size_t& number, std::vector<int>& to)
  {
    to.insert(to.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(number));
    number = 0;
  };
  while (top > 0)
  {
    const int index = stack[--top];
    const Node& node = nodes_[index];
    Lanes facet_culled = facet_test.apart(node);
    Lanes owner_culled = Lanes::Ones();
    if (has_cones_[index] != 0)
      facet_culled = facet_culled.max(facet_test.culled(node, cones_[index], cones_[index].facet));
    if (reflex_lanes_[index] != 0)
      owner_culled = edge_test.apart(node);
    if (reflex_lanes_[index] != 0 && has_cones_[index] != 0)
      owner_culled = owner_culled.max(edge_test.culled(node, cones_[index], cones_[index].reflex_edge));
    if (count + kWidth > kBatch)
      flush(found, count, triangles);
    if (owner_count + kWidth > kBatch)
      flush(found_owners, owner_count, owners);
    // Free of branches, which are unpredictable here: culled children are overwritten.
    for (int lane = 0; lane < kWidth; ++lane)
    {
      const int child = node.child[lane];
      const bool facet_found = facet_culled[lane] <= 0.0F;
      const bool owner_found = owner_culled[lane] <= 0.0F && ownsReflexEdge(index, lane);
      stack[top] = child;
      found[count] = found_owners[owner_count] = ~child;
      top += static_cast<int>((facet_found || owner_found) && child >= 0);
      count += static_cast<std::size_t>(facet_found && child < 0);
      owner_count += static_cast<std::size_t>(owner_found && child < 0);
    }
  }
  flush(found, count, triangles);
  flush(found_owners, owner_count, owners);
}

}  // namespace endovascular_sim::contact
