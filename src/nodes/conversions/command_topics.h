#pragma once

#include <string>
#include <vector>

#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "drive/joint_command.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

/** Topic of a kind of command, below the name of an instrument or of the robot. */
struct CommandTopic
{
  const char* name;
  drive::CommandKind kind;
};

/** Topics of all kinds of commands. */
constexpr CommandTopic kCommandTopics[] = {
    {names::kServoJp, drive::CommandKind::kServoPosition}, {names::kServoJr, drive::CommandKind::kServoRelative},
    {names::kServoJv, drive::CommandKind::kServoVelocity}, {names::kServoJf, drive::CommandKind::kServoForce},
    {names::kMoveJp, drive::CommandKind::kMovePosition},   {names::kMoveJr, drive::CommandKind::kMoveRelative}};

/** Topic of a command without values. */
struct WordTopic
{
  const char* name;
  const char* word;  ///< name of the command
};

constexpr WordTopic kWordTopics[] = {{names::kHold, "hold"}, {names::kFree, "free"}};

/** Values that a kind of command uses.
 *  @param message sensor_msgs::JointState, constant or to fill */
template <typename JointState>
auto& valuesOf(JointState& message, drive::CommandKind kind)
{
  if (kind == drive::CommandKind::kServoVelocity)
    return message.velocity;
  return kind == drive::CommandKind::kServoForce ? message.effort : message.position;
}

/** Subscribes to commands.
 *  @param queue of the callback; null: that of the node handle
 *  @param callback called with a message event, which has the name of the sender */
template <typename Message, typename Callback>
ros::Subscriber subscribeToCommands(const ros::NodeHandle& node, const std::string& topic,
                                    ros::CallbackQueueInterface* queue, const Callback& callback)
{
  constexpr int kQueue = 10;
  return subscribeGuarded<Message>(node, topic, kQueue, callback, queue);
}

}  // namespace endovascular_sim::nodes
