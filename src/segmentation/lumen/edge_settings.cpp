#include "segmentation/lumen/edge_settings.h"

#include <cmath>

namespace endovascular_sim::segmentation
{

EdgeSettings edgeSettings(image::Modality modality, const Eigen::Vector3d& spacing)
{
  EdgeSettings settings;
  if (modality == image::Modality::kCt)
    return settings;
  settings.point_spread = 0.55 * std::cbrt(spacing.prod());
  settings.wall = 0.0;
  settings.calcium = 0.0;
  return settings;
}

double blurAcross(const EdgeSettings& settings, const Eigen::Vector3d& spacing, const Eigen::Vector3d& tangent)
{
  const Eigen::Vector3d squares = spacing.cwiseAbs2();
  const double across = 0.5 * (squares.sum() - tangent.cwiseAbs2().dot(squares));
  return std::sqrt(settings.point_spread * settings.point_spread + 0.25 * across);
}

}  // namespace endovascular_sim::segmentation
