#include "nodes/support/remote_wall.h"

#include <stdexcept>

#include "nodes/support/names.h"
#include "nodes/support/vessel_conversions.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 100;  // pressings may not be lost while vessel_server is busy

}  // namespace

RemoteWall::RemoteWall(ros::NodeHandle node, std::uint64_t version) : version_(version)
{
  publisher_ = node.advertise<VesselPressing>(names::kVesselPressing, kQueue);
  message_.header.frame_id = names::kPatientFrame;
  node.setCallbackQueue(&queue_);
  const boost::function<void(const VesselMovedConstPtr&)> receive = [this](const VesselMovedConstPtr& message)
  { at_risk_ = message->at_risk; };
  subscriber_ = node.subscribe<VesselMoved>(names::kVesselMoved, kQueue, receive, ros::VoidConstPtr(),
                                            ros::TransportHints().tcpNoDelay());
}

bool RemoteWall::waitForServer() const
{
  while (ros::ok() && publisher_.getNumSubscribers() == 0)
    ros::WallDuration(0.01).sleep();
  return ros::ok();
}

std::uint64_t RemoteWall::press(std::uint64_t step, const intervention::Pressing& pressing)
{
  toMessage(pressing, message_);
  message_.header.stamp = ros::Time::now();
  message_.step = step;
  message_.version = ++version_;
  publisher_.publish(message_);
  return version_;
}

void RemoteWall::archive(Archive& /*archive*/)
{
  throw std::logic_error("RemoteWall: the wall is vessel_server's; states are saved by simulate");
}

}  // namespace endovascular_sim::nodes
