#pragma once

#include <string>

#include "geometry/triangle_mesh.h"
#include "session/world.h"
#include "simulation/fluoroscopy_system.h"
#include "simulation/simulation.h"

namespace endovascular_sim::session
{

/** Single X-ray images of a simulation, with the pose, technique and patient of its scene, and heart and lungs where
 * they are after the last step. With `follow_tip`, or without `isocentre`, the isocentre is the tip of the instrument
 * that reaches farthest. */
class StillImage
{
public:
  /** @param world with fluoroscopy, which must outlive this
   *  @throws InputError if the scene has no fluoroscopy, or its patient cannot be loaded */
  explicit StillImage(const World& world);

  /** Sets the angles of a view in clinical notation (fluoroscopy::parseView()).
   *  @param view empty: the angles of the scene
   *  @throws InputError for an unknown view, which changes nothing */
  void setView(const std::string& view);

  /** Begins a new sequence: the next image does not depend on those before it. */
  void restart() { system_.fluoroscope().restart(); }

  /** Next image of a simulation, valid until the next call.
   *  @param wall present wall of the vessel at rest, empty without one; null: that of the image before */
  const fluoroscopy::Frame& frame(const simulation::Simulation& simulation, const geometry::TriangleMesh* wall);

private:
  const World& world_;
  simulation::FluoroscopySystem system_;
  fluoroscopy::CArmPose scene_pose_, pose_;
  bool at_tip_;
};

}  // namespace endovascular_sim::session
