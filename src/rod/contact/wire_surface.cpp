#include "rod/contact/wire_surface.h"

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::rod
{

bool WireSurface::hasWideBalloon() const
{
  for (std::size_t i = 0; i < least_radius_.size(); ++i)
    if (isWide(least_radius_[i]) && least_radius_[i] > rod_.radius[i])
      return true;
  return false;
}

bool WireSurface::isWideAround(int node) const
{
  return isWide(std::max({radius(std::max(0, node - 1)), radius(node), radius(std::min(node + 1, nodes() - 1))}));
}

double WireSurface::gapTo(const contact::Feature& feature, const State& state) const
{
  const double t = feature.parameter;
  const int next = std::min(feature.edge + 1, nodes() - 1);
  const Eigen::Vector3d axis = (1.0 - t) * state.position[feature.edge] + t * state.position[next];
  const double surface = (1.0 - t) * radius(feature.edge) + t * radius(next);
  return feature.normal.dot(axis - feature.point) - surface;
}

void WireSurface::archive(Archive& archive)
{
  archive(least_radius_);
  if (!archive.reading())
    return;
  requireLength(least_radius_.empty() ? 0 : static_cast<std::size_t>(nodes()), least_radius_);
  requireFinite(least_radius_);
}

}  // namespace endovascular_sim::rod
