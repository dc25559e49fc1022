#include "procedure/phase_pictures.h"
#include "scene/scene_file.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "common/error.h"
#include "contact/detector.h"
#include "results/session_run.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::procedure
{
namespace
{

scene::Scene twoPhases(const std::string& fluoroscopy, const std::string& second_view = "")
{
  return scene::parseScene(
      "vessel: {friction: 0.1, tube: {radius: 0.01, pieces: [{length: 0.2}]}}\n"
      "entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}\n"
      "instruments:\n"
      "  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: procedure, initial_insertion: 0.06}}\n" +
          fluoroscopy +
          "procedure:\n"
          "  steps:\n"
          "    - {phase: First, advance: wire, until: {insertion: 0.07}, speed: 0.05}\n"
          "    - {phase: First, wait: 0.05}\n"
          "    - {phase: Second, wait: 0.05" +
          second_view + "}\n",
      "test scene");
}

/** Wire in a tube with a scripted operator. */
struct World
{
  scene::Scene scene;
  vessel::Vessel vessel;
  contact::Detector wall;
  scene::EntryPose entry;
  simulation::Simulation simulation;
  results::SessionRun session;

  explicit World(const scene::Scene& the_scene)
    : scene(the_scene),
      vessel(scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::centrelineUse(scene))),
      wall(vessel.mesh, scene::wallLaw(*scene.vessel)),
      entry(scene::resolveEntry(scene.entry, vessel, scene.file)),
      simulation(scene, entry, &wall, &vessel.centreline),
      session(scene, vessel, entry.position)
  {
  }
};

/** Runs a scene and writes its pictures into a folder. */
void takePictures(const scene::Scene& scene, const std::string& folder)
{
  World world(scene);
  PhasePictures pictures(world.scene, world.vessel, folder);
  for (int k = 0; k < 3000 && !world.session.isFinished(); ++k)
  {
    world.simulation.stepAll(world.session.commands(world.simulation));
    pictures.update(world.simulation, *world.session.scriptedOperator(), world.vessel.mesh);
  }
  pictures.update(world.simulation, *world.session.scriptedOperator(), world.vessel.mesh);
  ASSERT_EQ(world.session.scriptedOperator()->progress(), Progress::kDone)
      << world.session.scriptedOperator()->failure();
}

std::string contentOf(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PhasePictures, AreWrittenAtTheEndOfEachPhase)
{
  const std::string folder = testing::TempDir() + "phase_pictures_" + std::to_string(getpid());
  takePictures(twoPhases("fluoroscopy: {pixels: 64}\n"), folder);
  EXPECT_GT(std::filesystem::file_size(folder + "/fluoroscopy/phase_01.png"), 100U);
  EXPECT_GT(std::filesystem::file_size(folder + "/fluoroscopy/phase_02.png"), 100U);
  EXPECT_FALSE(std::filesystem::exists(folder + "/fluoroscopy/phase_03.png"));
  std::filesystem::remove_all(folder);
}

TEST(PhasePictures, HaveTheViewOfTheirPhase)
{
  const std::string folder = testing::TempDir() + "phase_views_" + std::to_string(getpid());
  takePictures(twoPhases("fluoroscopy: {pixels: 64}\n"), folder + "/ap");
  takePictures(twoPhases("fluoroscopy: {pixels: 64}\n", ", view: LAO 40 CRA 30"), folder + "/views");
  takePictures(twoPhases("fluoroscopy: {pixels: 64, view: LAO 40 CRA 30}\n"), folder + "/oblique");
  const auto picture = [&folder](const std::string& name) { return contentOf(folder + name); };
  EXPECT_EQ(picture("/views/fluoroscopy/phase_01.png"), picture("/ap/fluoroscopy/phase_01.png"));
  EXPECT_NE(picture("/views/fluoroscopy/phase_02.png"), picture("/ap/fluoroscopy/phase_02.png"));
  EXPECT_NE(picture("/oblique/fluoroscopy/phase_01.png"), picture("/ap/fluoroscopy/phase_01.png"));
  std::filesystem::remove_all(folder);
}

TEST(PhasePictures, ShowTheInsertedInstruments)
{
  World world(twoPhases("fluoroscopy: {pixels: 128, iodine: 0, isocentre: [0, 0, 0.04]}\n"));
  simulation::FluoroscopySystem system(
      world.scene, fluoroscopy::MaterialLibrary::load(std::string(PROJECT_DIR) + "/config/xray/materials.yaml"));
  system.fluoroscope().setVessel(world.vessel.mesh);
  const std::vector<std::uint16_t> empty = system.fluoroscope().render({}).raw;
  const std::vector<fluoroscopy::XRayWire> wires = system.wires(world.simulation);
  ASSERT_FALSE(wires.empty());
  system.fluoroscope().restart();  // equal noise
  const std::vector<std::uint16_t> seen = system.fluoroscope().render(wires).raw;
  int darker = 0;
  for (std::size_t k = 0; k < seen.size(); ++k)
  {
    EXPECT_LE(seen[k], empty[k] + 3);
    darker += seen[k] < 0.9 * empty[k];
  }
  EXPECT_GT(darker, 10);
  EXPECT_LT(darker, 1000);
}

TEST(PhasePictures, RequireASceneWithFluoroscopy)
{
  const scene::Scene scene = twoPhases("");
  EXPECT_THROW(PhasePictures(scene, vessel::Vessel(), testing::TempDir()), InputError);
}

}  // namespace
}  // namespace endovascular_sim::procedure
