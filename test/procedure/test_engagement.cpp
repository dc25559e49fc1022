#include <gtest/gtest.h>

#include "procedure/perturbation.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "session/session.h"

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
  session::SessionSettings settings;
  settings.results = true;
  session::Session session(session::World::make(engagement()), settings);
  session.reset(3);
  session.setLastStep(120000);
  while (session.step(1000) > 0)
  {
  }
  EXPECT_EQ(session.scriptedOperator()->progress(), Progress::kDone) << session.scriptedOperator()->failure();
  const results::SessionMetrics& metrics = *session.record().metrics();
  EXPECT_EQ(metrics.locator().name(metrics.samples().back().observation.instruments[1].branch_position.branch),
            "left_main");
  session.finish(testing::TempDir() + "engagement", session::RecordFiles::kMetrics);  // with the operator's records
  EXPECT_TRUE(metrics.wrongBranches().empty());
}

}  // namespace
}  // namespace endovascular_sim::procedure
