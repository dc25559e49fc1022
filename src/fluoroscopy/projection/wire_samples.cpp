#include "fluoroscopy/projection/wire_samples.h"

#include <cmath>

#include "common/fast_math.h"
#include "common/wide_vectors.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kLatticeStep = 55;     // generator of the lattice: F(10)
constexpr double kParallel = 1e-12;  // minimum A/|d|²; rays nearly parallel to the axis are omitted

/** Affine function of a ray's offset from the central ray of its pixel. */
struct Linear
{
  Linear(const Eigen::Vector3d& gradient, double centre)
    : x(static_cast<float>(gradient.x())), y(static_cast<float>(gradient.y())), z(static_cast<float>(centre))
  {
  }
  float at(float right, float up) const { return right * x + up * y + z; }
  float x, y, z;
};

/** Clipping plane in ray coordinates: slope·t ≥ offset is retained, with t relative to the edge's midpoint. */
struct Plane
{
  Plane(const Eigen::Vector3d& normal, double distance, double middle_depth, const Eigen::Vector3d& ray)
    : slope(normal, normal.dot(ray)), offset(-middle_depth * normal, distance - middle_depth * normal.dot(ray))
  {
  }
  Linear slope, offset;
};

/** Chords of all rays of a pixel in an edge. Values are relative to the pixel's central ray and to the edge's midpoint,
 * for which single precision suffices. */
struct Chords
{
  /** @param turned component of the ray normal to the edge's axis */
  Chords(const WireEdge& edge, const Eigen::Vector3d& ray, const Eigen::Vector3d& turned)
    : a(2.0 * turned, turned.dot(ray)),
      off(edge.moment, edge.moment.dot(ray)),
      closest(edge.across - 2.0 * edge.depth * turned, edge.across.dot(ray) - edge.depth * turned.dot(ray)),
      begin(edge.begin_normal, edge.begin_normal.dot(edge.begin), edge.depth, ray),
      end(-edge.end_normal, -edge.end_normal.dot(edge.end), edge.depth, ray),
      norm(ray / ray.norm(), ray.norm()),
      axis_x(static_cast<float>(edge.axis.x())),
      axis_y(static_cast<float>(edge.axis.y())),
      depth(static_cast<float>(edge.depth)),
      min_a(static_cast<float>(kParallel * ray.squaredNorm()))
  {
  }

  Linear a, off, closest;  ///< A; d·(a×p); d·p⊥ − A·depth
  Plane begin, end;
  Linear norm;  ///< |d|
  float axis_x, axis_y, depth, min_a;
};

/** Layer of a profile in single precision. */
struct Layer
{
  float radius, steel, water;
};

/** Adds the clipped chords of one layer. The loop has no calls, branches or aliasing, so that the compiler vectorises
 * it. */
EVS_WIDE_VECTORS void addLayer(const Chords& chords, const Layer& layer, const float* offset_x, const float* offset_y,
                               float* steel, float* water)
{
  const Chords c = chords;
  for (std::size_t i = 0; i < WireSamples::kPadded; ++i)
  {
    const float x = offset_x[i], y = offset_y[i];
    const float turned = c.axis_x * x + c.axis_y * y;
    const float second_order = x * x + y * y - turned * turned;  // of A
    const float a = c.a.at(x, y) + second_order;
    const float inverse = 1.0F / (a > c.min_a ? a : c.min_a);
    const float off = c.off.at(x, y);
    const float discriminant = a * layer.radius * layer.radius - off * off;
    const float half = std::sqrt(discriminant > 0.0F ? discriminant : 0.0F) * inverse;
    const float middle = (c.closest.at(x, y) - c.depth * second_order) * inverse;
    const float slope0 = c.begin.slope.at(x, y) + 0.0F, slope1 = c.end.slope.at(x, y) + 0.0F;  // no −0
    const float cut0 = c.begin.offset.at(x, y) / slope0, cut1 = c.end.offset.at(x, y) / slope1;
    float from = middle - half, to = middle + half;
    from = slope0 >= 0.0F && cut0 > from ? cut0 : from;
    to = slope0 < 0.0F && cut0 < to ? cut0 : to;
    from = slope1 >= 0.0F && cut1 > from ? cut1 : from;
    to = slope1 < 0.0F && cut1 < to ? cut1 : to;
    const float chord = to > from && a > c.min_a ? (to - from) * c.norm.at(x, y) : 0.0F;
    steel[i] += chord * layer.steel;
    water[i] += chord * layer.water;
  }
}

EVS_WIDE_VECTORS float meanTransmission(const DeviceCoefficients& coefficients, const float* steel, const float* water)
{
  constexpr std::size_t kLanes = 8;  // partial sums, in a fixed order for every instruction set
  const DeviceCoefficients c = coefficients;
  float transmission[WireSamples::kPadded];
  for (std::size_t i = 0; i < WireSamples::kPadded; ++i)
    transmission[i] = i < WireSamples::kSamples ? fastExp(-opticalDepth(c, steel[i], water[i])) : 0.0F;
  float sums[kLanes] = {};
  for (std::size_t i = 0; i < WireSamples::kPadded; i += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k)
      sums[k] += transmission[i + k];
  float sum = 0.0F;
  for (const float part : sums)
    sum += part;
  return sum / static_cast<float>(WireSamples::kSamples);
}

}  // namespace

WireSamples::WireSamples(double focal_length)
{
  constexpr int kCount = kSamples;
  for (int i = 0; i < kCount; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    x_[k] = static_cast<float>(((i + 0.5) / kCount - 0.5) / focal_length);
    y_[k] = static_cast<float>((0.5 - ((i * kLatticeStep) % kCount + 0.5) / kCount) / focal_length);
  }
}

void WireSamples::clear()
{
  steel_.fill(0.0F);
  water_.fill(0.0F);
}

void WireSamples::add(const WireEdge& edge, const Eigen::Vector3d& ray)
{
  const Chords chords(edge, ray, ray - edge.axis.dot(ray) * edge.axis);
  for (const WireLayer& layer : *edge.profile)
    addLayer(chords,
             {static_cast<float>(layer.radius), static_cast<float>(layer.density.steel),
              static_cast<float>(layer.density.water)},
             x_.data(), y_.data(), steel_.data(), water_.data());
}

double WireSamples::transmission(const DeviceCoefficients& coefficients) const
{
  return static_cast<double>(meanTransmission(coefficients, steel_.data(), water_.data()));
}

}  // namespace endovascular_sim::fluoroscopy
