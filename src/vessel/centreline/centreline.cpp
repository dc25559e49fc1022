#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Direction of a chord about one radius long; the first segment alone is sensitive to noise of the points. */
Eigen::Vector3d inwardDirection(const CentrelineBranch& branch, bool at_front)
{
  const std::size_t n = branch.points.size();
  const auto at = [&](std::size_t k) { return branch.points[at_front ? k : n - 1 - k]; };
  const double reach = at_front ? branch.radii.front() : branch.radii.back();
  std::size_t k = 1;
  while (k + 1 < n && (at(k) - at(0)).norm() < reach)
    ++k;
  const Eigen::Vector3d chord = at(k) - at(0);
  return chord.norm() > 0.0 ? Eigen::Vector3d(chord.normalized()) : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
}

/** True if the tip of a branch lies on another branch: the tip is then a junction, not an end of the vessel. */
bool tipMeetsBranch(const CentrelineTree& tree, std::size_t branch)
{
  const Eigen::Vector3d& tip = tree.branches[branch].points.back();
  const double radius = tree.branches[branch].radii.back();
  for (std::size_t other = 0; other < tree.branches.size(); ++other)
  {
    if (other == branch)
      continue;
    for (const Eigen::Vector3d& point : tree.branches[other].points)
      if ((point - tip).norm() <= 0.5 * radius)
        return true;
  }
  return false;
}

}  // namespace

std::vector<CentrelineEnd> centrelineEnds(const CentrelineTree& tree)
{
  std::vector<CentrelineEnd> ends;
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
  {
    const CentrelineBranch& branch = tree.branches[b];
    if (branch.points.size() < 2)
      continue;
    const int index = static_cast<int>(b);
    if (branch.parent < 0)
      ends.push_back({index, branch.points.front(), inwardDirection(branch, true), branch.radii.front()});
    if (!tipMeetsBranch(tree, b))
      ends.push_back({index, branch.points.back(), inwardDirection(branch, false), branch.radii.back()});
  }
  return ends;
}

}  // namespace endovascular_sim::vessel
