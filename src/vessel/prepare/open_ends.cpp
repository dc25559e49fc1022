#include "vessel/prepare/open_ends.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <set>

#include "common/error.h"
#include "vessel/repair/end_cut.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

/** A cut may take away what lies within this many radii of its place, and the tip. */
constexpr double kReach = 4.0;

const std::string& nameOf(const CentrelineTree& tree, const CentrelineEnd& end)
{
  return tree.branches[static_cast<std::size_t>(end.branch)].name;
}

[[noreturn]] void refuse(const CentrelineTree& tree, const std::vector<CentrelineEnd>& ends, const std::string& wish,
                         const std::string& source)
{
  std::string list;
  for (const CentrelineEnd& end : ends)
    list += (list.empty() ? "" : ", ") + nameOf(tree, end) + " near " + formatPlace(end.position);
  throw InputError(source, "--open " + wish,
                   "names no end; give all, largest, a count up to " + std::to_string(ends.size()) +
                       ", x,y,z in metres, or a branch: " + list);
}

/** Indices of the ends, the widest first. */
std::vector<std::size_t> byRadius(const std::vector<CentrelineEnd>& ends)
{
  std::vector<std::size_t> order(ends.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&ends](std::size_t a, std::size_t b) { return ends[a].radius > ends[b].radius; });
  return order;
}

/** Adds the ends of one wish. @return false when there are none */
bool choose(const CentrelineTree& tree, const std::vector<CentrelineEnd>& ends, const std::string& wish,
            std::set<std::size_t>& chosen)
{
  const std::vector<std::size_t> order = byRadius(ends);
  const bool is_count = !wish.empty() && wish.size() < 6 && wish.find_first_not_of("0123456789") == std::string::npos;
  std::size_t count = 0;
  if (wish == "all")
    count = ends.size();
  else if (wish == "largest")
    count = 1;
  else if (is_count)
    count = static_cast<std::size_t>(std::stoul(wish));
  if (count > 0 && count <= ends.size())
  {
    chosen.insert(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
    return true;
  }
  Eigen::Vector3d place;
  char rest = 0;
  if (std::sscanf(wish.c_str(), "%lf,%lf,%lf%c", &place.x(), &place.y(), &place.z(), &rest) == 3)
  {
    const auto nearest = std::min_element(ends.begin(), ends.end(),
                                          [&place](const CentrelineEnd& a, const CentrelineEnd& b)
                                          { return (a.position - place).norm() < (b.position - place).norm(); });
    chosen.insert(static_cast<std::size_t>(nearest - ends.begin()));
    return true;
  }
  const std::size_t before = chosen.size();
  for (std::size_t k = 0; k < ends.size(); ++k)
    if (nameOf(tree, ends[k]) == wish)
      chosen.insert(k);
  return chosen.size() > before;
}

}  // namespace

std::vector<CentrelineEnd> chooseEnds(const CentrelineTree& tree, const std::vector<std::string>& wishes,
                                      const std::string& source)
{
  const std::vector<CentrelineEnd> ends = centrelineEnds(tree);
  std::set<std::size_t> chosen;
  for (const std::string& wish : wishes)
    if (!choose(tree, ends, wish, chosen))
      refuse(tree, ends, wish, source);
  std::vector<CentrelineEnd> result;
  for (std::size_t k : chosen)
    result.push_back(ends[k]);
  return result;
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
                     "the branch " + branch.name + " is too short to be cut; give a smaller --cut-back");
  const Eigen::Vector3d& a = branch.points[index(k)];
  const Eigen::Vector3d inward = (branch.points[index(k + 1)] - a).normalized();
  Opening opening;
  opening.end = branch.name;
  opening.place = a + left * inward;
  opening.outward = -inward;
  opening.radius = branch.radii[index(k)];
  const double reach = kReach * opening.radius + (opening.place - end.position).norm();
  mesh = cutEnd(mesh, {opening.place, opening.outward, reach}, source);
  return opening;
}

}  // namespace endovascular_sim::vessel
