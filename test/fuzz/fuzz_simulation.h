#pragma once

#include <string>

#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "simulation/simulation.h"

namespace endovascular_sim::fuzz
{

/** Wire of a few nodes without a vessel. */
struct SmallSimulation
{
  SmallSimulation()
    : scene(scene::loadScene(PROJECT_DIR "/config/scenes/straight_wire.yaml", {"sampling.nodes=33"})),
      simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr)
  {
  }

  scene::Scene scene;
  simulation::Simulation simulation;
};

}  // namespace endovascular_sim::fuzz
