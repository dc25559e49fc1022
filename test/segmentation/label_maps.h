#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "image/volume.h"
#include "segmentation/labels/voxel_mask.h"

// Label maps of tubes whose surface is known.

namespace endovascular_sim::segmentation
{

/** Tube around a polyline [m]. */
struct ExactTube
{
  std::vector<Eigen::Vector3d> points;
  double radius = 0.0;

  /** Signed distance from the wall; the ends are round. */
  double at(const Eigen::Vector3d& p) const
  {
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
    {
      const Eigen::Vector3d step = points[k + 1] - points[k];
      const double t = std::clamp((p - points[k]).dot(step) / step.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (p - points[k] - t * step).norm());
    }
    return least - radius;
  }
};

/** Union of tubes. */
inline double distanceTo(const std::vector<ExactTube>& tubes, const Eigen::Vector3d& p)
{
  double least = std::numeric_limits<double>::max();
  for (const ExactTube& tube : tubes)
    least = std::min(least, tube.at(p));
  return least;
}

/** Arc of a circle in the plane of two perpendicular unit vectors. */
inline std::vector<Eigen::Vector3d> arc(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& u,
                                        const Eigen::Vector3d& w, double from, double to)
{
  constexpr int kPoints = 60;
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k <= kPoints; ++k)
  {
    const double angle = from + (to - from) * k / kPoints;
    points.emplace_back(centre + radius * (std::cos(angle) * u + std::sin(angle) * w));
  }
  return points;
}

/** Label map of a grid whose first voxel lies at an origin: tube n has the label n + 1. */
inline image::Volume labelMapOf(const std::vector<ExactTube>& tubes, const Eigen::Vector3i& size,
                                const Eigen::Vector3d& spacing, const Eigen::Vector3d& origin,
                                const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity())
{
  image::Volume volume;
  volume.grid = {size, spacing, origin, axes};
  volume.modality = image::Modality::kLabels;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
      {
        const Eigen::Vector3d p = volume.grid.position(Eigen::Vector3d(i, j, k));
        std::int16_t label = 0;
        double least = 0.0;
        for (std::size_t t = 0; t < tubes.size(); ++t)
          if (const double distance = tubes[t].at(p); distance < least)
          {
            least = distance;
            label = static_cast<std::int16_t>(t + 1);
          }
        volume.stored.push_back(label);
      }
  return volume;
}

/** Mask of all labels with empty layers around it. */
inline VoxelMask maskOf(const image::Volume& volume, int margin)
{
  VoxelMask mask(volume.grid.size + Eigen::Vector3i::Constant(2 * margin), volume.grid.spacing,
                 -static_cast<double>(margin) * volume.grid.spacing);
  for (int k = 0; k < volume.grid.size.z(); ++k)
    for (int j = 0; j < volume.grid.size.y(); ++j)
      for (int i = 0; i < volume.grid.size.x(); ++i)
        mask.inside[mask.offset(Eigen::Vector3i(i, j, k) + Eigen::Vector3i::Constant(margin))] =
            volume.stored[volume.grid.offset(i, j, k)] != 0 ? 1 : 0;
  return mask;
}

}  // namespace endovascular_sim::segmentation
