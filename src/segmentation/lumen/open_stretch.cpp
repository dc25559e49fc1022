#include "segmentation/lumen/open_stretch.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr int kProbes = 12;           ///< points of a ray that are looked for in other lumens
constexpr double kEndLength = 2.0;    ///< of a stretch at an end that does not count, in diameters
constexpr double kLongestEnd = 0.01;  ///< likewise [m]

std::vector<double> arcOf(const std::vector<Section>& sections)
{
  std::vector<double> arc(sections.size(), 0.0);
  for (std::size_t k = 1; k < sections.size(); ++k)
    arc[k] = arc[k - 1] + (sections[k].centre - sections[k - 1].centre).norm();
  return arc;
}

/** Mean over a length around every section, and over its neighbours at least. */
std::vector<double> runningMean(const std::vector<double>& values, const std::vector<double>& arc, double length)
{
  const double half = std::max(0.5 * length, arc.size() > 1 ? arc.back() / static_cast<double>(arc.size() - 1) : 0.0);
  std::vector<double> means(values.size(), 0.0);
  for (std::size_t k = 0; k < values.size(); ++k)
  {
    double sum = 0.0;
    int count = 0;
    for (std::size_t q = 0; q < values.size(); ++q)
      if (std::abs(arc[q] - arc[k]) <= 1.01 * half)
      {
        sum += values[q];
        ++count;
      }
    means[k] = sum / count;
  }
  return means;
}

}  // namespace

bool runsThroughOther(const Section& section, int ray, const OtherLumen& other)
{
  const double from = std::min(section.radii[static_cast<std::size_t>(ray)], section.reach);
  for (int k = 0; other && k <= kProbes; ++k)
    if (other(section.centre + (from + (section.reach - from) * k / kProbes) * section.direction(ray)))
      return true;
  return false;
}

double openShare(const Section& section, const OtherLumen& other, bool dropped)
{
  int open = 0;
  for (int ray = 0; ray < kRays; ++ray)
  {
    const RayEnd end = section.ends[static_cast<std::size_t>(ray)];
    if (end == RayEnd::kOpen || (dropped && end == RayEnd::kDropped))
      open += runsThroughOther(section, ray, other) ? 0 : 1;
  }
  return static_cast<double>(open) / kRays;
}

std::vector<OpenStretch> openStretches(const std::vector<Section>& sections, const OtherLumen& other, bool dropped,
                                       double most)
{
  const std::vector<double> arc = arcOf(sections);
  std::vector<double> shares;
  for (const Section& section : sections)
    shares.push_back(openShare(section, {}, dropped));
  std::vector<double> means = runningMean(shares, arc, kOpenLength);
  if (other && *std::max_element(means.begin(), means.end()) > most)
  {
    for (std::size_t k = 0; k < sections.size(); ++k)
      shares[k] = openShare(sections[k], other, dropped);
    means = runningMean(shares, arc, kOpenLength);
  }
  const std::size_t n = sections.size();
  std::vector<OpenStretch> stretches;
  for (std::size_t k = 0; k < n; ++k)
  {
    if (means[k] <= most)
      continue;
    OpenStretch stretch{k, k, means[k]};
    for (; k < n && means[k] > most; ++k)
    {
      stretch.last = k;
      stretch.share = std::max(stretch.share, means[k]);
    }
    const double length = arc[stretch.last] - arc[stretch.first];
    const std::size_t beside = stretch.first == 0 ? std::min(n - 1, stretch.last + 1) : stretch.first - 1;
    const bool is_end = stretch.first == 0 || stretch.last + 1 == n;
    if (!is_end || length > std::min(kEndLength * sections[beside].diameter(), kLongestEnd))
      stretches.push_back(stretch);
  }
  return stretches;
}

}  // namespace endovascular_sim::segmentation
