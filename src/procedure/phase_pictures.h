#pragma once

#include <string>

#include "geometry/triangle_mesh.h"
#include "procedure/operator.h"
#include "simulation/simulation.h"
#include "simulation/still_image.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::procedure
{

/** Fluoroscopy images of a procedure, one at the end of each phase in the phase's view: `fluoroscopy/phase_01.png` and
 *  so on. */
class PhasePictures
{
public:
  /** @param scene scene with fluoroscopy; must outlive this object
   *  @param vessel vessel of the scene at rest, about which its patient is placed
   *  @param folder folder of the results
   *  @throws InputError if the scene has no fluoroscopy or the folder cannot be created */
  PhasePictures(const scene::Scene& scene, const vessel::Vessel& vessel, const std::string& folder);

  /** Writes an image if a phase has ended; to be called after each step and once at the end.
   *  @param wall present wall of the vessel */
  void update(const simulation::Simulation& simulation, const Operator& scripted_operator,
              const geometry::TriangleMesh& wall);

private:
  void writeImage(const simulation::Simulation& simulation, const geometry::TriangleMesh& wall);

  simulation::StillImage image_;
  std::string folder_;
  std::string phase_, view_;  ///< of the latest step
  int images_ = 0;
  bool finished_ = false;
};

}  // namespace endovascular_sim::procedure
