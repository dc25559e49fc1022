#include "segmentation/lumen/section.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kAngle = 2.0 * M_PI / kRays;  ///< between two rays

}  // namespace

Eigen::Vector3d Section::direction(int ray) const
{
  return std::cos(ray * kAngle) * u + std::sin(ray * kAngle) * w;
}

double Section::edges() const
{
  const auto is_edge = [](RayEnd end) { return end != RayEnd::kOpen && end != RayEnd::kDropped; };
  return static_cast<double>(std::count_if(ends.begin(), ends.end(), is_edge)) / kRays;
}

double Section::share(RayEnd end) const
{
  return static_cast<double>(std::count(ends.begin(), ends.end(), end)) / kRays;
}

double Section::radiusAt(double angle) const
{
  double place = angle / kAngle;
  place -= kRays * std::floor(place / kRays);
  const auto k = static_cast<std::size_t>(place) % kRays;
  const double f = place - std::floor(place);
  return radii[k] + f * (radii[(k + 1) % kRays] - radii[k]);
}

double Section::area() const
{
  double sum = 0.0;
  for (std::size_t k = 0; k < kRays; ++k)
    sum += radii[k] * radii[k];
  return 0.5 * kAngle * sum;
}

double Section::diameter() const
{
  return 2.0 * std::sqrt(area() / M_PI);
}

Eigen::Vector3d Section::centroid() const
{
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int k = 0; k < kRays; ++k)
    moment += std::pow(radii[static_cast<std::size_t>(k)], 3) / 3.0 * kAngle * direction(k);
  return centre + moment / area();
}

std::vector<double> LumenBranch::arc() const
{
  std::vector<double> arc;
  for (std::size_t k = 0; k < sections.size(); ++k)
    arc.push_back(k == 0 ? 0.0 : arc.back() + (sections[k].centre - sections[k - 1].centre).norm());
  return arc;
}

}  // namespace endovascular_sim::segmentation
