#include "nodes/session/session_identity.h"

#include <algorithm>
#include <vector>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include "common/hash.h"
#include "common/version.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SensorReading.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SessionGap.h"
#include "endovascular_sim/SessionMark.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/SimulationRun.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "scene/model/portable_text.h"

namespace endovascular_sim::nodes
{
namespace
{

template <typename... Messages>
std::vector<std::string> hashesOf()
{
  std::vector<std::string> hashes = {std::string(ros::message_traits::datatype<Messages>()) + " " +
                                     ros::message_traits::md5sum<Messages>()...};
  std::sort(hashes.begin(), hashes.end());
  return hashes;
}

/** Types of all recorded messages, with their hashes. */
std::vector<std::string> hashesOfRecordedMessages()
{
  return hashesOf<CArm, ContactForceMap, ContactForces, DriveApplied, ProcedureStep, RodStateVisual, SensorReading,
                  SessionEnd, SessionGap, SessionInfo, SessionMark, SessionSample, SimulationRun, TreatmentVisual,
                  VesselCentreline, VesselMesh, WallDisplacement, crtk_msgs::OperatingState, crtk_msgs::StringStamped,
                  diagnostic_msgs::DiagnosticArray, sensor_msgs::CameraInfo, sensor_msgs::Image,
                  sensor_msgs::JointState, tf2_msgs::TFMessage>();
}

}  // namespace

SessionInfo infoOf(const scene::Scene& scene, const std::string& subject)
{
  SessionInfo info;
  info.scene_name = scene.name;
  info.scene_yaml = scene::withoutFolders(scene.resolved_yaml);
  Hash64 hash;
  hash.add(info.scene_yaml);
  info.scene_hash = hash.value();
  info.subject = subject;
  info.message_hashes = hashesOfRecordedMessages();
  info.seed = scene.seed;
  info.time_step = scene.solver.time_step;
  info.software_version = version();
  info.commit = commit();
  info.physics_number = kPhysicsNumber;
  return info;
}

}  // namespace endovascular_sim::nodes
