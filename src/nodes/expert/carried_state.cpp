#include "nodes/expert/carried_state.h"

namespace endovascular_sim::nodes
{

void carry(const motion::MotionMap& from, const motion::MotionMap& to, RodStateVisual& state)
{
  if (from.resting() && to.resting())
    return;
  for (geometry_msgs::Point& node : state.nodes)
  {
    const Eigen::Vector3d moved = to.position(from.pullBack({node.x, node.y, node.z}));
    node.x = moved.x();
    node.y = moved.y();
    node.z = moved.z();
  }
}

}  // namespace endovascular_sim::nodes
