#include "segmentation/gentle_bends.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/spline.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kWanted = 1.08;         ///< ratio, with a margin for other samples of the same spline
constexpr double kSampleSpacing = 0.25;  ///< in radii of the lumen, as in an anatomy
constexpr int kSmoothings = 60;
constexpr int kReductions = 200;
constexpr double kReduction = 0.97;  ///< of a radius in one round
constexpr double kLeastShare = 0.5;  ///< of a radius after a shift

/** Tightest bend of a branch, relative to the one that is permitted. */
struct Bend
{
  double ratio = 1e30;
  std::size_t point = 0;  ///< nearest point of the branch
};

Bend tightestBend(const vessel::CentrelineBranch& branch)
{
  const geometry::Spline3 spline(branch.points);
  const std::vector<double>& knots = spline.knots();
  const geometry::MonotoneCubic radius(knots, branch.radii);
  const double spacing = kSampleSpacing * *std::min_element(branch.radii.begin(), branch.radii.end());
  const int count = std::max(8, static_cast<int>(std::ceil(knots.back() / spacing)));
  Bend tightest;
  Eigen::Vector3d before = spline.derivative(0.0);
  for (int k = 1; k <= count; ++k)
  {
    const double from = knots.back() * (k - 1) / count;
    const double to = knots.back() * k / count;
    const Eigen::Vector3d here = spline.derivative(to);
    const double turn = (here.normalized() - before.normalized()).norm();
    const double length = 0.5 * (before.norm() + here.norm()) * (to - from);
    const double lumen = std::max(radius(from), radius(to));
    const double ratio = length / std::max(1e-12, turn * vessel::kTightestBend * lumen);
    if (ratio < tightest.ratio)
    {
      const auto next = std::lower_bound(knots.begin(), knots.end(), 0.5 * (from + to));
      tightest = {ratio, static_cast<std::size_t>(next - knots.begin())};
      if (tightest.point > 0 && 0.5 * (from + to) - knots[tightest.point - 1] < *next - 0.5 * (from + to))
        --tightest.point;
    }
    before = here;
  }
  return tightest;
}

/** Interior points beside a point: first and behind the last one. */
std::pair<std::size_t, std::size_t> neighbours(std::size_t point, std::size_t points)
{
  return {std::max<std::size_t>(2, point) - 1, std::min(point + 2, points - 1)};
}

}  // namespace

double bendRatio(const vessel::CentrelineBranch& branch)
{
  return tightestBend(branch).ratio;
}

void makeBendsGentle(vessel::CentrelineBranch& branch)
{
  const std::vector<Eigen::Vector3d> given = branch.points;
  const std::vector<double> inscribed = branch.radii;
  const std::size_t n = given.size();
  for (int round = 0; round < kSmoothings; ++round)
  {
    const Bend bend = tightestBend(branch);
    if (bend.ratio >= kWanted)
      return;
    const std::vector<Eigen::Vector3d> before = branch.points;
    const auto [begin, end] = neighbours(bend.point, n);
    for (std::size_t k = begin; k < end; ++k)
    {
      branch.points[k] = 0.5 * before[k] + 0.25 * (before[k - 1] + before[k + 1]);
      branch.radii[k] = std::max(kLeastShare * inscribed[k], inscribed[k] - (branch.points[k] - given[k]).norm());
    }
  }
  for (int round = 0; round < kReductions; ++round)
  {
    const Bend bend = tightestBend(branch);
    if (bend.ratio >= kWanted)
      return;
    const std::size_t begin = bend.point > 0 ? bend.point - 1 : 0;
    for (std::size_t k = begin; k < std::min(bend.point + 2, n); ++k)
      branch.radii[k] *= kReduction;
  }
}

}  // namespace endovascular_sim::segmentation
