#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include "contact/broad_phase/bvh.h"

// What of the wall can be closest to places along a segment.

namespace endovascular_sim::contact
{
namespace
{

constexpr std::size_t kHandful = 128;      // triangles that are handed over at once
constexpr float kFarOff = 1e3F;            // m
constexpr float kOpen = 1e6F;              // tangent of a cone that holds any direction
constexpr double kWidestCone = 1.2;        // rad: wider ones are open
constexpr double kConeRounding = 1e-4;     // rad
constexpr float kPlaceRounding = 0.5e-6F;  // m
constexpr float kSquareRounding = 1e-5F;   // of squared distances
constexpr std::uint8_t kAllLanes = 0xF;
constexpr float kWideBox = 1.2e-3F;  // m of radius: wider ones are seldom hidden

/** Tangent of a cone that is wider by an angle; infinite: it holds any direction. */
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
  open.ridge.setConstant(kOpen);
  cones_.assign(nodes_.size(), open);
  pointed_.assign(nodes_.size(), 0);
  ridged_.assign(nodes_.size(), kAllLanes);
}

void Bvh::setCone(Place place, const Eigen::Vector3d& axis, const Cone& cone)
{
  Cones& cones = cones_[place.node];
  for (int k = 0; k < 3; ++k)
    cones.axis[k][place.lane] = static_cast<float>(axis[k]);
  cones.facet[place.lane] = laneTangent(cone.facet);
  cones.ridge[place.lane] = laneTangent(cone.ridge);
  if (cone.ridge < 0.0)
    ridged_[place.node] &= static_cast<std::uint8_t>(~(1U << place.lane));
}

void Bvh::setCones(const std::vector<Cone>& cones)
{
  openAllCones();
  for (std::size_t t = 0; t < cones.size(); ++t)
    setCone(place_of_[t], wall_->normals[t], cones[t]);
  for (int n = static_cast<int>(nodes_.size()) - 1; n > 0; --n)
    widenCone(n);
  for (int t = 0; t < static_cast<int>(cones.size()); ++t)
    for (Place place = place_of_[t]; place.node >= 0; place = above_[place.node])
      enclose(t, place);
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    pointed_[n] = (cones_[n].radius < kWideBox && cones_[n].facet < kOpen).any() ? 1 : 0;
}

/** Makes the cylinder round a cone's axis hold a triangle. */
void Bvh::enclose(int triangle, Place place)
{
  const Node& node = nodes_[place.node];
  Cones& cones = cones_[place.node];
  const int lane = place.lane;
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
    cones.radius[lane] = std::max(cones.radius[lane], static_cast<float>(beside) + kPlaceRounding);
    cones.bottom[lane] = std::min(cones.bottom[lane], static_cast<float>(height) - kPlaceRounding);
    cones.top[lane] = std::max(cones.top[lane], static_cast<float>(height) + kPlaceRounding);
  }
}

/** Makes the cone above a node hold those in it. */
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
    if (hasRidge(index, lane))
      cone.ridge = std::max(cone.ridge, widened(cones.ridge[lane], tilt));
  }
  setCone(above_[index], axis, cone);
}

void Bvh::openCones(const std::vector<int>& triangles)
{
  for (int t : triangles)
    for (Place place = place_of_[t]; place.node >= 0; place = above_[place.node])
    {
      cones_[place.node].facet[place.lane] = cones_[place.node].ridge[place.lane] = kOpen;
      ridged_[place.node] |= static_cast<std::uint8_t>(1U << place.lane);
    }
}

struct Bvh::Sight
{
  explicit Sight(const View& view)
    : box(view.begin.cwiseMin(view.begin + view.along) - Eigen::Vector3d::Constant(view.farthest),
          view.begin.cwiseMax(view.begin + view.along) + Eigen::Vector3d::Constant(view.farthest)),
      farthest(static_cast<float>(view.farthest) + kPlaceRounding),
      room(static_cast<float>(view.room) + kPlaceRounding)
  {
    for (int k = 0; k < 3; ++k)
    {
      begin[k] = static_cast<float>(view.begin[k]);
      along[k] = static_cast<float>(view.along[k]);
    }
    squared = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];
  }

  /** Positive where a node's boxes are out of reach. */
  EIGEN_STRONG_INLINE Lanes apart(const Node& node) const
  {
    return gaps(node, box, 0).max(gaps(node, box, 1)).max(gaps(node, box, 2));
  }

  /** Positive where nothing in a node's boxes can be closest: where all places, wherever in their room they are, lie in
   * front of it (no normal there is tilted off the axis by more than the cone is wide) and beside all such cones. */
  EIGEN_STRONG_INLINE Lanes hidden(const Node& node, const Cones& cones, const Lanes& tangents) const
  {
    Lanes height = Lanes::Zero();  // of the segment's begin over the boxes' middles, along the axis
    Lanes climb = Lanes::Zero();   // to its end
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
    const Lanes reach = cones.radius + room;
    const Lanes low = height.min(height + climb) - cones.top - room;
    const Lanes high = height.max(height + climb) - cones.bottom + room;
    // The least squared distance from the axis, rounded down.
    const Lanes cross = onto - height * climb;
    const Lanes flat2 = (squared - climb * climb).max(1e-20F);
    const Lanes t = (-cross / flat2).max(0.0F).min(1.0F);
    const Lanes beside2 =
        from2 - height * height + t * (2.0F * cross + t * flat2) - kSquareRounding * (from2 + squared);
    const Lanes width = reach + (low > farthest * tangents).select(tangents * high.min(farthest), kOpen);
    return beside2 - width * width;
  }

  Box box;
  std::array<float, 3> begin, along;
  float squared;         // of the segment's length [m²]
  float farthest, room;  // [m]
};

void Bvh::collect(const View& facets, const View& ridges, std::vector<int>& triangles, std::vector<int>& ridged) const
{
  const Sight facet_sight(facets);
  const Sight ridge_sight(ridges);
  std::array<int, kMaxDepth> stack;
  int top = 0;
  stack[top++] = 0;
  std::array<int, kHandful> found, found_ridged;
  std::size_t count = 0;
  std::size_t count_ridged = 0;
  const auto handOver = [](const std::array<int, kHandful>& from, std::size_t& number, std::vector<int>& to)
  {
    to.insert(to.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(number));
    number = 0;
  };
  while (top > 0)
  {
    const int index = stack[--top];
    const Node& node = nodes_[index];
    Lanes none = facet_sight.apart(node);
    Lanes none_ridged = Lanes::Ones();
    if (pointed_[index] != 0)
      none = none.max(facet_sight.hidden(node, cones_[index], cones_[index].facet));
    if (ridged_[index] != 0)
      none_ridged = ridge_sight.apart(node);
    if (ridged_[index] != 0 && pointed_[index] != 0)
      none_ridged = none_ridged.max(ridge_sight.hidden(node, cones_[index], cones_[index].ridge));
    if (count + kWidth > kHandful)
      handOver(found, count, triangles);
    if (count_ridged + kWidth > kHandful)
      handOver(found_ridged, count_ridged, ridged);
    // Without branches, which no processor could predict here: what is hidden is overwritten.
    for (int lane = 0; lane < kWidth; ++lane)
    {
      const int child = node.child[lane];
      const bool near = none[lane] <= 0.0F;
      const bool near_ridged = none_ridged[lane] <= 0.0F && hasRidge(index, lane);
      stack[top] = child;
      found[count] = found_ridged[count_ridged] = ~child;
      top += static_cast<int>((near || near_ridged) && child >= 0);
      count += static_cast<std::size_t>(near && child < 0);
      count_ridged += static_cast<std::size_t>(near_ridged && child < 0);
    }
  }
  handOver(found, count, triangles);
  handOver(found_ridged, count_ridged, ridged);
}

}  // namespace endovascular_sim::contact
