#include "nodes/rod_dynamics/remote_deformable_wall.h"

#include "common/archive.h"
#include "common/error.h"
#include "endovascular_sim/TakeWall.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 100;         ///< loads must not be lost while vessel_server is busy
constexpr double kPatience = 10.0;  ///< longest wait for another node [s]

}  // namespace

RemoteDeformableWall::RemoteDeformableWall(ros::NodeHandle node, std::uint64_t version)
  : node_(node), version_(version), detected_(version), received_(version)
{
  publisher_ = node.advertise<BalloonLoad>(names::kBalloonLoad, kQueue);
  message_.header.frame_id = names::kPatientFrame;
  subscriber_ = subscribeGuarded<WallDisplacement>(
      node, names::kWallDisplacement, kQueue,
      [this](const WallDisplacement& displacement)
      {
        at_risk_ = displacement.at_risk;
        received_ = displacement.version;
      },
      &queue_);
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

std::string RemoteDeformableWall::save()
{
  const WallState answer = call(WallState::Request::SAVE, "");
  return {answer.response.state.begin(), answer.response.state.end()};
}

void RemoteDeformableWall::load(const std::string& state)
{
  replace(WallState::Request::LOAD, state);
}

void RemoteDeformableWall::reset()
{
  replace(WallState::Request::RESET, "");
}

/** Calls vessel_server. @throws ArchiveError for a state that it refuses; InputError when it does not respond */
WallState RemoteDeformableWall::call(std::uint8_t operation, const std::string& state)
{
  WallState wall;
  wall.request.operation = operation;
  wall.request.newest = version_;
  wall.request.detected = detected_;
  wall.request.state.assign(state.begin(), state.end());
  if (!ros::service::call(node_.resolveName(names::kWallState), wall))
    throw InputError(names::kWallState, "", "vessel_server does not respond");
  if (!wall.response.success && operation == WallState::Request::LOAD)
    throw ArchiveError(wall.response.message);
  if (!wall.response.success)
    throw InputError(names::kWallState, "", wall.response.message);
  return wall;
}

void RemoteDeformableWall::replace(std::uint8_t operation, const std::string& state)
{
  waitForDisplacements();
  const std::uint64_t before = version_;
  const WallState answer = call(operation, state);
  version_ = answer.response.version;
  detected_ = answer.response.base;
  received_ = version_;
  at_risk_ = answer.response.at_risk != 0;
  makeContactFollow(before);
}

/** Waits until the answers to all loads have arrived: a later one would be taken for that of the new wall. */
void RemoteDeformableWall::waitForDisplacements() const
{
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (received_ < version_)
  {
    if (ros::WallTime::now() > end)
      throw InputError(names::kWallDisplacement, "", "vessel_server does not respond to the loads of the balloon");
    ros::WallDuration(1e-3).sleep();
  }
}

/** Makes the contact node search the wall of vessel_server, also one that is being restarted.
 *  @param before version of the wall that it searched */
void RemoteDeformableWall::makeContactFollow(std::uint64_t before)
{
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
  TakeWall take;
  take.request.newest = before;
  while (!ros::service::call(node_.resolveName(names::kTakeWall), take) || !take.response.success)
  {
    if (ros::WallTime::now() > end)
      throw InputError(names::kTakeWall, "",
                       take.response.message.empty() ? "the contact node does not respond" : take.response.message);
    ros::WallDuration(10e-3).sleep();
  }
}

}  // namespace endovascular_sim::nodes
