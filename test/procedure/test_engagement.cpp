#include <gtest/gtest.h>

#include "contact/detector.h"
#include "procedure/perturbation.h"
#include "results/session_run.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/simulation.h"

namespace endovascular_sim::procedure
{
namespace
{

/** Scene pci.yaml up to the engagement, with the wire and the catheter only. */
scene::Scene engagement()
{
  scene::Scene scene = scene::loadScene(PROJECT_DIR "/config/scenes/pci.yaml");
  scene = endingWith(std::move(scene), "Engagement");
  scene.instruments.erase(scene.instruments.begin(), scene.instruments.begin() + 2);
  return scene;
}

// One of the ten starts of `procedure_study --through Engagement`.
TEST(Engagement, SucceedsFromAPerturbedStart)
{
  const scene::Scene scene = perturbed(engagement(), Spread(), 3);
  const vessel::Vessel vessel =
      scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired);
  const scene::EntryPose entry = scene::resolveEntry(scene.entry, vessel, scene.file);
  contact::Detector wall(vessel.mesh, scene::wallLaw(*scene.vessel));
  results::SessionRun run(scene, vessel, entry.position);
  simulation::Simulation simulation(scene, entry, &wall, &vessel.centreline);
  std::vector<simulation::WallContact> contacts;
  while (simulation.time() < 120.0 && !run.isFinished())
  {
    simulation.stepAll(run.commands(simulation));
    simulation::wallContacts(simulation, contacts);
    run.addStep(simulation, contacts);
  }
  EXPECT_EQ(run.scriptedOperator()->progress(), Progress::kDone) << run.scriptedOperator()->failure();
  const InstrumentView& catheter = run.metrics().samples().back().observation.instruments[1];
  EXPECT_EQ(run.metrics().locator().name(catheter.branch_position.branch), "left_main");
  EXPECT_TRUE(run.metrics().wrongBranches().empty());
}

}  // namespace
}  // namespace endovascular_sim::procedure
