#include "nodes/rod_dynamics/remote_deformable_wall.h"

#include <chrono>
#include <utility>

#include "common/archive.h"
#include "common/error.h"
#include "endovascular_sim/TakeWall.h"
#include "intervention/wall_displacement.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 100;                 ///< loads must not be lost while vessel_server is busy
constexpr double kPatience = 10.0;          ///< longest wait for another node [s]
constexpr double kLateness = 0.5;           ///< of a displacement that a step needs [s]
constexpr std::size_t kMostWaiting = 1000;  ///< displacements that no step has used
constexpr std::uint64_t kActivation = 8;    ///< steps from a load to the activation of its version, at least

}  // namespace

RemoteDeformableWall::RemoteDeformableWall(ros::NodeHandle node, std::uint64_t version, bool keeps_vertices)
  : node_(node), version_(version), detected_(version), received_(version), keeps_vertices_(keeps_vertices)
{
  publisher_ = node.advertise<BalloonLoad>(names::kBalloonLoad, kQueue);
  message_.header.frame_id = names::kPatientFrame;
  subscriber_ = subscribeGuarded<WallDisplacement>(
      node, names::kWallDisplacement, kQueue,
      [this](const ros::MessageEvent<WallDisplacement const>& event)
      {
        source_.require(event.getPublisherName());
        receive(*event.getConstMessage());
      },
      &queue_);
  if (keeps_vertices_)
    takeVertices(kPatience);
}

/** Called in a thread of ROS. */
void RemoteDeformableWall::receive(const WallDisplacement& displacement)
{
  if (count_ > 0)
    fromMessage(displacement, count_);  // throws for an invalid one
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (keeps_vertices_ && displacement.version != received_ + 1)
      throw InputError(
          names::kWallDisplacement, "version",
          "is " + std::to_string(displacement.version) + ", not the next one, " + std::to_string(received_ + 1));
    if (keeps_vertices_ && moved_.size() >= kMostWaiting)
      throw InputError(names::kWallDisplacement, "",
                       "more wait than any simulation leaves; is another node publishing?");
    if (keeps_vertices_)
      moved_.push_back(displacement);
    at_risk_ = displacement.at_risk;
    received_ = displacement.version;
  }
  arrived_.notify_one();
}

/** Takes the vertices of the version that contact detection searches. Its mesh arrives before its service is known.
 *  @param patience longest wait for the service [s] */
void RemoteDeformableWall::takeVertices(double patience)
{
  GetVessel vessel;
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(patience);
  while (!ros::service::call(node_.resolveName(names::kGetVessel), vessel))
  {
    if (ros::WallTime::now() > end)
      throw InputError(names::kGetVessel, "", "vessel_server does not respond");
    ros::WallDuration(10e-3).sleep();
  }
  std::vector<Eigen::Vector3d> vertices = fromMessage(vessel.response.mesh).vertices;
  if (count_ > 0 && vertices.size() != count_)
    throw InputError(names::kVesselMesh, "", "is another vessel than that of the simulation; restart the session");
  count_ = vertices.size();
  vertices_ = std::move(vertices);
  vertices_version_ = vessel.response.mesh.version;
  loads_.clear();
  const std::lock_guard<std::mutex> lock(mutex_);
  moved_.assign(vessel.response.moved.begin(), vessel.response.moved.end());
}

const std::vector<Eigen::Vector3d>* RemoteDeformableWall::detected()
{
  if (!keeps_vertices_)
    return nullptr;
  if (!moveVertices())
    takeAgain();
  return &vertices_;
}

/** Moves the vertices to the version that contact detection searches. @return false where a displacement is missing */
bool RemoteDeformableWall::moveVertices()
{
  std::unique_lock<std::mutex> lock(mutex_);
  arrived_.wait_for(lock, std::chrono::duration<double>(kLateness), [this] { return received_ >= detected_; });
  for (; !moved_.empty() && moved_.front().version <= detected_; moved_.pop_front())
  {
    if (moved_.front().version != vertices_version_ + 1)
      continue;  // already part of the vertices
    intervention::move(fromMessage(moved_.front(), vertices_.size()), vertices_);
    ++vertices_version_;
  }
  return vertices_version_ == detected_;
}

/** Takes the wall of vessel_server in place of one whose displacement was lost. Without it the vertices stay. */
void RemoteDeformableWall::takeAgain()
{
  try
  {
    takeVertices(0.0);
    if (moveVertices())
      return;
  }
  catch (const InputError& error)
  {
    ROS_WARN_THROTTLE(10.0, "%s", error.what());
  }
  ROS_WARN_THROTTLE(10.0, "the flow of blood has the wall of version %lu in place of version %lu",
                    static_cast<unsigned long>(vertices_version_), static_cast<unsigned long>(detected_));
}

bool RemoteDeformableWall::isBehind(std::uint64_t step)
{
  while (!loads_.empty() && loads_.front().second <= received_)
    loads_.pop_front();
  return !loads_.empty() && loads_.front().first + kActivation <= step;
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
  if (keeps_vertices_)
    loads_.emplace_back(step, version_);
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
  if (keeps_vertices_)
    takeVertices(kPatience);
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
