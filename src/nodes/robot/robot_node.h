#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "robot/robot_control.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** ROS node of the scene's robot: its description and pose, and CRTK under the names of its joints, converted to and
 *  from the topics of its instruments (robot::RobotControl).
 *
 *  Messages are converted when they arrive, in one thread; the node has no clock of its own. Topics of the simulation
 *  that cost it something are subscribed only while the corresponding topic of the robot has a subscriber. */
class RobotNode
{
public:
  /** Sets `robot_description`, and subscribes to clients and instruments.
   *  @param scene with a robot
   *  @throws InputError for a link with the name of a frame of the simulation */
  RobotNode(const ros::NodeHandle& node, const scene::Scene& scene);
  RobotNode(const RobotNode&) = delete;
  RobotNode& operator=(const RobotNode&) = delete;

private:
  /** Joints of all instruments on one of their topics, and the topic of the robot. */
  struct JointStream
  {
    const char* topic = "";
    ros::Publisher publisher;
    std::vector<sensor_msgs::JointState> newest;  ///< one per instrument
    std::vector<ros::Subscriber> subscribers;
  };
  /** Topics to one instrument. */
  struct Instrument
  {
    std::string name;
    std::map<drive::CommandKind, ros::Publisher> commands;
    std::map<std::string, ros::Publisher> words;  ///< commands with a topic of their own
    ros::Publisher state_command;
    drive::ControlState state;  ///< from the newest operating_state and state_reason
    bool has_state = false;     ///< false before the first operating_state
  };

  void advertise();
  void connectInstruments();
  void connectClients();
  void updateSubscriptions();
  void subscribe(JointStream& stream, bool wanted);
  template <typename Message>
  void relay(const char* topic, const ros::Publisher& publisher, ros::Subscriber& subscriber);

  void receive(drive::CommandKind kind, const ros::MessageEvent<sensor_msgs::JointState const>& event);
  void receiveWord(const std::string& client, const std::string& word);
  void receiveJoints(JointStream& stream, std::size_t instrument, const sensor_msgs::JointState& joints);
  void receiveState(std::size_t instrument, const crtk_msgs::OperatingState& state);
  void receiveReason(std::size_t instrument, const std::string& reason);
  void follow(std::size_t instrument, const sensor_msgs::JointState& setpoint);
  void give(const robot::InstrumentCommand& command);
  bool isHeard(const robot::RobotAnswer& answer) const;
  void publishAllJoints(const sensor_msgs::JointState& linked);
  void publishReason();
  void publishState();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle node_;
  robot::RobotControl control_;
  double time_ = 0.0;  ///< of the newest setpoint [s]
  std::vector<Instrument> instruments_;
  JointStream measured_, setpoint_, goal_;
  ros::Publisher description_, joint_states_, tip_, wall_force_, state_, reason_;
  ros::Time joint_states_at_;           ///< stamp of the last message
  std::string published_reason_ = "-";  ///< no reason yet
  tf2_ros::StaticTransformBroadcaster frames_;
  diagnostic_updater::Updater updater_;
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber tip_subscriber_, wall_force_subscriber_;
  std::vector<ros::Subscriber> subscribers_;  ///< clients first
  std::size_t clients_ = 0;                   ///< number of subscribers to joint commands
  ros::SteadyTimer diagnostics_timer_;
};

}  // namespace endovascular_sim::nodes
