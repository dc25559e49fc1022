#pragma once

#include <string>

#include "geometry/triangle_mesh.h"
#include "procedure/operator.h"
#include "simulation/fluoroscopy_system.h"
#include "simulation/simulation.h"

namespace endovascular_sim::procedure
{

/** Fluoroscopy of a procedure: a picture at the end of every phase, `fluoroscopy/phase_01.png` and so on. */
class PhasePictures
{
public:
  /** @param scene with fluoroscopy; must outlive this
   *  @param folder of the results
   *  @throws InputError when the scene has no fluoroscopy or the folder cannot be made */
  PhasePictures(const scene::Scene& scene, const std::string& folder);

  /** After every step, and once after the last one. @param wall as it is now */
  void look(const simulation::Simulation& simulation, const Operator& person, const geometry::TriangleMesh& wall);

private:
  void take(const simulation::Simulation& simulation, const geometry::TriangleMesh& wall);

  simulation::FluoroscopySystem room_;
  std::string folder_;
  std::string phase_;
  int taken_ = 0;
  bool over_ = false;
};

}  // namespace endovascular_sim::procedure
