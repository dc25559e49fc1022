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
constexpr double kLeastPressure = -1.1e5;  ///< a vacuum, relative to the atmosphere [Pa]
constexpr double kLargestPressure = 1e7;   ///< several times the burst pressure of any balloon [Pa]

const char* reasonOf(haptics::CommandVerdict verdict)
{
  switch (verdict)
  {
    case haptics::CommandVerdict::kNotFinite:
      return "not finite";
    case haptics::CommandVerdict::kOutOfRange:
      return "beyond the length of the instrument [m] or 1000 turns [rad]";
    case haptics::CommandVerdict::kJump:
      return "a jump of more than 20 mm or 3 rad from the last accepted command";
    case haptics::CommandVerdict::kAccepted:
      break;
  }
  return "";
}

}  // namespace

DriveCommands::DriveCommands(ros::NodeHandle& node, const scene::Scene& scene)
  : scene_(scene),
    next_(scene.instruments.size()),
    pressures_(scene.instruments.size(), kNoPressure),
    malformed_(scene.instruments.size(), 0),
    subscribers_(scene.instruments.size())
{
  for (const scene::DrivenInstrument& driven : scene_.instruments)
    gates_.emplace_back(haptics::HandMotion{driven.drive.insertionAt(0.0), driven.drive.rotationAt(0.0)},
                        driven.instrument.wire.length());
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
  haptics::HandMotion command;
  double pressure = kNoPressure;
  int insertions = 0;
  int rotations = 0;
  int pressures = 0;
  for (std::size_t i = 0; i < std::min(message.name.size(), message.position.size()); ++i)
  {
    if (message.name[i] == names::kInsertionJoint)
    {
      command.insertion = message.position[i];
      ++insertions;
    }
    else if (message.name[i] == names::kRotationJoint)
    {
      command.rotation = message.position[i];
      ++rotations;
    }
    else if (message.name[i] == names::kPressureJoint)
    {
      pressure = message.position[i];
      ++pressures;
    }
  }
  const bool is_pressure_valid =
      pressures == 0 || (pressures == 1 && pressure >= kLeastPressure && pressure <= kLargestPressure);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (insertions != 1 || rotations != 1 || !is_pressure_valid)
  {
    ++malformed_[instrument];
    ROS_WARN_THROTTLE(5.0,
                      "rejected a servo_jp without exactly one position each of '%s' and '%s', or with a pressure "
                      "outside of %.3g to %.3g Pa",
                      names::kInsertionJoint, names::kRotationJoint, kLeastPressure, kLargestPressure);
    return;
  }
  const haptics::CommandVerdict verdict = gates_[instrument].offer(command);
  if (verdict != haptics::CommandVerdict::kAccepted)
  {
    ROS_WARN_THROTTLE(5.0, "rejected a servo_jp of %s: insertion %g m, rotation %g rad: %s",
                      scene_.instruments[instrument].instrument.name.c_str(), command.insertion, command.rotation,
                      reasonOf(verdict));
    return;
  }
  if (pressures == 1 && scene_.instruments[instrument].instrument.balloon)
    pressures_[instrument] = pressure;
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
    {
      const haptics::HandMotion& motion = gates_[k].next(scene_.solver.time_step);
      next_[k] = {motion.insertion, motion.rotation, pressures_[k]};
    }
    else if (scripted == nullptr)
      next_[k] = {drive.insertionAt(end), drive.rotationAt(end), kNoPressure};
    if (std::isnan(next_[k].pressure))
      next_[k].pressure = drive.pressureAt(end);
  }
  return next_;
}

std::vector<TopicReport> DriveCommands::reports()
{
  std::vector<TopicReport> reports;
  for (std::size_t k = 0; k < subscribers_.size(); ++k)
  {
    if (!subscribers_[k])
      continue;
    TopicReport report;
    report.topic = subscribers_[k].getTopic();
    report.has_publisher = subscribers_[k].getNumPublishers() > 0;
    const std::lock_guard<std::mutex> lock(mutex_);
    report.accepted = gates_[k].accepted();
    report.malformed = malformed_[k];
    report.rejected = gates_[k].rejected();
    report.silence = gates_[k].silence();
    reports.push_back(report);
  }
  return reports;
}

}  // namespace endovascular_sim::nodes
