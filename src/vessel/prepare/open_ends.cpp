#include "vessel/prepare/open_ends.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <set>

#include "common/error.h"
#include "vessel/repair/end_clipping.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Largest distance from a cut of removed vertices, in radii, in addition to the distance of the tip. */
constexpr double kReach = 4.0;

const std::string& nameOf(const CentrelineTree& tree, const CentrelineEnd& end)
{
  return tree.branches[static_cast<std::size_t>(end.branch)].name;
}

[[noreturn]] void reject(const CentrelineTree& tree, const std::vector<CentrelineEnd>& ends, const std::string& option,
                         const std::string& source)
{
  std::string list;
  for (const CentrelineEnd& end : ends)
    list += (list.empty() ? "" : ", ") + nameOf(tree, end) + " near " + formatLocation(end.position);
  throw InputError(source, option,
                   "matches no end; specify all, largest, a count up to " + std::to_string(ends.size()) +
                       ", x,y,z in metres, or a branch: " + list);
}

/** Indices of the ends by decreasing radius. */
std::vector<std::size_t> byRadius(const std::vector<CentrelineEnd>& ends)
{
  std::vector<std::size_t> order(ends.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&ends](std::size_t a, std::size_t b) { return ends[a].radius > ends[b].radius; });
  return order;
}

/** Adds the ends that match a selector.
 *  @return false if there are none */
bool select(const CentrelineTree& tree, const std::vector<CentrelineEnd>& ends, const std::string& selector,
            std::set<std::size_t>& selected)
{
  const std::vector<std::size_t> order = byRadius(ends);
  const bool is_count =
      !selector.empty() && selector.size() < 6 && selector.find_first_not_of("0123456789") == std::string::npos;
  std::size_t count = 0;
  if (selector == "all")
    count = ends.size();
  else if (selector == "largest")
    count = 1;
  else if (is_count)
    count = static_cast<std::size_t>(std::stoul(selector));
  if (count > 0 && count <= ends.size())
  {
    selected.insert(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
    return true;
  }
  Eigen::Vector3d location;
  char rest = 0;
  if (std::sscanf(selector.c_str(), "%lf,%lf,%lf%c", &location.x(), &location.y(), &location.z(), &rest) == 3)
  {
    const auto nearest = std::min_element(ends.begin(), ends.end(),
                                          [&location](const CentrelineEnd& a, const CentrelineEnd& b)
                                          { return (a.position - location).norm() < (b.position - location).norm(); });
    selected.insert(static_cast<std::size_t>(nearest - ends.begin()));
    return true;
  }
  const std::size_t before = selected.size();
  for (std::size_t k = 0; k < ends.size(); ++k)
    if (nameOf(tree, ends[k]) == selector)
      selected.insert(k);
  return selected.size() > before;
}

}  // namespace

std::vector<CentrelineEnd> selectEnds(const CentrelineTree& tree, const std::vector<std::string>& selectors,
                                      const std::string& source)
{
  const std::vector<CentrelineEnd> ends = centrelineEnds(tree);
  std::vector<CentrelineEnd> result;
  for (const std::size_t k : matchingEnds(tree, ends, selectors, "--open", source))
    result.push_back(ends[k]);
  return result;
}

std::vector<std::size_t> matchingEnds(const CentrelineTree& tree, const std::vector<CentrelineEnd>& ends,
                                      const std::vector<std::string>& selectors, const std::string& option,
                                      const std::string& source)
{
  std::set<std::size_t> selected;
  for (const std::string& selector : selectors)
    if (!select(tree, ends, selector, selected))
      reject(tree, ends, std::string(option).append(" ").append(selector), source);
  return {selected.begin(), selected.end()};
}

Opening openEnd(geometry::TriangleMesh& mesh, const CentrelineTree& tree, const CentrelineEnd& end, double cut_back,
                const std::string& source)
{
  const CentrelineBranch& branch = tree.branches[static_cast<std::size_t>(end.branch)];
  const std::size_t n = branch.points.size();
  const bool at_front = end.position == branch.points.front();
  const auto index = [&](std::size_t k) { return at_front ? k : n - 1 - k; };
  double left = cut_back * end.radius;
  std::size_t k = 0;
  while (k + 1 < n && left >= (branch.points[index(k + 1)] - branch.points[index(k)]).norm())
    left -= (branch.points[index(k + 1)] - branch.points[index(k)]).norm(), ++k;
  if (k + 1 >= n)
    throw InputError(source, "--open",
                     "the branch " + branch.name + " is too short to be clipped; specify a smaller --cut-back");
  const Eigen::Vector3d& a = branch.points[index(k)];
  const Eigen::Vector3d inward = (branch.points[index(k + 1)] - a).normalized();
  Opening opening;
  opening.end = branch.name;
  opening.location = a + left * inward;
  opening.outward = -inward;
  opening.radius = branch.radii[index(k)];
  const double reach = kReach * opening.radius + (opening.location - end.position).norm();
  mesh = clipEnd(mesh, {opening.location, opening.outward, reach}, source);
  return opening;
}

}  // namespace endovascular_sim::vessel
