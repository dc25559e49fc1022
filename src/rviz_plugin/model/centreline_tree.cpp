#include "rviz_plugin/model/centreline_tree.h"

#include "rviz_plugin/model/message_points.h"
#include "visualization/tube_surface.h"
#include "visualization/wall_surface.h"

namespace endovascular_sim::rviz_plugin
{

vessel::CentrelineTree centrelineTree(const VesselCentreline& message)
{
  vessel::CentrelineTree tree;
  for (const VesselCentrelineBranch& from : message.branches)
  {
    vessel::CentrelineBranch& branch = tree.branches.emplace_back();
    branch.name = visualization::branchLabel(from.name);
    branch.parent = from.parent;
    toEigen(from.points, branch.points);
    branch.radii = from.radii;
    if (visualization::problemOfTube(branch.points, branch.radii) != nullptr)
      branch.points.clear();
  }
  return tree;
}

}  // namespace endovascular_sim::rviz_plugin
