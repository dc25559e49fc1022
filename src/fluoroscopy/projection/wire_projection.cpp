#include "fluoroscopy/projection/wire_projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "common/error.h"
#include "common/wide_vectors.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kSamples = 89;              // rays per pixel: Fibonacci number F(11)
constexpr int kLatticeStep = 55;          // generator of the lattice: F(10)
constexpr std::size_t kPadded = 96;       // samples, padded to a multiple of the SIMD width
constexpr double kNearest = 0.02;         // minimum depth of a visible edge, as a fraction of SID
constexpr double kFoldedCosine = 0.05;    // minimum cosine of the bend at a mitre joint
constexpr double kHalfDiagonal = 0.7072;  // half the diagonal of a pixel, rounded up [pixel]
constexpr double kStraight = 1e-6;        // tolerance of positions and radii of merged edges [m]
constexpr std::size_t kLongestRun = 64;   // largest number of merged edges; the cost of the search is quadratic

void check(const XRayWire& wire)
{
  const std::size_t edges = wire.nodes.empty() ? 0 : wire.nodes.size() - 1;
  if (wire.radius.size() != wire.nodes.size() || wire.attenuation.size() != edges)
    throw InputError("wire", "radius, attenuation",
                     "must have one radius per node and one attenuation per edge; there are " +
                         std::to_string(wire.nodes.size()) + " nodes");
  for (std::size_t i = 0; i < wire.nodes.size(); ++i)
    if (!wire.nodes[i].allFinite() || !std::isfinite(wire.radius[i]) || wire.radius[i] < 0.0)
      throw InputError("wire", "node " + std::to_string(i), "must be finite with a non-negative radius");
  for (std::size_t j = 0; j < edges; ++j)
    if (!std::isfinite(wire.attenuation[j]))
      throw InputError("wire", "attenuation " + std::to_string(j), "must be finite");
}

/** Normal of the clipping plane of an edge towards its neighbour: the bisecting plane, or the plane normal to the edge
 *  at a sharp bend. */
Eigen::Vector3d mitre(const Eigen::Vector3d& own, const Eigen::Vector3d& other)
{
  return own.dot(other) > kFoldedCosine ? (own + other).normalized() : own;
}

/** Last node of the straight cylinder of constant radius that begins at @p first. Merging edges saves their joints. */
std::size_t endOfStraight(const XRayWire& wire, std::size_t first)
{
  std::size_t end = first + 1;
  const auto straightTo = [&wire, first](std::size_t last)
  {
    const Eigen::Vector3d& from = wire.nodes[first];
    const Eigen::Vector3d chord = wire.nodes[last] - from;
    const double length = chord.norm();
    double reached = 0.0;
    for (std::size_t k = first + 1; k < last; ++k)
    {
      const Eigen::Vector3d offset = wire.nodes[k] - from;
      const double along = offset.dot(chord);
      if (!(along >= reached) || !(offset.norm() <= length) || offset.cross(chord).norm() > kStraight * length)
        return false;
      reached = along;
    }
    return std::abs(wire.radius[last] - wire.radius[first]) <= kStraight &&
           wire.attenuation[last - 1] == wire.attenuation[first];
  };
  if (std::abs(wire.radius[end] - wire.radius[first]) > kStraight)
    return end;
  while (end + 1 < wire.nodes.size() && end - first < kLongestRun && straightTo(end + 1))
    ++end;
  return end;
}

/** Affine function of the sample's offset within a pixel. */
struct Linear
{
  Linear(const Eigen::Vector3d& gradient, double centre)
    : x(static_cast<float>(gradient.x())), y(static_cast<float>(gradient.y())), z(static_cast<float>(centre))
  {
  }
  float at(float right, float up) const { return right * x + up * y + z; }
  /** Largest deviation from the value at the centre.
   *  @param reach half width of the pixel */
  float spread(float reach) const { return reach * (std::abs(x) + std::abs(y)); }
  float x, y, z;
};

}  // namespace

/** Offsets of a pixel's samples from its centre, as differences of rays with z = 1. The padding is not evaluated. */
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

/** Cylinder with clipping planes in the optical frame. */
struct WireProjection::Edge
{
  /** Cylinder with end planes normal to its axis.
   *  @pre the ends are distinct */
  Edge(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double edge_radius, double coefficient)
    : begin(from),
      end(to),
      axis((to - from).normalized()),
      begin_normal(axis),
      end_normal(axis),
      moment(axis.cross(begin)),
      across(begin - begin.dot(axis) * axis),
      depth(0.5 * (begin.z() + end.z())),
      radius(edge_radius),
      attenuation(coefficient)
  {
  }

  Eigen::Vector3d begin, end;                ///< ends of the axis [m]
  Eigen::Vector3d axis;                      ///< unit vector from begin to end
  Eigen::Vector3d begin_normal, end_normal;  ///< unit normals of the clipping planes, oriented along the axis
  Eigen::Vector3d moment, across;            ///< a × p and p⊥ of the chord formula [m]
  double depth;                              ///< depth of the midpoint, the t of its ray [m]
  double radius;                             ///< [m]
  double attenuation;                        ///< [1/m]

  /** Extension of the cylinder beyond the end of its axis by an oblique clipping plane [m]. */
  double mitreDepth(const Eigen::Vector3d& normal) const
  {
    const double cosine = normal.dot(axis);
    return radius * std::sqrt(std::max(0.0, 1.0 / (cosine * cosine) - 1.0));
  }
};

/** Chords of all sample rays of a pixel in an edge. The loops have no calls, branches or aliasing, so that the compiler
 *  vectorises them. Values are relative to the pixel's central ray and to the edge's midpoint, for which single
 *  precision suffices. */
class WireProjection::Chords
{
public:
  /** @param ray central ray of the pixel, with z = 1 */
  Chords(const Edge& edge, const Eigen::Vector3d& ray) : Chords(edge, ray, ray - edge.axis.dot(ray) * edge.axis) {}

  /** Effect of the clipping planes on the chords of a pixel. */
  enum class Clipping
  {
    kOutside,  ///< all chords are removed
    kPartial,  ///< chords may be clipped
    kInside,   ///< no chord is clipped
  };
  /** Classifies the pixel.
   *  @param reach half width of the pixel, for rays with z = 1 */
  Clipping clipping(float reach) const
  {
    const float second_order = 2.0F * reach * reach;
    const float a = a_.z - a_.spread(reach) - second_order;
    if (a <= min_a_)
      return Clipping::kPartial;
    const float middle = closest_.z / a_.z;
    const float wide = (closest_.spread(reach) + depth_ * second_order + std::abs(middle) * (a_.z - a)) / a;
    const float half = kRounding * (wide + radius_ / std::sqrt(a));  // bound of |t − middle| of all chords
    const auto [begin_low, begin_high] = begin_.range(middle, half, reach);
    const auto [end_low, end_high] = end_.range(middle, half, reach);
    if (begin_high < 0.0F || end_high < 0.0F)
      return Clipping::kOutside;
    return begin_low > 0.0F && end_low > 0.0F ? Clipping::kInside : Clipping::kPartial;
  }

  /** Adds the unclipped chords to the optical depth of every sample. */
  EVS_WIDE_VECTORS void addUnclipped(const Offsets& offsets, float* depth) const
  {
    const Chords c = *this;  // a local copy excludes aliasing with the output
    const float* offset_x = offsets.x.data();
    const float* offset_y = offsets.y.data();
    for (std::size_t i = 0; i < kPadded; ++i)
    {
      const float x = offset_x[i], y = offset_y[i];
      const float turned = c.axis_x_ * x + c.axis_y_ * y;
      const float a = c.a_.at(x, y) + (x * x + y * y - turned * turned);
      const float off = c.off_.at(x, y);
      const float discriminant = a * c.radius_ * c.radius_ - off * off;
      const float chord = 2.0F * std::sqrt(discriminant > 0.0F ? discriminant : 0.0F) / a;
      depth[i] += chord * c.per_chord_.at(x, y);
    }
  }

  /** Adds the clipped chords to the optical depth of every sample. */
  EVS_WIDE_VECTORS void addClipped(const Offsets& offsets, float* depth) const
  {
    const Chords c = *this;
    const float* offset_x = offsets.x.data();
    const float* offset_y = offsets.y.data();
    for (std::size_t i = 0; i < kPadded; ++i)
    {
      const float x = offset_x[i], y = offset_y[i];
      const float turned = c.axis_x_ * x + c.axis_y_ * y;
      const float second_order = x * x + y * y - turned * turned;  // of A
      const float a = c.a_.at(x, y) + second_order;
      const float inverse = 1.0F / (a > c.min_a_ ? a : c.min_a_);
      const float off = c.off_.at(x, y);
      const float discriminant = a * c.radius_ * c.radius_ - off * off;
      const float half = std::sqrt(discriminant > 0.0F ? discriminant : 0.0F) * inverse;
      const float middle = (c.closest_.at(x, y) - c.depth_ * second_order) * inverse;
      const float slope0 = c.begin_.slope.at(x, y) + 0.0F, slope1 = c.end_.slope.at(x, y) + 0.0F;  // no −0
      // The retained half-space is slope·t ≥ offset.
      const float cut0 = c.begin_.offset.at(x, y) / slope0, cut1 = c.end_.offset.at(x, y) / slope1;
      float from = middle - half, to = middle + half;
      from = slope0 >= 0.0F && cut0 > from ? cut0 : from;
      to = slope0 < 0.0F && cut0 < to ? cut0 : to;
      from = slope1 >= 0.0F && cut1 > from ? cut1 : from;
      to = slope1 < 0.0F && cut1 < to ? cut1 : to;
      const float chord = to > from && a > c.min_a_ ? to - from : 0.0F;
      depth[i] += chord * c.per_chord_.at(x, y);
    }
  }

private:
  /** @param turned component of the ray normal to the edge's axis */
  Chords(const Edge& edge, const Eigen::Vector3d& ray, const Eigen::Vector3d& turned)
    : a_(2.0 * turned, turned.dot(ray)),
      off_(edge.moment, edge.moment.dot(ray)),
      closest_(edge.across - 2.0 * edge.depth * turned, edge.across.dot(ray) - edge.depth * turned.dot(ray)),
      begin_(edge.begin_normal, edge.begin_normal.dot(edge.begin), edge.depth, ray),
      end_(-edge.end_normal, -edge.end_normal.dot(edge.end), edge.depth, ray),
      per_chord_(edge.attenuation / ray.norm() * ray, edge.attenuation * ray.norm()),
      axis_x_(static_cast<float>(edge.axis.x())),
      axis_y_(static_cast<float>(edge.axis.y())),
      depth_(static_cast<float>(edge.depth)),
      min_a_(static_cast<float>(kParallel * ray.squaredNorm())),
      radius_(static_cast<float>(edge.radius))
  {
  }

  static constexpr double kParallel = 1e-12;  // minimum A/|d|²; rays nearly parallel to the axis are omitted
  static constexpr float kRounding = 1.001F;

  /** Clipping plane in ray coordinates: slope·t ≥ offset is retained, with t relative to the edge's midpoint. */
  struct Plane
  {
    Plane(const Eigen::Vector3d& normal, double distance, double middle_depth, const Eigen::Vector3d& ray)
      : slope(normal, normal.dot(ray)), offset(-middle_depth * normal, distance - middle_depth * normal.dot(ray))
    {
    }
    /** Bounds of slope·t − offset over a pixel's rays within t = @p middle ± @p half. */
    std::pair<float, float> range(float middle, float half, float reach) const
    {
      const float centre = slope.z * middle - offset.z;
      const float spread =
          std::abs(slope.z) * half + slope.spread(reach) * (std::abs(middle) + half) + offset.spread(reach) + 1e-7F;
      return {centre - kRounding * spread, centre + kRounding * spread};
    }
    Linear slope, offset;
  };

  Linear a_, off_, closest_;  ///< A; d·(a×p); d·p⊥ − A·depth
  Plane begin_, end_;
  Linear per_chord_;  ///< optical depth per unit of t
  float axis_x_, axis_y_, depth_, min_a_, radius_;
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

/** Conservative footprint of an edge: a rectangle along the image of its axis.
 *
 *  A point of the edge is x + ρw with x on the axis extended by the mitres, ρ ≤ r, and w a unit vector normal to the
 *  axis. Its image is displaced from that of x by f ρ J w/(x_z + ρ w_z) with J = (I | −x_xy/x_z). The displacement
 *  along an image direction e is at most f r |Jᵀe − (Jᵀe·a) a|/(z − r). This bound is a convex function of x_xy/x_z and
 *  takes its maximum at an end. */
class WireProjection::Footprint
{
public:
  Footprint(const XRayGeometry& geometry, const Edge& edge)
  {
    const double f = geometry.focalLength();
    const Eigen::Vector3d first = edge.begin - edge.mitreDepth(edge.begin_normal) * edge.axis;
    const Eigen::Vector3d second = edge.end + edge.mitreDepth(edge.end_normal) * edge.axis;
    const double nearest = std::min(first.z(), second.z()) - edge.radius;
    // Image coordinates to the right and up.
    const Eigen::Vector2d a = first.head<2>() / first.z(), b = second.head<2>() / second.z();
    const Eigen::Vector2d ab = f * (b - a);
    const double length = ab.norm();
    along_ = length > 0.0 ? Eigen::Vector2d(ab / length) : Eigen::Vector2d::UnitX();
    across_ = Eigen::Vector2d(-along_.y(), along_.x());
    const auto reach = [&](const Eigen::Vector2d& e)
    {
      const auto at = [&](const Eigen::Vector2d& point)
      {
        const Eigen::Vector3d direction(e.x(), e.y(), -point.dot(e));
        return (direction - direction.dot(edge.axis) * edge.axis).norm();
      };
      return f * edge.radius / nearest * std::max(at(a), at(b)) + kHalfDiagonal;
    };
    const double centre = geometry.centre();
    half_length_ = 0.5 * length + reach(along_);
    half_width_ = reach(across_);
    middle_ = 0.5 * f * (a + b);
    const Eigen::Vector2d half = half_length_ * along_.cwiseAbs() + half_width_ * across_.cwiseAbs();
    const double last = geometry.pixels() - 1;
    const auto from = [last](double x) { return static_cast<int>(std::ceil(std::clamp(x, 0.0, last + 1.0))); };
    const auto to = [last](double x) { return static_cast<int>(std::floor(std::clamp(x, -1.0, last))); };
    first_column = from(centre + middle_.x() - half.x());
    last_column = to(centre + middle_.x() + half.x());
    first_row = from(centre - middle_.y() - half.y());
    last_row = to(centre - middle_.y() + half.y());
    middle_ = Eigen::Vector2d(centre + middle_.x(), centre - middle_.y());
  }

  bool contains(int column, int row) const
  {
    const Eigen::Vector2d from_middle(column - middle_.x(), middle_.y() - row);
    return std::abs(from_middle.dot(along_)) <= half_length_ && std::abs(from_middle.dot(across_)) <= half_width_;
  }

  int first_row, last_row, first_column, last_column;

private:
  Eigen::Vector2d along_, across_;   ///< unit vectors in image coordinates to the right and up
  Eigen::Vector2d middle_;           ///< column and row of the centre [pixel]
  double half_length_, half_width_;  ///< [pixel]
};

void WireProjection::addEdge(const XRayGeometry& geometry, const Offsets& offsets, const Edge& edge)
{
  const Footprint footprint(geometry, edge);
  const auto reach = static_cast<float>(0.5 / geometry.focalLength());
  for (int row = footprint.first_row; row <= footprint.last_row; ++row)
    for (int column = footprint.first_column; column <= footprint.last_column; ++column)
    {
      if (!footprint.contains(column, row))
        continue;
      const Chords chords(edge, geometry.ray(column, row));
      const Chords::Clipping clipping = chords.clipping(reach);
      if (clipping == Chords::Clipping::kOutside)
        continue;
      float* depth = samplesOf(static_cast<std::uint32_t>(row * geometry.pixels() + column));
      if (clipping == Chords::Clipping::kInside)
        chords.addUnclipped(offsets, depth);
      else
        chords.addClipped(offsets, depth);
    }
}

void WireProjection::addWire(const XRayGeometry& geometry, const Offsets& offsets, const XRayWire& wire)
{
  const double nearest = kNearest * geometry.pose().source_to_detector;
  const double farthest = geometry.pose().source_to_detector;
  const auto isVisible = [&](double z, double radius)  // mitre joints extend the axis by less than r
  { return z >= nearest + 2.0 * radius && z <= farthest; };
  std::vector<Edge> edges;
  std::size_t next = 0;
  for (std::size_t j = 0; j + 1 < wire.nodes.size(); j = next)
  {
    next = endOfStraight(wire, j);
    const Eigen::Vector3d begin = geometry.toOptical(wire.nodes[j]);
    const double largest_radius = std::max(wire.radius[j], wire.radius[next]);
    // Invisible edges are omitted one by one, so that they are not merged.
    if (!isVisible(begin.z(), largest_radius) || !isVisible(geometry.toOptical(wire.nodes[next]).z(), largest_radius))
      next = j + 1;
    const Eigen::Vector3d end = geometry.toOptical(wire.nodes[next]);
    if (begin == end)
      continue;
    Edge edge(begin, end, 0.5 * (wire.radius[j] + wire.radius[next]), wire.attenuation[j]);
    if (!edges.empty())
    {
      edge.begin_normal = mitre(edge.axis, edges.back().axis);
      edges.back().end_normal = mitre(edges.back().axis, edge.axis);
    }
    edges.push_back(edge);
  }
  for (const Edge& edge : edges)
    if (isVisible(edge.begin.z(), edge.radius) && isVisible(edge.end.z(), edge.radius))
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
    const Eigen::Map<const Eigen::Array<float, kSamples, 1>> depth(optical_depth_.data() + k * kPadded);
    shadow.transmission[k] = static_cast<double>((-depth).exp().sum()) / kSamples;
    slot_[pixels_[k]] = -1;
  }
}

}  // namespace endovascular_sim::fluoroscopy
