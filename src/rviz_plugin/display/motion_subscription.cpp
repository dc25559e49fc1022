#include "rviz_plugin/display/motion_subscription.h"

#include "nodes/runtime/guarded_subscription.h"
#include "rviz_plugin/model/motion_follower.h"

namespace endovascular_sim::rviz_plugin
{

ros::Subscriber subscribeToMotion(const ros::NodeHandle& node, const std::string& topic, MotionFollower& follower)
{
  if (topic.empty())
    return {};
  return nodes::subscribeGuarded<MotionState>(node, topic, nodes::MotionHistory::kCapacity,
                                              [&follower](const MotionState& motion) { follower.add(motion); });
}

}  // namespace endovascular_sim::rviz_plugin
