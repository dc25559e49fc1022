#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "endovascular_sim/VesselCentreline.h"
#include "motion/map/motion_map.h"
#include "visualization/name_placement.h"

namespace endovascular_sim::rviz_plugin
{

/** Names of the branches in the picture of the moving patient. They are placed for one motion; then each moves with the
 *  end of its leader, so that it stays beside its branch. */
class MovingNames
{
public:
  /** Places the names anew; a name keeps its offset where that is still possible.
   *  @param branches at rest */
  void place(std::vector<visualization::BranchToName> branches, const visualization::PictureView& view,
             const motion::MotionMap& map);
  /** Moves the ends of the leaders.
   *  @return true if one has moved */
  bool move(const motion::MotionMap& map);
  void clear();

  const std::vector<visualization::PlacedName>& names() const { return names_; }
  bool empty() const { return names_.empty(); }

private:
  std::vector<visualization::PlacedName> names_;
  std::vector<Eigen::Vector3d> rest_;  ///< ends of the leaders at rest [m]
};

/** Branches of a message with their displayed names, for visualization::placeNames(). Branches with a generated name
 *  (branch_<k>) have no text, and those with invalid points are not drawn.
 *  @param size_of size of a name in the picture [pixels]
 *  @param goal name of the branch that a person is to reach, which comes first; empty: none */
std::vector<visualization::BranchToName> branchesToName(
    const VesselCentreline& message, const std::function<Eigen::Vector2d(const std::string&)>& size_of,
    const std::string& goal = {});

/** Depth up to which branches have names: those around the tip, where the tip is in the picture; else infinite [m]. */
double reachOfNames(const Eigen::Vector3d& tip, const visualization::PictureView& view);

}  // namespace endovascular_sim::rviz_plugin
