#include "fluoroscopy/wire_projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kSamples = 89;  // Fibonacci numbers F(11), and F(10) for the lattice
constexpr int kLatticeStep = 55;
constexpr std::size_t kPadded = 92;     // a multiple of the values in a vector register
constexpr double kNearest = 0.02;       // closest approach to the source, as a part of SID
constexpr double kFoldedCosine = 0.05;  // mitres are for bends below 90°
constexpr double kHalfDiagonal = 0.7072;

void check(const XRayWire& wire)
{
  const std::size_t edges = wire.nodes.empty() ? 0 : wire.nodes.size() - 1;
  if (wire.radius.size() != wire.nodes.size() || wire.attenuation.size() != edges)
    throw InputError("wire", "radius, attenuation",
                     "must have one radius per node and one attenuation per edge; there are " +
                         std::to_string(wire.nodes.size()) + " nodes");
  for (std::size_t i = 0; i < wire.nodes.size(); ++i)
    if (!wire.nodes[i].allFinite() || !std::isfinite(wire.radius[i]) || wire.radius[i] < 0.0)
      throw InputError("wire", "node " + std::to_string(i), "must be finite with a radius of at least 0");
}

/** Normal of the plane between edges with directions a and b; both when the wire folds back. */
Eigen::Vector3d mitre(const Eigen::Vector3d& own, const Eigen::Vector3d& other)
{
  return own.dot(other) > kFoldedCosine ? (own + other).normalized() : own;
}

}  // namespace

/** Samples of a pixel from its centre, as differences of rays with z = 1; what fills up the last vector is not used. */
struct WireProjection::Offsets
{
  explicit Offsets(double focal_length)
  {
    for (int i = 0; i < kSamples; ++i)
    {
      const double right = ((i + 0.5) / kSamples - 0.5) / focal_length;
      const double up = (0.5 - ((i * kLatticeStep) % kSamples + 0.5) / kSamples) / focal_length;
      x[static_cast<std::size_t>(i)] = static_cast<float>(right);
      y[static_cast<std::size_t>(i)] = static_cast<float>(up);
    }
  }

  std::array<float, kPadded> x{}, y{};
};

/** One mitred cylinder in the optical frame. */
struct WireProjection::Edge
{
  Eigen::Vector3d begin, end;                // ends of the axis [m]
  Eigen::Vector3d axis;                      // unit
  Eigen::Vector3d begin_normal, end_normal;  // of the planes that cut it, both along the axis
  double radius;                             // [m]
  double attenuation;                        // [1/m]

  /** How far a plane that cuts the cylinder reaches beyond its axis's end, along the axis [m]. */
  double mitreDepth(const Eigen::Vector3d& normal) const
  {
    const double cosine = normal.dot(axis);
    return radius * std::sqrt(std::max(0.0, 1.0 / (cosine * cosine) - 1.0));
  }
};

/** Cuts a pixel's rays with an edge, all samples at once: without calls, branches and references, so that the loop
 *  becomes vector code. By what a ray differs from the pixel's centre ray, and how far beyond the edge's middle
 *  something lies along it, single precision is enough for. */
class WireProjection::Chords
{
public:
  Chords(const Edge& edge, const Offsets& offsets)
    : offsets_(offsets),
      axis_(edge.axis),
      moment_(edge.axis.cross(edge.begin)),
      across_(edge.begin - edge.begin.dot(edge.axis) * edge.axis),
      begin_{edge.begin_normal, edge.begin_normal.dot(edge.begin)},
      end_{-edge.end_normal, -edge.end_normal.dot(edge.end)},
      depth_(0.5 * (edge.begin.z() + edge.end.z())),
      square_radius_(static_cast<float>(edge.radius * edge.radius)),
      attenuation_(edge.attenuation)
  {
  }

  /** Adds to every sample's optical depth. @param ray through the pixel's centre, z = 1 */
  void add(const Eigen::Vector3d& ray, float* depth) const
  {
    const double along = axis_.dot(ray), square = ray.squaredNorm(), free = square - along * along;
    const double length = std::sqrt(square);
    const double slope_begin = begin_.normal.dot(ray), slope_end = end_.normal.dot(ray);
    const Eigen::Vector3d turn = ray - along * axis_;  // half of A's gradient
    const Linear a(2.0 * turn, free), h(moment_, moment_.dot(ray));
    // Beyond the edge's middle: of the closest place to the axis, times A; of the planes, times their slopes.
    const Linear closest(across_ - 2.0 * depth_ * turn, across_.dot(ray) - depth_ * free);
    const Linear slope0(begin_.normal, slope_begin), slope1(end_.normal, slope_end);
    const Linear rest0(-depth_ * begin_.normal, begin_.offset - depth_ * slope_begin);
    const Linear rest1(-depth_ * end_.normal, end_.offset - depth_ * slope_end);
    const Linear per_chord(attenuation_ / length * ray, attenuation_ * length);
    const auto axis_x = static_cast<float>(axis_.x()), axis_y = static_cast<float>(axis_.y());
    const auto middle_depth = static_cast<float>(depth_), least = static_cast<float>(kParallel * square);
    const float square_radius = square_radius_;
    const float* offset_x = offsets_.x.data();
    const float* offset_y = offsets_.y.data();
    for (std::size_t i = 0; i < kPadded; ++i)
    {
      const float x = offset_x[i], y = offset_y[i];
      const float turned = axis_x * x + axis_y * y;
      const float second_order = x * x + y * y - turned * turned;  // of A
      const float free_here = a.at(x, y) + second_order;
      const float inverse = 1.0F / (free_here > least ? free_here : least);
      const float off = h.at(x, y);
      const float discriminant = free_here * square_radius - off * off;
      const float half = std::sqrt(discriminant > 0.0F ? discriminant : 0.0F) * inverse;
      const float middle = (closest.at(x, y) - middle_depth * second_order) * inverse;
      const float s0 = slope0.at(x, y) + 0.0F, s1 = slope1.at(x, y) + 0.0F;  // no −0
      // What is kept has slope·t ≥ offset.
      const float cut0 = rest0.at(x, y) / s0, cut1 = rest1.at(x, y) / s1;
      float from = middle - half, to = middle + half;
      from = s0 >= 0.0F && cut0 > from ? cut0 : from;
      to = s0 < 0.0F && cut0 < to ? cut0 : to;
      from = s1 >= 0.0F && cut1 > from ? cut1 : from;
      to = s1 < 0.0F && cut1 < to ? cut1 : to;
      const float chord = to > from && free_here > least ? to - from : 0.0F;
      depth[i] += chord * per_chord.at(x, y);
    }
  }

private:
  static constexpr double kParallel = 1e-12;  // of |d|²: with less across the axis a ray meets no cylinder

  /** Something that changes evenly over the pixel. */
  struct Linear
  {
    Linear(const Eigen::Vector3d& gradient, double centre)
      : x(static_cast<float>(gradient.x())), y(static_cast<float>(gradient.y())), z(static_cast<float>(centre))
    {
    }
    float at(float right, float up) const { return right * x + up * y + z; }
    float x, y, z;
  };
  struct Plane
  {
    Eigen::Vector3d normal;
    double offset;  ///< [m]
  };

  const Offsets& offsets_;
  Eigen::Vector3d axis_, moment_, across_;
  Plane begin_, end_;
  double depth_;  ///< of the edge's middle: t there on rays with z = 1 [m]
  float square_radius_;
  double attenuation_;
};

float* WireProjection::samplesOf(std::uint32_t pixel)
{
  std::int32_t& slot = slot_[pixel];
  if (slot < 0)
  {
    slot = static_cast<std::int32_t>(pixels_.size());
    pixels_.push_back(pixel);
    optical_depth_.resize(optical_depth_.size() + kPadded, 0.0F);
  }
  return optical_depth_.data() + static_cast<std::size_t>(slot) * kPadded;
}

/** Pixels that an edge may touch: a rectangle along its axis's image.
 *
 *  A point of the edge is x + ρw: x on the axis, as far beyond its ends as the mitres reach, ρ ≤ r, w a unit vector
 *  across the axis. In the image it lies f ρ J w/(x_z + ρ w_z) beside x, with J = (I | −x_xy/x_z) in units of z, so
 *  along an image direction e by at most f r |Jᵀe − (Jᵀe·a) a|/(z − r), a convex function of x_xy/x_z: largest at
 *  an end. */
class WireProjection::Footprint
{
public:
  Footprint(const XRayGeometry& geometry, const Edge& edge)
  {
    const double f = geometry.focalLength();
    const Eigen::Vector3d first = edge.begin - edge.mitreDepth(edge.begin_normal) * edge.axis;
    const Eigen::Vector3d second = edge.end + edge.mitreDepth(edge.end_normal) * edge.axis;
    const double nearest = std::min(first.z(), second.z()) - edge.radius;
    // Before the image's rows turn round: right and up.
    const Eigen::Vector2d a = first.head<2>() / first.z(), b = second.head<2>() / second.z();
    const Eigen::Vector2d ab = f * (b - a);
    const double length = ab.norm();
    along_ = length > 0.0 ? Eigen::Vector2d(ab / length) : Eigen::Vector2d::UnitX();
    across_ = Eigen::Vector2d(-along_.y(), along_.x());
    const auto reach = [&](const Eigen::Vector2d& e)
    {
      const auto at = [&](const Eigen::Vector2d& place)
      {
        const Eigen::Vector3d seen(e.x(), e.y(), -place.dot(e));
        return (seen - seen.dot(edge.axis) * edge.axis).norm();
      };
      return f * edge.radius / nearest * std::max(at(a), at(b)) + kHalfDiagonal;
    };
    const double centre = geometry.centre();
    half_length_ = 0.5 * length + reach(along_);
    half_width_ = reach(across_);
    middle_ = 0.5 * f * (a + b);
    const Eigen::Vector2d half = half_length_ * along_.cwiseAbs() + half_width_ * across_.cwiseAbs();
    const double last = geometry.pixels() - 1;
    const auto from = [last](double place) { return static_cast<int>(std::ceil(std::clamp(place, 0.0, last + 1.0))); };
    const auto to = [last](double place) { return static_cast<int>(std::floor(std::clamp(place, -1.0, last))); };
    first_column = from(centre + middle_.x() - half.x());
    last_column = to(centre + middle_.x() + half.x());
    first_row = from(centre - middle_.y() - half.y());
    last_row = to(centre - middle_.y() + half.y());
    middle_ = Eigen::Vector2d(centre + middle_.x(), centre - middle_.y());
  }

  bool holds(int column, int row) const
  {
    const Eigen::Vector2d from_middle(column - middle_.x(), middle_.y() - row);
    return std::abs(from_middle.dot(along_)) <= half_length_ && std::abs(from_middle.dot(across_)) <= half_width_;
  }

  int first_row, last_row, first_column, last_column;

private:
  Eigen::Vector2d along_, across_;   ///< unit, right and up
  Eigen::Vector2d middle_;           ///< column and row [pixel]
  double half_length_, half_width_;  ///< [pixel]
};

void WireProjection::addEdge(const XRayGeometry& geometry, const Offsets& offsets, const Edge& edge)
{
  const Footprint footprint(geometry, edge);
  const Chords chords(edge, offsets);
  for (int row = footprint.first_row; row <= footprint.last_row; ++row)
    for (int column = footprint.first_column; column <= footprint.last_column; ++column)
      if (footprint.holds(column, row))
        chords.add(geometry.ray(column, row), samplesOf(static_cast<std::uint32_t>(row * geometry.pixels() + column)));
}

void WireProjection::addWire(const XRayGeometry& geometry, const Offsets& offsets, const XRayWire& wire)
{
  std::vector<Edge> edges;
  for (std::size_t j = 0; j + 1 < wire.nodes.size(); ++j)
  {
    Edge edge{geometry.toOptical(wire.nodes[j]),
              geometry.toOptical(wire.nodes[j + 1]),
              {},
              {},
              {},
              0.5 * (wire.radius[j] + wire.radius[j + 1]),
              wire.attenuation[j]};
    const double length = (edge.end - edge.begin).norm();
    if (length <= 0.0)
      continue;
    edge.axis = (edge.end - edge.begin) / length;
    edge.begin_normal = edge.end_normal = edge.axis;
    if (!edges.empty())
    {
      edge.begin_normal = mitre(edge.axis, edges.back().axis);
      edges.back().end_normal = mitre(edges.back().axis, edge.axis);
    }
    edges.push_back(edge);
  }
  const double nearest = kNearest * geometry.pose().source_to_detector;
  const double farthest = geometry.pose().source_to_detector;
  for (const Edge& edge : edges)
    if (std::min(edge.begin.z(), edge.end.z()) >= nearest + 2.0 * edge.radius &&  // mitres reach less than r beyond
        std::max(edge.begin.z(), edge.end.z()) <= farthest)
      addEdge(geometry, offsets, edge);
}

void WireProjection::project(const XRayGeometry& geometry, const std::vector<XRayWire>& wires, WireShadow& shadow)
{
  for (const XRayWire& wire : wires)
    check(wire);
  const auto size = static_cast<std::size_t>(geometry.pixels()) * static_cast<std::size_t>(geometry.pixels());
  if (slot_.size() != size)
    slot_.assign(size, -1);
  pixels_.clear();
  optical_depth_.clear();
  const Offsets offsets(geometry.focalLength());
  for (const XRayWire& wire : wires)
    addWire(geometry, offsets, wire);

  shadow.pixels = pixels_;
  shadow.transmission.resize(pixels_.size());
  for (std::size_t k = 0; k < pixels_.size(); ++k)
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < kSamples; ++i)
    {
      const float depth = optical_depth_[k * kPadded + i];
      sum += depth == 0.0F ? 1.0 : std::exp(-static_cast<double>(depth));  // most rays at a wire's border pass it
    }
    shadow.transmission[k] = sum / kSamples;
    slot_[pixels_[k]] = -1;
  }
}

}  // namespace endovascular_sim::fluoroscopy
