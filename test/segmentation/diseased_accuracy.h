#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "phantom/diseased_vessel.h"
#include "segmentation/segment_vessel.h"
#include "segmentation/surface/tube.h"

namespace endovascular_sim::segmentation
{

/** Differences of the contours of a diseased vessel from its exact lumen, without the ends. */
struct DiseasedAccuracy
{
  double mean = 0.0;      ///< from the contours to the wall [m]
  double p95 = 0.0;       ///< [m]
  double largest = 0.0;   ///< [m]
  double back = 0.0;      ///< 95th percentile of the distance from the wall to the contours [m]
  double farthest = 0.0;  ///< largest of these distances [m]

  void print(const char* name) const
  {
    std::printf("%s: mean %.3f, 95 %% %.3f, largest %.3f, back 95 %% %.3f, largest %.3f mm\n", name, 1e3 * mean,
                1e3 * p95, 1e3 * largest, 1e3 * back, 1e3 * farthest);
  }
};

/** Clicks of a diseased vessel. */
inline ClickSet clicksInto(const phantom::DiseasedVessel& vessel, double largest_radius = 0.0)
{
  ClickSet set;
  set.file = "clicks";
  BranchClicks branch;
  branch.name = "vessel";
  branch.largest_radius = largest_radius;
  for (const Eigen::Vector3d& p : vessel.clicks())
    branch.clicks.push_back({p, "simulated"});
  set.branches.push_back(branch);
  return set;
}

/** Points of the exact wall in a plane across the axis. */
inline std::vector<Eigen::Vector3d> wallPoints(const phantom::DiseasedVessel& vessel, double z)
{
  constexpr int kDirections = 72;
  constexpr double kFarthest = 0.06;  // m
  double low = kFarthest;
  double high = -kFarthest;
  for (double x = -kFarthest; x <= kFarthest; x += 5e-5)
    if (vessel.toWall({x, 0.0, z}) < 0.0)
    {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  const Eigen::Vector3d centre(0.5 * (low + high), 0.0, z);
  std::vector<Eigen::Vector3d> points;
  for (int n = 0; n < kDirections; ++n)
  {
    const double angle = 2.0 * M_PI * n / kDirections;
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
    double inside = 0.0;
    double outside = kFarthest;
    for (int k = 0; k < 40; ++k)
    {
      const double middle = 0.5 * (inside + outside);
      (vessel.toWall(centre + middle * direction) < 0.0 ? inside : outside) = middle;
    }
    points.push_back(centre + inside * direction);
  }
  return points;
}

inline DiseasedAccuracy accuracyOf(const phantom::DiseasedVessel& vessel, const Scan& scan, const LumenBranch& branch)
{
  constexpr double kMargin = 5e-3;  // m: beside flat ends
  const double first = vessel.clicks().front().z() + kMargin;
  const double last = vessel.clicks().back().z() - kMargin;
  std::vector<double> there;
  for (const Section& section : branch.sections)
    for (int ray = 0; ray < kRays; ++ray)
    {
      const Eigen::Vector3d p =
          scan.toPatient(section.centre + section.radii[static_cast<std::size_t>(ray)] * section.direction(ray));
      if (p.z() > first && p.z() < last)
        there.push_back(std::abs(vessel.toWall(p)));
    }
  const Tube tube(branch.sections, 0.04);
  std::vector<double> back;
  for (double z = first; z < last; z += 5e-4)
    for (const Eigen::Vector3d& p : wallPoints(vessel, z))
      back.push_back(std::abs(tube.at(scan.toGrid(p)).distance));
  std::sort(there.begin(), there.end());
  std::sort(back.begin(), back.end());
  DiseasedAccuracy result;
  for (const double d : there)
    result.mean += d / static_cast<double>(there.size());
  result.p95 = there[there.size() * 95 / 100];
  result.largest = there.back();
  result.back = back[back.size() * 95 / 100];
  result.farthest = back.back();
  return result;
}

}  // namespace endovascular_sim::segmentation
