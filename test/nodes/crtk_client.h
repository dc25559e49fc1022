#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Empty.h>

#include "endovascular_sim/DriveApplied.h"
#include "nodes/runtime/ros_names.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{

using Joints = sensor_msgs::JointState;

inline Joints positions(std::vector<double> values, std::vector<std::string> names = {})
{
  Joints message;
  message.name = std::move(names);
  message.position = std::move(values);
  return message;
}

inline Joints velocities(std::vector<double> values, std::vector<std::string> names = {})
{
  Joints message;
  message.name = std::move(names);
  message.velocity = std::move(values);
  return message;
}

/** Client of an instrument or a robot that publishes and listens as crtk_python_client does, and records every step. */
class CrtkClient
{
public:
  /** @param group namespace of the instrument or robot, with its slash
   *  @param node part of the name of the node whose diagnostics are kept
   *  @param further topics with joints that are recorded, beside those of the group */
  CrtkClient(const std::string& group, const std::string& node, std::vector<std::string> further = {})
  {
    for (const char* input : {"servo_jp", "servo_jr", "servo_jv", "servo_jf", "move_jp", "move_jr"})
      inputs_[input] = node_.advertise<Joints>(group + input, 10);
    for (const char* topic : {"hold", "free"})
      words_[topic] = node_.advertise<std_msgs::Empty>(group + topic, 10);
    command_ = node_.advertise<crtk_msgs::StringStamped>(group + "state_command", 10, true);
    for (const char* topic : {"measured_js", "setpoint_js", "goal_js"})
      further.push_back(group + topic);
    for (const std::string& topic : further)
      observer_.subscribe<Joints>(
          topic, [this, topic](const Joints& joints) { joints_[topic][joints.header.stamp.toNSec()] = joints; });
    observer_.subscribe<crtk_msgs::OperatingState>(group + "operating_state",
                                                   [this](const auto& state)
                                                   {
                                                     state_ = state;
                                                     busy_states_ += state.is_busy;
                                                   });
    observer_.subscribe<crtk_msgs::StringStamped>(group + "state_reason",
                                                  [this](const auto& reason) { reason_ = reason.string; });
    observer_.subscribe<geometry_msgs::PoseStamped>(group + "measured_cp", [this](const auto& pose) { tip_ = pose; });
    observer_.subscribe<geometry_msgs::WrenchStamped>(group + "measured_cf",
                                                      [this](const auto& wrench) { wall_force_ = wrench; });
    observer_.subscribe<diagnostic_msgs::DiagnosticArray>(
        nodes::names::kDiagnostics, [this, node](const auto& array) { takeDiagnostics(array, node, diagnostics_); });
    observer_.subscribe<DriveApplied>(nodes::names::kDriveApplied,
                                      [this](const auto& step) { steps_[step.step] = step; });
  }

  /** Publishes a command. */
  void send(const std::string& input, const Joints& joints) { inputs_.at(input).publish(joints); }

  /** Publishes a command without values to its own topic. */
  void word(const std::string& topic) { words_.at(topic).publish(std_msgs::Empty()); }

  void command(const std::string& word)
  {
    crtk_msgs::StringStamped message;
    message.header.stamp = ros::Time::now();
    message.string = word;
    command_.publish(message);
  }

  /** Simulates for a time. @param each called about every 5 ms [s] */
  bool run(
      double seconds, const std::function<void()>& each = [] {})
  {
    const double end = time() + seconds;
    return waitUntil(60.0,
                     [&]
                     {
                       each();
                       return time() >= end;
                     });
  }

  /** Sends a move and waits for its end. */
  bool move(const Joints& joints)
  {
    const std::uint64_t busy = busyStates();
    send("move_jp", joints);
    return waitUntil(10.0, [&] { return busyStates() > busy; }) &&
           waitUntil(60.0, [this] { return !state().is_busy; }) && run(0.05);
  }

  /** Waits until the simulation runs, then enables and homes. @return false where that takes too long */
  bool enable()
  {
    if (!waitUntil(90.0, [this] { return time() > 0.1; }) || !run(0.25))
      return false;
    for (const char* word : {"resume", "enable", "home"})
      command(word);
    return waitUntil(30.0,
                     [this]
                     {
                       const crtk_msgs::OperatingState now = state();
                       return now.state == "ENABLED" && now.is_homed && !now.is_busy;
                     });
  }

  double time() const
  {
    const std::lock_guard<std::mutex> lock(observer_.mutex());
    return steps_.empty() ? 0.0 : 1e-3 * static_cast<double>(steps_.rbegin()->first + 1);
  }
  crtk_msgs::OperatingState state() const { return observer_.copy(state_); }
  std::uint64_t busyStates() const { return observer_.copy(busy_states_); }
  std::string reason() const { return observer_.copy(reason_); }
  std::string diagnostics() const { return observer_.copy(diagnostics_); }
  geometry_msgs::PoseStamped tip() const { return observer_.copy(tip_); }
  geometry_msgs::WrenchStamped wallForce() const { return observer_.copy(wall_force_); }
  std::map<std::uint64_t, DriveApplied> steps() const { return observer_.copy(steps_); }

  /** Joints of a topic by their stamps [ns]. */
  std::map<std::uint64_t, Joints> all(const std::string& topic) const
  {
    const std::lock_guard<std::mutex> lock(observer_.mutex());
    const auto joints = joints_.find(topic);
    return joints != joints_.end() ? joints->second : std::map<std::uint64_t, Joints>();
  }
  Joints newest(const std::string& topic) const
  {
    const std::lock_guard<std::mutex> lock(observer_.mutex());
    const auto joints = joints_.find(topic);
    return joints != joints_.end() ? joints->second.rbegin()->second : Joints();
  }
  /** Newest position of a joint; NaN without one. */
  double position(const std::string& topic, std::size_t joint) const
  {
    const Joints joints = newest(topic);
    return joint < joints.position.size() ? joints.position[joint] : std::numeric_limits<double>::quiet_NaN();
  }

private:
  ros::NodeHandle node_;
  std::map<std::string, ros::Publisher> inputs_, words_;
  ros::Publisher command_;
  std::map<std::string, std::map<std::uint64_t, Joints>> joints_;  ///< by topic and stamp [ns]
  std::map<std::uint64_t, DriveApplied> steps_;
  crtk_msgs::OperatingState state_;
  std::uint64_t busy_states_ = 0;
  std::string reason_, diagnostics_;
  geometry_msgs::PoseStamped tip_;
  geometry_msgs::WrenchStamped wall_force_;
  TopicObserver observer_;  ///< last, so that it ends before the data that it takes over
};

}  // namespace endovascular_sim
