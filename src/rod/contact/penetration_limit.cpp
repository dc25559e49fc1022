#include "rod/contact/penetration_limit.h"

#include <algorithm>
#include <cmath>

#include "rod/contact/wall_compliance.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kTolerated = 80e-6;  // m
constexpr double kShareToAxis = 0.8;

}  // namespace

/** Depth beyond the tolerated one [m]; 0 for the compliant part of a wall. */
double PenetrationLimit::excess(const contact::Feature& feature) const
{
  const bool soft = std::isfinite(feature.stiffness);
  if (soft && !isStiffLayer(feature))
    return 0.0;
  const double radius = wireRadiusAt(feature, rod_);
  const double to_axis = soft ? radius - softWallTravel(radius) : radius;
  return std::max(0.0, -feature.gap - std::min(kTolerated, kShareToAxis * to_axis));
}

void PenetrationLimit::store(const ContactList& contacts, int mouth_edge, double mouth)
{
  stored_.assign(static_cast<std::size_t>(rod_.nodes()), 0.0);
  for (std::size_t f = 0; f < contacts.detected(); ++f)
  {
    const contact::Feature& feature = contacts.set.features[f];
    const double depth = excess(feature);
    const bool in_mouth = feature.edge == mouth_edge && feature.parameter <= mouth;
    if (feature.parameter < 1.0)
      stored_[feature.edge] = std::max(stored_[feature.edge], depth);
    if (feature.parameter > 0.0 && !in_mouth)
      stored_[feature.edge + 1] = std::max(stored_[feature.edge + 1], depth);
  }
}

bool PenetrationLimit::isExceeded(const ContactList& contacts) const
{
  for (std::size_t f = 0; f < contacts.detected(); ++f)
  {
    const contact::Feature& feature = contacts.set.features[f];
    const double first = feature.parameter < 1.0 ? stored_[feature.edge] : 0.0;
    const double second = feature.parameter > 0.0 ? stored_[feature.edge + 1] : 0.0;
    if (excess(feature) > std::max(first, second))
      return true;
  }
  return false;
}

}  // namespace endovascular_sim::rod
