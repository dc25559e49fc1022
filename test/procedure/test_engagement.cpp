#include <gtest/gtest.h>

#include "contact/detector.h"
#include "procedure/perturbation.h"
#include "procedure/session_run.h"
#include "session/moving_wall.h"
#include "session/scene.h"
#include "session/scene_vessel.h"
#include "session/simulation.h"

namespace endovascular_sim::procedure
{
namespace
{

/** pci.yaml through the engagement, with the wire and the catheter alone. */
session::Scene engagement()
{
  session::Scene scene = session::loadScene(PROJECT_DIR "/config/scenes/pci.yaml");
  scene = endingWith(std::move(scene), "Engagement");
  scene.instruments.erase(scene.instruments.begin(), scene.instruments.begin() + 2);
  return scene;
}

// `procedure_study --through Engagement` does it from ten starts; this is one of them.
TEST(Engagement, TheGuidingCatheterFindsTheLeftMainArteryFromAPerturbedStart)
{
  const session::Scene scene = perturbed(engagement(), Spread(), 3);
  const vessel::Vessel vessel =
      session::buildVessel(*scene.vessel, scene.entry, scene.file, session::CentrelineUse::kRequired);
  const session::EntryPose entry = session::resolveEntry(scene.entry, vessel, scene.file);
  contact::Detector wall(vessel.mesh, session::wallLaw(*scene.vessel));
  SessionRun run(scene, vessel, entry.position);
  session::Simulation simulation(scene, entry, &wall, &vessel.centreline);
  std::vector<session::WallContact> contacts;
  while (simulation.time() < 120.0 && !run.isOver())
  {
    simulation.stepAll(run.commands(simulation));
    session::wallContacts(simulation, contacts);
    run.addStep(simulation, contacts);
  }
  EXPECT_EQ(run.person()->progress(), Progress::kDone) << run.person()->failure();
  const InstrumentView& catheter = run.metrics().samples().back().seen.instruments[1];
  EXPECT_EQ(run.metrics().places().name(catheter.place.branch), "left_main");
  EXPECT_TRUE(run.metrics().wrongBranches().empty());
}

}  // namespace
}  // namespace endovascular_sim::procedure
