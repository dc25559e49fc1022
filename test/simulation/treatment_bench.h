#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "contact/detector.h"
#include "scene/scene_file.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{

/** Scene with a vessel whose wall balloons move. */
struct TreatmentBench
{
  explicit TreatmentBench(const std::vector<std::string>& overrides = {},
                          const std::string& file = TEST_DATA_DIR "/scenes/good_inflation.yaml")
    : scene(scene::loadScene(file, overrides)),
      vessel(scene::buildVessel(*scene.vessel, scene.entry, scene.file)),
      detector(vessel.mesh, scene::wallLaw(*scene.vessel)),
      wall(vessel, detector),
      simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &detector, &vessel.centreline, &wall)
  {
  }

  void runTo(double time)
  {
    while (simulation.time() < time - 0.5 * scene.solver.time_step)
    {
      simulation.stepAll(commandsAt(scene, simulation.time() + scene.solver.time_step));
      rejected += !simulation.report().solved;
      deepest = std::max(deepest, simulation.surfacePenetration());
    }
  }

  /** Least radius of the lumen [m]. */
  double narrowest() const
  {
    double radius = 1.0;
    for (const Eigen::Vector3d& v : detector.wall().vertices)
      if (v.z() > 0.01 && v.z() < 0.07)
        radius = std::min(radius, v.head<2>().norm());
    return radius;
  }

  bool happened(TreatmentEvent event) const
  {
    for (const TimedEvent& timed : simulation.events())
      if (timed.event == event)
        return true;
    return false;
  }

  scene::Scene scene;
  vessel::Vessel vessel;
  contact::Detector detector;
  LocalDeformableWall wall;
  Simulation simulation;
  int rejected = 0;
  double deepest = 0.0;
};

}  // namespace endovascular_sim::simulation
