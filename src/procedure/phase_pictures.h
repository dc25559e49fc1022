#pragma once

#include <string>

#include "procedure/operator.h"
#include "session/simulation.h"
#include "session/x_ray_room.h"
#include "vessel/mesh.h"

namespace endovascular_sim::procedure
{

/** Fluoroscopy of a procedure: a picture at the end of every phase, `fluoroscopy/phase_01.png` and so on. */
class PhasePictures
{
public:
  /** @param scene with fluoroscopy; must outlive this
   *  @param folder of the results
   *  @throws InputError when the scene has no fluoroscopy or the folder cannot be made */
  PhasePictures(const session::Scene& scene, const std::string& folder);

  /** After every step, and once after the last one. @param wall as it is now */
  void look(const session::Simulation& simulation, const Operator& person, const vessel::TriangleMesh& wall);

private:
  void take(const session::Simulation& simulation, const vessel::TriangleMesh& wall);

  session::XRayRoom room_;
  std::string folder_;
  std::string phase_;
  int taken_ = 0;
  bool over_ = false;
};

}  // namespace endovascular_sim::procedure
