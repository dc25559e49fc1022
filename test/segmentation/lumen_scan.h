#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/numerics/counter_noise.h"
#include "image/volume.h"
#include "phantom/phantom.h"
#include "segmentation/clicks/click_set.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Distance of a point [mm] from the wall of a lumen [mm], negative inside; exact near the wall. */
using Lumen = std::function<double(const Eigen::Vector3d&)>;

/** Round tube about a polyline [mm], with a radius [mm] as a function of the share of its length, and flat ends. */
inline Lumen tubeAlong(const std::vector<Eigen::Vector3d>& points, const std::function<double(double)>& radius)
{
  std::vector<double> arc{0.0};
  for (std::size_t k = 1; k < points.size(); ++k)
    arc.push_back(arc.back() + (points[k] - points[k - 1]).norm());
  return [points, arc, radius](const Eigen::Vector3d& p)
  {
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
    {
      const Eigen::Vector3d step = points[k + 1] - points[k];
      const double along = (p - points[k]).dot(step) / step.squaredNorm();
      const double t = std::clamp(along, 0.0, 1.0);
      const double r = radius((arc[k] + t * (arc[k + 1] - arc[k])) / arc.back());
      double d = (points[k] + t * step - p).norm() - r;
      if ((k == 0 && along < 0.0) || (k + 2 == points.size() && along > 1.0))
        d = std::max(d, std::abs(along - t) * step.norm());
      least = std::min(least, d);
    }
    return least;
  };
}

inline Lumen tubeAlong(const std::vector<Eigen::Vector3d>& points, double radius)
{
  return tubeAlong(points, [radius](double) { return radius; });
}

/** CT angiogram of lumens in fat: 340 HU, walls of 0.8 mm and 60 HU, point spread 0.3 mm, noise 15 HU. The walls are
 * blurred as planes.
 *  @param low, high corners of the image [mm]
 *  @param spacing of the voxels [mm] */
inline image::Volume scanOfLumens(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double spacing,
                                  const std::vector<Lumen>& lumens)
{
  image::Volume volume;
  volume.grid = phantom::gridOfBox(1e-3 * low, 1e-3 * high, Eigen::Vector3d::Constant(1e-3 * spacing));
  const double blur = std::sqrt(0.3 * 0.3 + spacing * spacing / 12.0);
  const auto inside = [blur](double distance) { return 0.5 * std::erfc(distance / blur / std::sqrt(2.0)); };
  const Eigen::Vector3i& size = volume.grid.size;
  std::vector<float> a(volume.grid.voxels() / 2 + 1);
  std::vector<float> b(a.size());
  CounterNoise(1, 7).fill(0, static_cast<int>(a.size()), a.data(), b.data());
  volume.stored.reserve(volume.grid.voxels());
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
      {
        const Eigen::Vector3d p = 1e3 * volume.grid.position(Eigen::Vector3d(i, j, k));
        double lumen = 0.0;
        double wall = 0.0;
        for (const Lumen& distance : lumens)
        {
          const double d = distance(p);
          lumen += inside(d);
          wall = std::max(wall, inside(d - 0.8));
        }
        lumen = std::min(lumen, 1.0);
        wall = std::max(0.0, wall - lumen);
        const std::size_t n = volume.stored.size();
        const double noise = 15.0 * (n % 2 == 0 ? a[n / 2] : b[n / 2]);
        volume.stored.push_back(
            static_cast<std::int16_t>(std::lround(340.0 * lumen + 60.0 * wall - 80.0 * (1.0 - lumen - wall) + noise)));
      }
  return volume;
}

/** Clicks [mm] into branches. */
inline ClickSet clicksInto(const std::vector<std::pair<std::string, std::vector<Eigen::Vector3d>>>& branches)
{
  ClickSet set;
  set.file = "clicks.yaml";
  for (const auto& [name, places] : branches)
  {
    BranchClicks branch;
    branch.name = name;
    for (const Eigen::Vector3d& p : places)
      branch.clicks.push_back({1e-3 * p, "line"});
    set.branches.push_back(branch);
  }
  return set;
}

/** Distances of contours from the wall of a lumen [mm]. */
struct ContourErrors
{
  double p95 = 0.0;
  double largest = 0.0;
};

/** @param counts chooses the points that count [mm] */
template <typename Condition>
ContourErrors contourErrors(const std::vector<Section>& sections, const Eigen::Vector3d& origin, const Lumen& lumen,
                            const Condition& counts)
{
  std::vector<double> distances;
  for (const Section& section : sections)
    for (int ray = 0; ray < kRays; ++ray)
    {
      const Eigen::Vector3d p =
          1e3 * (origin + section.centre + section.radii[static_cast<std::size_t>(ray)] * section.direction(ray));
      if (counts(p))
        distances.push_back(std::abs(lumen(p)));
    }
  std::sort(distances.begin(), distances.end());
  ContourErrors errors;
  if (!distances.empty())
  {
    errors.p95 = distances[distances.size() * 95 / 100];
    errors.largest = distances.back();
  }
  return errors;
}

}  // namespace endovascular_sim::segmentation
