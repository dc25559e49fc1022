#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <ros/message_event.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "nodes/session/bag_writer.h"
#include "nodes/session/session_results.h"
#include "nodes/session/throttle.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Rates of hemodynamics/phase and hemodynamics/flow in bags [Hz]. */
constexpr double kHeartRate = 50.0, kFlowRate = 10.0;

/** Messages that belong to the poses since the last recorded one, by their steps. */
template <typename Message>
using PoseParts = std::map<std::uint64_t, ros::MessageEvent<Message const>>;

/** Recording of one run: its bag and its results, in one folder. */
struct Recording
{
  /** @param folder_ existing folder
   *  @param bag_name name of the bag, see RunBags
   *  @param steps_ number of steps of the session; later ones are ignored
   *  @throws InputError when a file cannot be created */
  Recording(const scene::Scene& scene, std::string folder_, std::uint64_t steps_,
            const std::string& bag_name = "session.bag");

  std::string path(const std::string& name) const { return folder + "/" + name; }

  /** Reports whether all steps of the session are recorded. */
  bool isComplete() const { return results.report().lastStep() >= steps; }

  std::string folder;
  std::uint64_t steps;  ///< number of steps of the session
  BagWriter bag;        ///< before the results, whose files are not touched where no bag can be created
  SessionResults results;
  Throttle pose, joints, contacts, heart, flow;
  std::uint64_t frames = 0;  ///< X-ray frames that have arrived
  /** Newest state of the wires that is not recorded yet; empty without one. */
  std::optional<ros::MessageEvent<RodStateVisual const>> newest_pose;
  PoseParts<MotionState> motions;          ///< of the patient
  PoseParts<ContrastState> contrasts;      ///< in vessel and instruments
  std::optional<std::uint64_t> pose_step;  ///< step of the last recorded pose
  /** Newest map of the wall forces that is not recorded yet; empty without one. */
  std::optional<ros::MessageEvent<ContactForceMap const>> newest_map;
  double last_map = 0.0, next_map = 0.0;  ///< times of the last recorded map and of the next one [s]
  std::vector<std::string> previous;      ///< names of the bags of the run before this one
  std::string error;                      ///< reason of an early end; empty without one
};

/** Number of the X-ray frame after those that are saved as pictures in a folder. */
std::uint64_t nextFrame(const std::string& folder);

/** Creates the folder of a recording, which must not contain an earlier one. @return the folder
 *  @throws InputError when it cannot be created */
std::string createRecordingFolder(const std::string& folder);

}  // namespace endovascular_sim::nodes
