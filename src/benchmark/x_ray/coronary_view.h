#pragma once

#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/projection/wire.h"
#include "scene/model/scene.h"
#include "simulation/fluoroscopy_system.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::benchmark
{

/** View of the left coronary artery in the default anatomy: the procedural body, and the three instruments of `pci` on
 *  the centreline from the femoral artery into the left anterior descending artery. */
struct CoronaryView
{
  scene::Scene scene;
  vessel::Vessel vessel;
  std::vector<Eigen::Vector3d> path;  ///< centreline from the femoral artery, nodes about 2 mm apart [m]
  Eigen::Vector3d centre;             ///< of the view [m]

  /** @throws InputError if the scene `pci` of the package is not found */
  CoronaryView();

  /** X-ray system with the body and the vessel.
   *  @param pixels per side of the image */
  simulation::FluoroscopySystem system(int pixels);

  /** The instruments, 20 and 60 mm behind each other from the inside out. */
  std::vector<fluoroscopy::XRayWire> wires(const simulation::FluoroscopySystem& system) const;
};

}  // namespace endovascular_sim::benchmark
