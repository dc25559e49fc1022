#include "rviz_plugin/picture/branch_names.h"

#include <cmath>
#include <limits>

#include "rviz_plugin/model/centreline_tree.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kReach = 1.5;  ///< greatest depth of a branch with a name, relative to that of the tip

}  // namespace

void MovingNames::place(std::vector<visualization::BranchToName> branches, const visualization::PictureView& view,
                        const motion::MotionMap& map)
{
  std::vector<Eigen::Vector3d> moved;
  for (visualization::BranchToName& branch : branches)
  {
    map.positions(branch.points, moved);
    branch.points.swap(moved);
  }
  move(map);
  names_ = visualization::placeNames(branches, view, names_);
  rest_.clear();
  for (const visualization::PlacedName& name : names_)
    rest_.push_back(map.pullBack(name.end));
}

bool MovingNames::move(const motion::MotionMap& map)
{
  bool has_moved = false;
  for (std::size_t k = 0; k < names_.size(); ++k)
  {
    const Eigen::Vector3d end = map.position(rest_[k]);
    has_moved = has_moved || end != names_[k].end;
    names_[k].end = end;
  }
  return has_moved;
}

void MovingNames::clear()
{
  names_.clear();
  rest_.clear();
}

std::vector<visualization::BranchToName> branchesToName(
    const VesselCentreline& message, const std::function<Eigen::Vector2d(const std::string&)>& size_of,
    const std::string& goal)
{
  const vessel::CentrelineTree tree = centrelineTree(message);
  std::vector<visualization::BranchToName> branches;
  for (std::size_t k = 0; k < tree.branches.size(); ++k)
  {
    visualization::BranchToName& branch = branches.emplace_back();
    branch.points = tree.branches[k].points;
    branch.radii = tree.branches[k].radii;
    const std::string& name = message.branches[k].name;
    if (name.empty() || name.rfind("branch_", 0) == 0)
      continue;
    branch.text = tree.branches[k].name;
    branch.size = size_of(branch.text);
    branch.comes_first = name == goal;
  }
  return branches;
}

double reachOfNames(const Eigen::Vector3d& tip, const visualization::PictureView& view)
{
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const double depth = view.depth(tip);
  if (!tip.allFinite() || !(depth > 0.0))
    return kInfinite;
  const Eigen::Vector2d place = view.project(tip);
  const bool is_in_picture = std::abs(place.x()) <= 0.5 * view.width && std::abs(place.y()) <= 0.5 * view.height;
  return is_in_picture ? kReach * depth : kInfinite;
}

}  // namespace endovascular_sim::rviz_plugin
