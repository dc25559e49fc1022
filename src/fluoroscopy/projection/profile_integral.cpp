#include "fluoroscopy/projection/profile_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/fast_math.h"
#include "common/wide_vectors.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr std::size_t kPoints = 16;

/** Points and weights on [−1, 1]: the midpoint rule in v, with x = (3v − v³)/2. */
struct Rule
{
  Rule()
  {
    double sum = 0.0;
    std::array<double, kPoints> weights{};
    for (std::size_t k = 0; k < kPoints; ++k)
    {
      const double v = (2.0 * static_cast<double>(k) + 1.0) / kPoints - 1.0;
      point[k] = static_cast<float>(0.5 * v * (3.0 - v * v));
      sum += weights[k] = 1.0 - v * v;
    }
    for (std::size_t k = 0; k < kPoints; ++k)
      weight[k] = static_cast<float>(2.0 * weights[k] / sum);
  }
  std::array<float, kPoints> point{}, weight{};
};

/** Constants of one pixel for the loops over points. */
struct Interval
{
  float middle, half;  ///< of o [m]
};

EVS_WIDE_VECTORS float loss(const WireProfile& profile, const PixelView& pixel, const Interval& interval,
                            const DeviceCoefficients& coefficients, const Rule& rule)
{
  const PixelView view = pixel;
  const DeviceCoefficients c = coefficients;
  float squared[kPoints], steel[kPoints], water[kPoints], part[kPoints];
  for (std::size_t k = 0; k < kPoints; ++k)
  {
    const float o = interval.middle + interval.half * rule.point[k];
    squared[k] = o * o;
    steel[k] = water[k] = 0.0F;
  }
  const float scale = 2.0F * view.norm / view.a;
  for (const WireLayer& layer : profile)
  {
    const auto radius = static_cast<float>(layer.radius);
    const float limit = view.a * radius * radius;
    const auto steel_density = scale * static_cast<float>(layer.density.steel);
    const auto water_density = scale * static_cast<float>(layer.density.water);
    for (std::size_t k = 0; k < kPoints; ++k)
    {
      const float discriminant = limit - squared[k];
      const float root = std::sqrt(discriminant > 0.0F ? discriminant : 0.0F);
      steel[k] += root * steel_density;
      water[k] += root * water_density;
    }
  }
  const float height = 1.0F / (view.wide + view.flat);
  const float slope = 1.0F / (view.wide - view.flat + 1e-6F * view.wide);
  for (std::size_t k = 0; k < kPoints; ++k)
  {
    const float from_centre = std::abs(interval.middle + interval.half * rule.point[k] - view.off);
    float density = (view.wide - from_centre) * slope;
    density = density > 1.0F ? 1.0F : density;
    density = density > 0.0F ? density : 0.0F;
    part[k] = rule.weight[k] * density * (1.0F - fastExp(-opticalDepth(c, steel[k], water[k])));
  }
  float sum = 0.0F;
  for (const float value : part)
    sum += value;
  return sum * height * interval.half;
}

}  // namespace

PixelView::PixelView(const WireEdge& edge, const Eigen::Vector3d& ray, double focal_length)
{
  const double along = ray.dot(edge.axis);
  const double column = std::abs(edge.moment.x()) / focal_length, row = std::abs(edge.moment.y()) / focal_length;
  off = static_cast<float>(edge.moment.dot(ray));
  wide = static_cast<float>(0.5 * (column + row));
  flat = static_cast<float>(0.5 * std::abs(column - row));
  a = static_cast<float>(ray.squaredNorm() - along * along);
  norm = static_cast<float>(ray.norm());
}

double profileTransmission(const WireProfile& profile, double radius, const PixelView& view,
                           const DeviceCoefficients& coefficients)
{
  static const Rule kRule;
  const float rim = static_cast<float>(radius) * std::sqrt(view.a);
  const float low = std::max(view.off - view.wide, -rim), high = std::min(view.off + view.wide, rim);
  if (!(high > low))
    return 1.0;
  const Interval interval{0.5F * (low + high), 0.5F * (high - low)};
  return 1.0 - static_cast<double>(loss(profile, view, interval, coefficients, kRule));
}

}  // namespace endovascular_sim::fluoroscopy
