#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "simulation/fluoroscopy_system.h"
#include "simulation/simulation.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::simulation
{

/** Single X-ray images of a simulation, with the pose, technique and patient of its scene. With `follow_tip`, or
 * without `isocentre`, the isocentre is the tip of the instrument that reaches farthest. */
class StillImage
{
public:
  /** @param scene scene with fluoroscopy; must outlive this object
   *  @param vessel vessel of the scene at rest, about which its patient is placed
   *  @throws InputError if the scene has no fluoroscopy, or its patient cannot be loaded */
  StillImage(const scene::Scene& scene, const vessel::Vessel& vessel);

  /** Origin and placement of the patient, for the log. */
  const std::vector<std::string>& notes() const { return notes_; }

  /** Sets the angles of a view in clinical notation (fluoroscopy::parseView()). An unknown name changes nothing. */
  void setView(const std::string& view);

  /** Writes the image of a simulation as PNG.
   *  @param wall present wall of the vessel; empty without a vessel
   *  @throws InputError if the file cannot be written */
  void write(const Simulation& simulation, const geometry::TriangleMesh& wall, const std::string& file);

private:
  FluoroscopySystem system_;
  bool at_tip_;
  std::vector<std::string> notes_;
};

}  // namespace endovascular_sim::simulation
