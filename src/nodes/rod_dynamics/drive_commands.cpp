#include "nodes/rod_dynamics/drive_commands.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Pressure of a command that holds none: the pressure of the scene applies. */
constexpr double kNoPressure = std::numeric_limits<double>::quiet_NaN();

}  // namespace

DriveCommands::DriveCommands(ros::NodeHandle& node, const scene::Scene& scene)
  : scene_(scene), next_(scene.instruments.size()), subscribers_(scene.instruments.size())
{
  for (const scene::DrivenInstrument& driven : scene_.instruments)
    received_.push_back({driven.drive.insertionAt(0.0), driven.drive.rotationAt(0.0), kNoPressure});
  for (std::size_t k = 0; k < scene_.instruments.size(); ++k)
  {
    const scene::DriveSource source = scene_.instruments[k].drive.source;
    if (source == scene::DriveSource::kDevice || source == scene::DriveSource::kTopic)
      subscribe(node, k);
  }
}

void DriveCommands::subscribe(ros::NodeHandle& node, std::size_t instrument)
{
  // The callback runs in the thread that reads the socket; only the simulation's thread has a higher priority.
  ros::SubscribeOptions options = ros::SubscribeOptions::create<sensor_msgs::JointState>(
      names::kInstruments + scene_.instruments[instrument].instrument.name + names::kServoJp, 10,
      [this, instrument](const sensor_msgs::JointStateConstPtr& message) { receive(instrument, *message); },
      ros::VoidPtr(), &queue_);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_[instrument] = node.subscribe(options);
}

void DriveCommands::receive(std::size_t instrument, const sensor_msgs::JointState& message)
{
  simulation::HandCommand command{0.0, 0.0, kNoPressure};
  bool insertion = false;
  bool rotation = false;
  for (std::size_t i = 0; i < std::min(message.name.size(), message.position.size()); ++i)
  {
    if (message.name[i] == names::kInsertionJoint && std::isfinite(message.position[i]))
    {
      command.insertion = message.position[i];
      insertion = true;
    }
    if (message.name[i] == names::kRotationJoint && std::isfinite(message.position[i]))
    {
      command.rotation = message.position[i];
      rotation = true;
    }
    if (message.name[i] == names::kPressureJoint && std::isfinite(message.position[i]))
      command.pressure = message.position[i];
  }
  if (!insertion || !rotation)
  {
    ROS_WARN_THROTTLE(5.0, "ignored a servo_jp without finite positions of '%s' and '%s'", names::kInsertionJoint,
                      names::kRotationJoint);
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (std::isnan(command.pressure) || !scene_.instruments[instrument].instrument.balloon)
    command.pressure = received_[instrument].pressure;
  received_[instrument] = command;
}

const std::vector<simulation::HandCommand>& DriveCommands::next(double end,
                                                                const std::vector<simulation::HandCommand>* scripted)
{
  if (scripted != nullptr)
    next_ = *scripted;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t k = 0; k < next_.size(); ++k)
  {
    const scene::DriveScene& drive = scene_.instruments[k].drive;
    if (subscribers_[k])
      next_[k] = received_[k];
    else if (scripted == nullptr)
      next_[k] = {drive.insertionAt(end), drive.rotationAt(end), kNoPressure};
    if (std::isnan(next_[k].pressure))
      next_[k].pressure = drive.pressureAt(end);
  }
  return next_;
}

}  // namespace endovascular_sim::nodes
