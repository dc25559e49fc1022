#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SessionInfo.h"
#include "nodes/session/bag_records.h"
#include "nodes/session/session_results.h"

namespace endovascular_sim::nodes
{

/** What a bag says about its session as a whole. */
struct BagOutline
{
  std::optional<SessionInfo> info;
  std::optional<SessionEnd> end;  ///< empty: the bag has no end
  std::uint64_t messages = 0;
  std::string damage;  ///< first damage of the file; empty without one
};

/** Reads the outline of a bag.
 *  @throws InputError when the file is no bag */
BagOutline outlineOf(const std::string& file);

/** Adds the messages of a bag to results, in the order in which the session node recorded them. Messages that cannot be
 *  read, or that the scene refuses, are left out.
 *  @param also called for every message
 *  @return number of messages left out
 *  @throws InputError when the file is no bag */
std::uint64_t addBag(const std::string& file, SessionResults& results,
                     const std::function<void(const BagMessage&)>& also = nullptr);

/** Files that the bags of one session give. */
struct BagResultFiles
{
  bool is_complete = false;         ///< every message of complete bags was used, and every file was written
  std::uint64_t left_out = 0;       ///< messages that could not be used
  std::vector<std::string> damage;  ///< of the bags; empty without any
  std::string verdict;              ///< on a lesson; empty without pass marks
};

/** Writes the files of the session node from the bags of a session alone: scene.yaml, trajectory.csv, report.json,
 *  wall_forces.csv, vessel_points.csv, metrics.json, metrics.html, instruments.csv and the X-ray pictures. Nothing is
 *  simulated. Noise and C-arm of the pictures are rendered again; without `record.x_ray_frames` they differ from those
 * of the session by noise, and by the motion of a frame.
 *  @param files bags of the session in their order; several when its recorder was started again
 *  @param folder created if missing
 *  @param pictures false: no X-ray pictures
 *  @throws InputError when a bag holds no scene, or a file cannot be written */
BagResultFiles writeResults(const std::vector<std::string>& files, const std::string& folder, bool pictures);

}  // namespace endovascular_sim::nodes
