#include "nodes/rod_dynamics/remote_deformable_wall.h"

#include <stdexcept>

#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 100;  ///< loads must not be lost while vessel_server is busy

}  // namespace

RemoteDeformableWall::RemoteDeformableWall(ros::NodeHandle node, std::uint64_t version) : version_(version)
{
  publisher_ = node.advertise<BalloonLoad>(names::kBalloonLoad, kQueue);
  message_.header.frame_id = names::kPatientFrame;
  subscriber_ = subscribeGuarded<WallDisplacement>(
      node, names::kWallDisplacement, kQueue,
      [this](const WallDisplacement& displacement) { at_risk_ = displacement.at_risk; }, &queue_);
}

bool RemoteDeformableWall::waitForServer() const
{
  while (ros::ok() && publisher_.getNumSubscribers() == 0)
    ros::WallDuration(0.01).sleep();
  return ros::ok();
}

std::uint64_t RemoteDeformableWall::applyLoad(std::uint64_t step, const intervention::BalloonLoad& load)
{
  toMessage(load, message_);
  message_.header.stamp = ros::Time::now();
  message_.step = step;
  message_.version = ++version_;
  publisher_.publish(message_);
  return version_;
}

void RemoteDeformableWall::archive(Archive& /*archive*/)
{
  throw std::logic_error("RemoteDeformableWall: the wall belongs to vessel_server; only simulate saves states");
}

}  // namespace endovascular_sim::nodes
