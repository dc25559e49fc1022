#include "scene/scene_file.h"
#include "session/phase_pictures.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::session
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

/** Runs a scene and writes its pictures into a folder. */
void takePictures(const scene::Scene& scene, const std::string& folder)
{
  Session session(World::make(scene));
  PhasePictures pictures(session.world(), folder);
  while (session.step() > 0)
    pictures.update(session);
  pictures.update(session);
  ASSERT_EQ(session.scriptedOperator()->progress(), procedure::Progress::kDone)
      << session.scriptedOperator()->failure();
}

TEST(PhasePictures, AreWrittenAtTheEndOfEachPhase)
{
  const TemporaryFolder folder;
  takePictures(twoPhases("fluoroscopy: {pixels: 64}\n"), folder.path());
  EXPECT_GT(std::filesystem::file_size(folder.file("fluoroscopy/phase_01.png")), 100U);
  EXPECT_GT(std::filesystem::file_size(folder.file("fluoroscopy/phase_02.png")), 100U);
  EXPECT_FALSE(std::filesystem::exists(folder.file("fluoroscopy/phase_03.png")));
}

TEST(PhasePictures, HaveTheViewOfTheirPhase)
{
  const TemporaryFolder folder;
  takePictures(twoPhases("fluoroscopy: {pixels: 64}\n"), folder.file("ap"));
  takePictures(twoPhases("fluoroscopy: {pixels: 64}\n", ", view: LAO 40 CRA 30"), folder.file("views"));
  takePictures(twoPhases("fluoroscopy: {pixels: 64, view: LAO 40 CRA 30}\n"), folder.file("oblique"));
  const auto picture = [&folder](const std::string& name) { return contentOf(folder.path() / name); };
  EXPECT_EQ(picture("views/fluoroscopy/phase_01.png"), picture("ap/fluoroscopy/phase_01.png"));
  EXPECT_NE(picture("views/fluoroscopy/phase_02.png"), picture("ap/fluoroscopy/phase_02.png"));
  EXPECT_NE(picture("oblique/fluoroscopy/phase_01.png"), picture("ap/fluoroscopy/phase_01.png"));
}

TEST(PhasePictures, ShowTheInsertedInstruments)
{
  const Session session(World::make(twoPhases("fluoroscopy: {pixels: 128, iodine: 0, isocentre: [0, 0, 0.04]}\n")));
  simulation::FluoroscopySystem system(
      session.scene(), fluoroscopy::MaterialLibrary::load(std::string(PROJECT_DIR) + "/config/xray/materials.yaml"));
  system.fluoroscope().setVessel(session.wall());
  const std::vector<std::uint16_t> empty = system.fluoroscope().render({}).raw;
  const std::vector<fluoroscopy::XRayWire> wires = system.wires(session.simulation());
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
  const std::shared_ptr<const World> world = World::make(twoPhases(""));
  EXPECT_THROW(PhasePictures(*world, testing::TempDir()), InputError);
}

}  // namespace
}  // namespace endovascular_sim::session
