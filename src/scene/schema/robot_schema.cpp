#include <algorithm>

#include "scene/schema/scene_schema.h"

// Schema of a robot: its URDF, where it stands, and which motion each joint causes.

namespace endovascular_sim::scene
{
namespace
{

const std::vector<std::string> kFrames = {"introducer", "patient"};               // order of RobotFrame
const std::vector<std::string> kMotions = {"insertion", "rotation", "pressure"};  // order of robot::Motion

void visitPose(yaml::Fields& fields, RobotScene& robot)
{
  fields.option("frame", robot.frame, kFrames);
  fields.vector3("position", robot.position, quantities::kPosition);
  fields.vector3("rpy", robot.rpy, quantities::kAngle);
}

/** Rejects a motion that the instrument does not have, or that no command moves. */
void checkInstrument(const yaml::Fields& fields, const Scene& scene, const robot::JointLink& link)
{
  std::string names;
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
  {
    const DrivenInstrument& driven = scene.instruments[k];
    names += (names.empty() ? "" : ", ") + driven.instrument.name;
    if (driven.instrument.name != link.instrument)
      continue;
    if (driven.drive.source != DriveSource::kTopic)
      fields.reject("instrument", "'" + link.instrument + "' is not driven by commands; set " + drivePath(scene, k) +
                                      "drive.source: topic");
    if (link.motion == robot::Motion::kPressure && !driven.instrument.balloon)
      fields.reject("motion", "is pressure, but '" + link.instrument +
                                  "' has no balloon; give insertion or rotation, or use a balloon_catheter");
    return;
  }
  fields.reject("instrument", "the scene has no instrument '" + link.instrument + "'; it has " + names);
}

/** Rejects a joint that is listed twice, and a second joint of one motion. */
void checkUnique(const yaml::Fields& fields, const std::vector<robot::JointLink>& links, std::size_t k)
{
  for (std::size_t other = 0; other < k; ++other)
  {
    if (links[other].joint == links[k].joint)
      fields.reject("joint", "'" + links[k].joint + "' is that of robot.joints." + std::to_string(other) +
                                 " too; a joint moves one instrument, so give each entry another joint");
    if (links[other].instrument == links[k].instrument && links[other].motion == links[k].motion)
      fields.reject("motion", "joint '" + links[other].joint + "' (robot.joints." + std::to_string(other) +
                                  ") already moves the " + kMotions[static_cast<std::size_t>(links[k].motion)] +
                                  " of '" + links[k].instrument +
                                  "'; give one joint for each motion, and the others a <mimic> in the URDF");
  }
}

void visitLink(yaml::Fields& fields, const Scene& scene, std::vector<robot::JointLink>& links, std::size_t k)
{
  robot::JointLink& link = links[k];
  fields.text("joint", link.joint, Need::kRequired);
  fields.text("instrument", link.instrument, Need::kRequired);
  fields.option("motion", link.motion, kMotions, Need::kRequired);
  fields.number("ratio", link.ratio, quantities::kJointRatio, Range::any());
  fields.number("offset", link.offset, quantities::kJointOffset, Range::any());
  fields.number("backlash", link.backlash, quantities::kBacklash, Range::nonNegative());
  if (!fields.reading())
    return;
  if (link.ratio == 0.0)
    fields.reject("ratio",
                  "is 0, so the joint moves nothing; give the motion of the instrument per motion of the joint");
  checkInstrument(fields, scene, link);
  checkUnique(fields, links, k);
}

}  // namespace

void visitRobot(yaml::Fields& fields, Scene& scene)
{
  if (!scene.robot)
    scene.robot.emplace();
  RobotScene& robot = *scene.robot;
  fields.text("urdf", robot.urdf, Need::kRequired);
  fields.map("pose", [&robot](yaml::Fields& pose) { visitPose(pose, robot); });
  std::vector<robot::JointLink>& links = robot.joints;
  fields.list(
      "joints", links.size(), [&links](std::size_t size) { links.resize(size); },
      [&scene, &links](yaml::Fields& joint, std::size_t k) { visitLink(joint, scene, links, k); }, Need::kRequired);
}

}  // namespace endovascular_sim::scene
