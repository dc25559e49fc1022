#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "flow/coupling/flow_source.h"
#include "motion/motion_controls.h"
#include "nodes/session/bag_records.h"
#include "simulation/contrast_injections.h"

namespace endovascular_sim::nodes
{

/** Content of a recorded session that a replay needs. */
struct SessionBag
{
  SessionInfo info;
  VesselMeshConstPtr mesh;              ///< initial wall; null without a vessel
  VesselCentrelineConstPtr centreline;  ///< null without a vessel
  std::map<std::uint64_t, DriveAppliedConstPtr> steps;
  /** Controls of the flow of blood in this run, by the first step that has them as input. */
  std::map<std::uint64_t, flow::FlowControls> controls;
  /** Controls of the patient's motion in this run, in the same way. */
  std::map<std::uint64_t, motion::MotionControls> motion_controls;
  /** Injections of contrast medium in this run, by their first step, in their order. */
  std::map<std::uint64_t, std::vector<simulation::ContrastInput>> injections;
  std::uint64_t first_step = 0;  ///< number of steps before the first one of the recording
  std::string state;             ///< saved state from which the recording continues; empty at the scene's beginning
  std::optional<std::uint64_t> recorded_steps;  ///< number of steps of the session; empty: the bag has no end
  std::string damage;                           ///< first damage of the file; empty without one
};

/** Reports whether a full topic name ends with a name of the graph; scenes may run in any namespace. */
bool isTopic(const std::string& topic, const std::string& name);

/** Identity of a session, also of a former version, whose later fields are then empty.
 *  @throws ros::Exception when the message ends too early */
SessionInfo sessionInfo(const BagMessage& message);

/** Reads a bag of the session node without its index. Reading ends at a truncation.
 *  @throws InputError when it holds no session, or a session with another physics number than kPhysicsNumber: the error
 *          names the version and the commit that can replay it */
SessionBag readSessionBag(const std::string& file);

/** Reason for which a bag does not hold every step of its session; empty if it does. */
std::string incompleteness(const SessionBag& session);

}  // namespace endovascular_sim::nodes
