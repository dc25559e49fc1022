#include "procedure/branch_locator.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kOstiumStep = 0.5e-3;  // step of the search for the ostium along a branch [m]
constexpr double kWider = 1.25;         // ratio of radii above which an ancestor counts as wider

/** True if a point of a branch's centreline lies in the lumen of a wider ancestor. An ancestor of similar radius, which
 *  the branch continues, does not count. */
bool isInParents(const vessel::CentrelineTree& tree, const std::vector<geometry::Polyline>& lines, std::size_t branch,
                 double arc)
{
  const Eigen::Vector3d point = lines[branch].at(arc);
  const double own = lines[branch].interpolate(tree.branches[branch].radii, arc);
  int parent = tree.branches[branch].parent;
  for (std::size_t above = 0; parent >= 0 && above < lines.size(); ++above)
  {
    const auto p = static_cast<std::size_t>(parent);
    const geometry::Polyline::Foot foot = lines[p].nearest(point);
    const double radius = lines[p].interpolate(tree.branches[p].radii, foot.arc);
    if (foot.distance < radius && radius > kWider * own)
      return true;
    parent = tree.branches[p].parent;
  }
  return false;
}

}  // namespace

BranchLocator::BranchLocator(const vessel::CentrelineTree& tree, const std::vector<scene::NamedBranch>& names)
  : finder_(tree)
{
  for (const vessel::CentrelineBranch& branch : tree.branches)
  {
    lines_.emplace_back(branch.points);
    parent_.push_back(branch.parent);
    names_.push_back(branch.name);
  }
  vessel_names_ = names_;
  for (const scene::NamedBranch& named : names)
    if (const int branch = finder_.nearest(named.at); branch >= 0)
      names_[static_cast<std::size_t>(branch)] = named.name;
  for (std::size_t b = 0; b < lines_.size(); ++b)
  {
    double arc = std::floor(lines_[b].length() / kOstiumStep) * kOstiumStep;
    while (arc > 0.0 && !isInParents(tree, lines_, b, arc))
      arc -= kOstiumStep;
    ostium_.push_back(std::max(0.0, arc));
  }
}

BranchPosition BranchLocator::at(const Eigen::Vector3d& point) const
{
  const int branch = finder_.nearest(point);
  return {branch, branch < 0 ? 0.0 : depthIn(branch, point)};
}

double BranchLocator::depthIn(int branch, const Eigen::Vector3d& point) const
{
  const auto b = static_cast<std::size_t>(branch);
  return lines_[b].nearest(point).arc - ostium_[b];
}

int BranchLocator::find(const std::string& name) const
{
  for (const std::vector<std::string>* list : {&names_, &vessel_names_})
    if (const auto found = std::find(list->begin(), list->end(), name); found != list->end())
      return static_cast<int>(found - list->begin());
  return -1;
}

const std::string& BranchLocator::name(int branch) const
{
  static const std::string outside = "outside";
  return branch < 0 ? outside : names_[static_cast<std::size_t>(branch)];
}

std::string BranchLocator::names() const
{
  std::string text;
  for (const std::string& name : names_)
    text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::vector<bool> BranchLocator::pathBetween(int from, int to) const
{
  std::vector<bool> on_way(names_.size(), to < 0 || from < 0);
  if (to < 0 || from < 0)
    return on_way;
  const auto path_to_root = [this](int branch)
  {
    std::vector<int> chain;
    for (; branch >= 0 && chain.size() <= parent_.size(); branch = parent_[static_cast<std::size_t>(branch)])
      chain.push_back(branch);
    return chain;
  };
  const std::vector<int> up = path_to_root(from);
  const std::vector<int> down = path_to_root(to);
  for (const std::vector<int>* chain : {&up, &down})
  {
    const std::vector<int>& other = chain == &up ? down : up;
    for (const int branch : *chain)
    {
      on_way[static_cast<std::size_t>(branch)] = true;
      if (std::find(other.begin(), other.end(), branch) != other.end())
        break;  // the lowest common ancestor
    }
  }
  return on_way;
}

}  // namespace endovascular_sim::procedure
