#pragma once

#include <cstdint>
#include <string>

#include "nodes/session/bag_writer.h"
#include "nodes/session/session_results.h"
#include "nodes/session/throttle.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Recording of one run: its bag and its results, in one folder. */
struct Recording
{
  /** @param folder_ existing folder
   *  @param steps_ number of steps of the session; later ones are ignored
   *  @throws InputError when a file cannot be created */
  Recording(const scene::Scene& scene, std::string folder_, std::uint64_t steps_);

  std::string path(const std::string& name) const { return folder + "/" + name; }

  /** Reports whether all steps of the session are recorded. */
  bool isComplete() const { return results.report().lastStep() >= steps; }

  std::string folder;
  std::uint64_t steps;  ///< number of steps of the session
  SessionResults results;
  BagWriter bag;
  Throttle pose, joints, contacts;
  std::uint64_t frames = 0;
  std::string error;  ///< reason of an early end; empty without one
};

/** Creates the folder of a recording, which must not contain an earlier one. @return the folder
 *  @throws InputError when it cannot be created */
std::string createRecordingFolder(const std::string& folder);

}  // namespace endovascular_sim::nodes
