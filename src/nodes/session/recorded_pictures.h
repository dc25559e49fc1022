#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <ros/time.h>

#include "geometry/triangle_mesh.h"
#include "nodes/fluoroscopy/x_ray_room.h"
#include "nodes/session/bag_records.h"

namespace endovascular_sim::nodes
{

/** Name of the picture of an X-ray frame, from 0. */
std::string pictureName(std::uint64_t frame);

/** X-ray pictures of a recording, at the frames at which the session node saved them. Frames that the bag holds are
 *  written as they are; all others are rendered from the recorded instruments, balloons, wall and commands of the
 * C-arm. */
class RecordedPictures
{
public:
  /** @param scene of the recording, with fluoroscopy
   *  @param interval of the pictures [frames]
   *  @param folder of the results; pictures are written into its existing folder `fluoroscopy`
   *  @throws InputError when the material library is invalid */
  RecordedPictures(const scene::Scene& scene, std::uint32_t interval, std::string folder);

  /** Takes over a message of the bag, in the order of the bag.
   *  @throws InputError for an invalid message, or a picture that cannot be written */
  void add(const BagMessage& message);

  std::uint64_t pictures() const { return pictures_; }  ///< number of pictures written

private:
  void addScene(const BagMessage& message);
  void addFrame(const ros::Time& time);
  void loadPatient();
  bool isDue(std::uint64_t frame) const { return frame % interval_ == 0; }

  bool has_images_;  ///< the bag holds every frame
  std::uint32_t interval_;
  std::string folder_;
  XRayRoom room_;
  PulseStates states_;                    ///< every recorded state
  std::optional<ros::Time> gantry_time_;  ///< time up to which the C-arm has moved
  geometry::TriangleMesh wall_;
  bool wall_moved_ = false;  ///< since the last picture
  std::uint64_t frames_ = 0;
  std::uint64_t pictures_ = 0;
};

}  // namespace endovascular_sim::nodes
