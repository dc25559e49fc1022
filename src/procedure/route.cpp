#include "procedure/route.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kSpacing = 1e-3;  // spacing of the path's points [m]

/** Branches from a branch to the root of the tree. */
std::vector<int> toRoot(const BranchLocator& locator, int branch)
{
  std::vector<int> chain;
  for (; branch >= 0 && static_cast<int>(chain.size()) <= locator.branches(); branch = locator.parent(branch))
    chain.push_back(branch);
  return chain;
}

/** Appends the part of a branch between two arc lengths, in this direction. */
void append(const geometry::Polyline& line, double begin, double end, std::vector<Eigen::Vector3d>& points)
{
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(end - begin) / kSpacing)));
  for (int k = 0; k <= pieces; ++k)
    points.push_back(line.at(begin + (end - begin) * k / pieces));
}

/** Points of the path. The path ascends to the lowest common ancestor of both branches and descends to the goal. */
std::vector<Eigen::Vector3d> pathPoints(const BranchLocator& locator, int from, const Eigen::Vector3d& entry, int to)
{
  const std::vector<int> up = toRoot(locator, from);
  std::vector<int> down = toRoot(locator, to);
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d start = entry;
  std::size_t k = 0;
  for (; std::find(down.begin(), down.end(), up[k]) == down.end() && k + 1 < up.size(); ++k)
  {
    const geometry::Polyline& line = locator.line(up[k]);
    append(line, line.nearest(start).arc, 0.0, points);
    start = line.points().front();
  }
  down.erase(std::find(down.begin(), down.end(), up[k]), down.end());
  std::reverse(down.begin(), down.end());
  const geometry::Polyline& top = locator.line(up[k]);
  append(top, top.nearest(start).arc, down.empty() ? 0.0 : top.nearest(locator.line(down.front()).points().front()).arc,
         points);
  for (std::size_t j = 0; j < down.size(); ++j)
  {
    const geometry::Polyline& line = locator.line(down[j]);
    append(line, 0.0,
           j + 1 < down.size() ? line.nearest(locator.line(down[j + 1]).points().front()).arc : line.length(), points);
  }
  return points;
}

}  // namespace

Route::Route(const BranchLocator& locator, int from, const Eigen::Vector3d& entry, int to)
  : line_(pathPoints(locator, from, entry, to))
{
  const std::vector<bool> on_way = locator.pathBetween(from, to);
  for (int b = 0; b < locator.branches(); ++b)
  {
    const int parent = locator.parent(b);
    if (parent < 0 || !on_way[static_cast<std::size_t>(parent)])
      continue;
    const geometry::Polyline& above = locator.line(parent);
    const Eigen::Vector3d& mouth = locator.line(b).points().front();
    const bool continues = above.length() - above.nearest(mouth).arc < kSpacing;
    if (const geometry::Polyline::Foot foot = line_.nearest(mouth);
        foot.distance < kSpacing && !(continues && on_way[static_cast<std::size_t>(b)]))
      junctions_.push_back(foot.arc);
  }
  std::sort(junctions_.begin(), junctions_.end());
}

double Route::toJunction(double arc) const
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const double junction : junctions_)
    if (std::abs(junction - arc) < std::abs(nearest))
      nearest = junction - arc;
  return nearest;
}

}  // namespace endovascular_sim::procedure
