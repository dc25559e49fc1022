#include "flow/coupling/tree_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace endovascular_sim::flow
{
namespace
{

constexpr double kSpacing = 2e-3;    // least distance of two points [m]
constexpr double kShortest = 1e-6;   // the same of the last point from the one before [m]
constexpr double kWellWithin = 0.7;  // of the lumen's radius: a point there is of this branch

std::size_t indexOf(int branch)
{
  return static_cast<std::size_t>(branch);
}

}  // namespace

double Stretch::length() const
{
  return std::abs(to - from);
}

double TreePath::length() const
{
  double length = 0.0;
  for (const Stretch& stretch : stretches_)
    length += stretch.length();
  return length;
}

TreePlace TreePath::at(double distance) const
{
  if (stretches_.empty())
    return {};
  for (const Stretch& stretch : stretches_)
  {
    if (distance <= stretch.length())
    {
      const double gone = std::max(0.0, distance);
      return {stretch.branch, stretch.from + (stretch.to > stretch.from ? gone : -gone)};
    }
    distance -= stretch.length();
  }
  return {stretches_.back().branch, stretches_.back().to};
}

void TreePath::addSpans(double begin, double end, double radius, std::vector<InstrumentSpan>& spans) const
{
  double passed = 0.0;
  for (const Stretch& stretch : stretches_)
  {
    const double from = std::max(begin - passed, 0.0), to = std::min(end - passed, stretch.length());
    passed += stretch.length();
    if (from >= to)
      continue;
    const double sign = stretch.to > stretch.from ? 1.0 : -1.0;
    const double a = stretch.from + sign * from, b = stretch.from + sign * to;
    spans.push_back({stretch.branch, std::min(a, b), std::max(a, b), radius});
  }
}

TreePaths::Thinned TreePaths::thinned(const vessel::CentrelineTree& tree)
{
  Thinned result;
  for (const vessel::CentrelineBranch& branch : tree.branches)
  {
    Line& line = result.lines.emplace_back();
    vessel::CentrelineBranch& few = result.tree.branches.emplace_back();
    few.name = branch.name;
    few.parent = branch.parent;
    double arc = 0.0;
    for (std::size_t k = 0; k < branch.points.size(); ++k)
    {
      arc += k == 0 ? 0.0 : (branch.points[k] - branch.points[k - 1]).norm();
      const bool is_end = k + 1 == branch.points.size();
      if (!line.arcs.empty() && arc - line.arcs.back() < (is_end ? kShortest : kSpacing))
        continue;
      line.points.push_back(branch.points[k]);
      line.arcs.push_back(arc);
      line.radii.push_back(branch.radii[k]);
      few.points.push_back(branch.points[k]);
      few.radii.push_back(branch.radii[k]);
    }
  }
  return result;
}

TreePaths::TreePaths(const vessel::CentrelineTree& tree) : TreePaths(thinned(tree)) {}

TreePaths::TreePaths(Thinned thinned) : lines_(std::move(thinned.lines)), finder_(thinned.tree)
{
  for (const vessel::CentrelineBranch& branch : thinned.tree.branches)
    parents_.push_back(branch.parent);
  for (std::size_t b = 0; b < lines_.size(); ++b)
    on_parent_.push_back(parents_[b] < 0 ? 0.0 : lines_[indexOf(parents_[b])].nearest(lines_[b].points.front()));
}

/** Arc length of the nearest point [m]. */
double TreePaths::Line::nearest(const Eigen::Vector3d& point) const
{
  double arc = arcs.front(), nearest = (points.front() - point).squaredNorm();
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    const Eigen::Vector3d step = points[k] - points[k - 1];
    const double share = std::clamp((point - points[k - 1]).dot(step) / step.squaredNorm(), 0.0, 1.0);
    const double distance = (points[k - 1] + share * step - point).squaredNorm();
    if (distance >= nearest)
      continue;
    nearest = distance;
    arc = arcs[k - 1] + share * (arcs[k] - arcs[k - 1]);
  }
  return arc;
}

std::size_t TreePaths::Line::segmentAt(double arc) const
{
  const auto after = std::upper_bound(arcs.begin(), arcs.end(), arc);
  const auto k = static_cast<std::ptrdiff_t>(after - arcs.begin()) - 1;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, static_cast<std::ptrdiff_t>(arcs.size()) - 2));
}

TreePlace TreePaths::locate(const Eigen::Vector3d& point) const
{
  const int branch = finder_.nearest(point);
  return {branch, branch < 0 ? 0.0 : lines_[indexOf(branch)].nearest(point)};
}

TreePlace TreePaths::locate(const Eigen::Vector3d& point, const TreePlace& near) const
{
  if (near.branch < 0)
    return locate(point);
  const Line& line = lines_[indexOf(near.branch)];
  const double arc = line.nearest(point);
  const std::size_t k = line.segmentAt(arc);
  const double share = (arc - line.arcs[k]) / (line.arcs[k + 1] - line.arcs[k]);
  const Eigen::Vector3d foot = line.points[k] + share * (line.points[k + 1] - line.points[k]);
  const double radius = kWellWithin * std::min(line.radii[k], line.radii[k + 1]);
  const bool is_end = arc <= line.arcs.front() || arc >= line.arcs.back();
  return is_end || (point - foot).squaredNorm() > radius * radius ? locate(point) : TreePlace{near.branch, arc};
}

/** Places at which the way to the root leaves each branch, beginning with the place itself. */
std::vector<TreePlace> TreePaths::toRoot(const TreePlace& place) const
{
  std::vector<TreePlace> way = {place};
  while (parents_[indexOf(way.back().branch)] >= 0 && way.size() <= parents_.size())
    way.push_back({parents_[indexOf(way.back().branch)], on_parent_[indexOf(way.back().branch)]});
  return way;
}

TreePath TreePaths::between(const TreePlace& from, const TreePlace& to) const
{
  std::vector<Stretch> stretches;
  if (from.branch < 0 || to.branch < 0)
    return TreePath(stretches);
  const std::vector<TreePlace> up = toRoot(from), down = toRoot(to);
  const auto isCommon = [&down](const TreePlace& place)
  {
    return std::any_of(down.begin(), down.end(),
                       [&place](const TreePlace& other) { return other.branch == place.branch; });
  };
  std::size_t top = 0;
  for (; top < up.size() && !isCommon(up[top]); ++top)
    stretches.push_back({up[top].branch, up[top].arc, 0.0});
  if (top == up.size())
    return TreePath({});  // in two trees
  std::size_t below = 0;
  while (down[below].branch != up[top].branch)
    ++below;
  stretches.push_back({up[top].branch, up[top].arc, down[below].arc});
  for (; below > 0; --below)
    stretches.push_back({down[below - 1].branch, 0.0, down[below - 1].arc});
  return TreePath(std::move(stretches));
}

Eigen::Vector3d TreePaths::tangentAt(const TreePlace& place) const
{
  const Line& line = lines_[indexOf(place.branch)];
  const std::size_t k = line.segmentAt(place.arc);
  return (line.points[k + 1] - line.points[k]).normalized();
}

}  // namespace endovascular_sim::flow
