#include "nodes/conversions/robot_conversions.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "nodes/conversions/command_topics.h"
#include "nodes/conversions/joint_state_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::array<const char*, 3> kJoints = {names::kInsertionJoint, names::kRotationJoint, names::kPressureJoint};

std::size_t indexOf(robot::Motion motion)
{
  return static_cast<std::size_t>(motion);
}

}  // namespace

robot::Motions motionsOf(const sensor_msgs::JointState& message, const std::vector<double>& values)
{
  robot::Motions motions = {};
  for (std::size_t k = 0; k < motions.size(); ++k)
  {
    const std::optional<std::size_t> joint = jointOf(message, kJoints[k]);
    if (joint && *joint < values.size())
      motions[k] = values[*joint];
  }
  return motions;
}

sensor_msgs::JointState toMessage(const drive::JointCommand& command)
{
  sensor_msgs::JointState message;
  std::vector<double>& values = valuesOf(message, command.kind);
  values.push_back(command.insertion);
  if (command.rotation)
    values.push_back(*command.rotation);
  if (command.rotation && command.pressure)
    values.push_back(*command.pressure);
  return message;
}

void toMessage(const robot::RobotControl& control, const std::vector<sensor_msgs::JointState>& instruments,
               sensor_msgs::JointState& joints)
{
  joints.header = instruments.front().header;
  const bool has_rates = !instruments.front().velocity.empty();
  joints.name.clear();
  joints.position.clear();
  joints.velocity.clear();
  joints.effort.clear();
  for (std::size_t k = 0; k < control.links().size(); ++k)
  {
    const robot::JointLink& link = control.links()[k];
    const sensor_msgs::JointState& message = instruments[control.instrumentOf(k)];
    joints.name.push_back(link.joint);
    joints.position.push_back(control.position(k, motionsOf(message, message.position)[indexOf(link.motion)]));
    if (!has_rates)
      continue;
    joints.velocity.push_back(motionsOf(message, message.velocity)[indexOf(link.motion)] / link.ratio);
    joints.effort.push_back(motionsOf(message, message.effort)[indexOf(link.motion)] * link.ratio);
  }
}

void toAllJoints(const robot::RobotControl& control, const sensor_msgs::JointState& linked,
                 sensor_msgs::JointState& all)
{
  all.header.stamp = linked.header.stamp;
  all.name = control.allNames();
  all.position = control.allJoints(linked.position, true);
  if (!linked.velocity.empty())
    all.velocity = control.allJoints(linked.velocity, false);
}

geometry_msgs::TransformStamped toTransform(const scene::RobotScene& robot)
{
  const Eigen::Isometry3d pose = robot.pose();
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id =
      robot.frame == scene::RobotFrame::kIntroducer ? names::kIntroducerFrame : names::kPatientFrame;
  transform.child_frame_id = robot.model.root_link;
  transform.transform.translation.x = pose.translation().x();
  transform.transform.translation.y = pose.translation().y();
  transform.transform.translation.z = pose.translation().z();
  transform.transform.rotation.w = rotation.w();
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  return transform;
}

robot::RobotControl robotControl(const scene::Scene& scene)
{
  std::vector<robot::RobotInstrument> instruments;
  for (const robot::JointLink& link : scene.robot->joints)
    for (const scene::DrivenInstrument& driven : scene.instruments)
    {
      const bool is_listed =
          std::any_of(instruments.begin(), instruments.end(),
                      [&](const robot::RobotInstrument& other) { return other.name == link.instrument; });
      if (driven.instrument.name != link.instrument || is_listed)
        continue;
      const scene::DriveScene& drive = driven.drive;
      instruments.push_back({link.instrument,
                             drive.limits.beyond,
                             drive.limits.time_out,
                             {drive.insertionAt(0.0), drive.rotationAt(0.0), drive.pressureAt(0.0)}});
    }
  return {scene.robot->model, scene.robot->joints, instruments};
}

}  // namespace endovascular_sim::nodes
