#include "segmentation/lumen/contour_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "segmentation/lumen/median.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Radii = std::array<double, kRays>;

constexpr int kRadiusWindow = 5;     ///< sections on both sides in the median radius
constexpr int kWindow = 2;           ///< sections on both sides in the medians of the contours
constexpr double kLargest = 1.6;     ///< edges of a section lie between these multiples of its radius
constexpr double kLeast = 0.25;      ///< likewise
constexpr double kWide = 4e-3;       ///< radius from which an edge may fit its neighbours only [m]
constexpr int kNeighbours = 3;       ///< rays on both sides that an edge has to fit
constexpr double kMissing = 0.1;     ///< largest share of neighbours without an edge
constexpr double kFits = 1.6;        ///< largest ratio of an edge to the median of its neighbours
constexpr double kTolerance = 1e-4;  ///< of a contour across the edge, for most of the rays [m]
constexpr double kBlurred = 0.25;    ///< likewise, in standard deviations of the blur
constexpr double kMost = 0.9;        ///< quantile of the deviations that is compared with it

/** Smoothing of a contour. */
struct Smoothing
{
  int rays;       ///< on both sides in the medians
  int harmonics;  ///< of the contour
};
constexpr std::array<Smoothing, 3> kSmoothings = {{{2, 4}, {1, 10}, {0, kRays / 2}}};  ///< strongest first
constexpr double kResolved = 0.6;  ///< harmonics per radius, in standard deviations of the blur
constexpr int kRaysOfCircle = 8;   ///< on both sides in the medians of a lumen of which the blur leaves a circle
constexpr int kRaysOfEllipse = 4;  ///< likewise of an ellipse

std::size_t wrapped(int ray)
{
  return static_cast<std::size_t>((ray + kRays) % kRays);
}

/** Edges of the neighbours of a ray.
 *  @param missing receives the number of neighbours without an edge */
std::vector<double> neighbours(const RayTable& edges, std::size_t section, int ray, int window, int* missing = nullptr)
{
  const auto n = static_cast<std::ptrdiff_t>(edges.radii.size());
  const auto k = static_cast<std::ptrdiff_t>(section);
  std::vector<double> values;
  int without = 0;
  for (std::ptrdiff_t s = std::max<std::ptrdiff_t>(0, k - kWindow); s <= std::min(n - 1, k + kWindow); ++s)
    for (int b = -window; b <= window; ++b)
    {
      const double r = edges.radii[static_cast<std::size_t>(s)][wrapped(ray + b)];
      if (r > 0.0)
        values.push_back(r);
      else
        ++without;
    }
  if (missing != nullptr)
    *missing = without;
  return values;
}

bool fitsNeighbours(const RayTable& edges, std::size_t section, int ray)
{
  int missing = 0;
  std::vector<double> values = neighbours(edges, section, ray, kNeighbours, &missing);
  if (values.empty() || missing > kMissing * static_cast<double>(values.size() + static_cast<std::size_t>(missing)))
    return false;
  const double ratio = edges.radii[section][static_cast<std::size_t>(ray)] / median(values);
  return ratio < kFits && ratio > 1.0 / kFits;
}

Radii filledRadii(const RayTable& edges, std::size_t section, double radius, int window)
{
  Radii filled{};
  const std::size_t enough = window > 0 ? 3 : 1;
  for (int ray = 0; ray < kRays; ++ray)
  {
    std::vector<double> values = neighbours(edges, section, ray, window);
    if (values.size() <= enough && window < kWindow)
      values = neighbours(edges, section, ray, kWindow);
    filled[static_cast<std::size_t>(ray)] = values.size() > enough ? median(values) : radius;
  }
  return filled;
}

Radii fourierSeries(const Radii& values, int harmonics)
{
  if (harmonics >= kRays / 2)
    return values;
  Radii series{};
  for (int h = 0; h <= harmonics; ++h)
  {
    double a = 0.0;
    double b = 0.0;
    const double angle = 2.0 * M_PI * h / kRays;
    for (int ray = 0; ray < kRays; ++ray)
    {
      a += values[static_cast<std::size_t>(ray)] * std::cos(angle * ray);
      b += values[static_cast<std::size_t>(ray)] * std::sin(angle * ray);
    }
    const double factor = (h == 0 ? 1.0 : 2.0) / kRays;
    for (int ray = 0; ray < kRays; ++ray)
      series[static_cast<std::size_t>(ray)] += factor * (a * std::cos(angle * ray) + b * std::sin(angle * ray));
  }
  return series;
}

/** Smoothing of a contour whose finer shape the blur does not resolve: the harmonic m of a contour of radius R is
 * damped by exp(−m²σ²/2R²). What remains of the higher ones in a narrow lumen is noise. */
Smoothing smoothingOf(double radius, double blur)
{
  Smoothing smoothing = kSmoothings.front();
  const int resolved = static_cast<int>(kResolved * radius / blur);
  smoothing.harmonics = std::clamp(resolved, 0, smoothing.harmonics);
  if (smoothing.harmonics <= 2)
    smoothing.rays = smoothing.harmonics == 2 ? kRaysOfEllipse : kRaysOfCircle;
  return smoothing;
}

/** Deviation of a contour from edges, across the contour: its quantile over the rays with an edge [m]. */
double deviation(const Radii& contour, const Radii& edges, const std::array<double, kRays>& found)
{
  std::vector<double> deviations;
  for (int ray = 0; ray < kRays; ++ray)
  {
    const auto r = static_cast<std::size_t>(ray);
    if (found[r] <= 0.0)
      continue;
    const double slope = (edges[wrapped(ray + 1)] - edges[wrapped(ray - 1)]) / (4.0 * M_PI / kRays);
    deviations.push_back(std::abs(contour[r] - edges[r]) * edges[r] / std::hypot(edges[r], slope));
  }
  if (deviations.empty())
    return 0.0;
  std::sort(deviations.begin(), deviations.end());
  return deviations[static_cast<std::size_t>(kMost * static_cast<double>(deviations.size() - 1))];
}

Radii contourOf(const RayTable& edges, std::size_t section, double radius, double blur)
{
  const auto smoothed = [&](const Smoothing& smoothing)
  { return fourierSeries(filledRadii(edges, section, radius, smoothing.rays), smoothing.harmonics); };
  Radii contour = smoothed(smoothingOf(radius, blur));
  if (radius < kWide)
    return contour;
  const Radii along = filledRadii(edges, section, radius, 0);
  const double tolerance = std::max(kTolerance, kBlurred * blur);
  for (std::size_t level = 1; level < kSmoothings.size() && deviation(contour, along, edges.radii[section]) > tolerance;
       ++level)
    contour = smoothed(kSmoothings[level]);
  return contour;
}

}  // namespace

std::vector<double> medianRadii(const std::vector<Section>& sections, const RayTable& edges)
{
  const auto n = static_cast<std::ptrdiff_t>(sections.size());
  std::vector<double> radii(sections.size(), 0.0);
  for (std::ptrdiff_t window = kRadiusWindow; window < 2 * n; window *= 2)
  {
    bool complete = true;
    for (std::ptrdiff_t k = 0; k < n; ++k)
    {
      if (radii[static_cast<std::size_t>(k)] > 0.0)
        continue;
      std::vector<double> values;
      for (std::ptrdiff_t q = std::max<std::ptrdiff_t>(0, k - window); q <= std::min(n - 1, k + window); ++q)
        for (const double r : edges.radii[static_cast<std::size_t>(q)])
          if (r > 0.0)
            values.push_back(r);
      if (values.size() > kRays / 2)
        radii[static_cast<std::size_t>(k)] = median(values);
      else
        complete = false;
    }
    if (complete)
      return radii;
  }
  for (std::size_t k = 0; k < sections.size(); ++k)
    radii[k] = radii[k] > 0.0 ? radii[k] : 0.3 * sections[k].reach;
  return radii;
}

void dropOutliers(const std::vector<double>& radius, RayTable& edges)
{
  const RayTable before = edges;
  for (std::size_t k = 0; k < radius.size(); ++k)
    for (int ray = 0; ray < kRays; ++ray)
    {
      double& r = edges.radii[k][static_cast<std::size_t>(ray)];
      const bool fits = r <= kLargest * radius[k] && r >= kLeast * radius[k];
      if (fits || (radius[k] > kWide && r > 0.0 && fitsNeighbours(before, k, ray)))
        continue;
      if (r > 0.0)
        edges.ends[k][static_cast<std::size_t>(ray)] = RayEnd::kDropped;
      r = -1.0;
    }
}

void setContours(const std::vector<double>& radius, const RayTable& edges, std::vector<Section>& sections)
{
  for (std::size_t k = 0; k < sections.size(); ++k)
  {
    sections[k].ends = edges.ends[k];
    sections[k].radii = contourOf(edges, k, radius[k], sections[k].blur);
    for (double& r : sections[k].radii)
      r = std::max(r, 0.1 * radius[k]);
  }
}

}  // namespace endovascular_sim::segmentation
