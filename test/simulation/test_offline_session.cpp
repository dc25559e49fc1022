#include "simulation/offline_session.h"

#include <gtest/gtest.h>

#include "common/error.h"

namespace endovascular_sim::simulation
{
namespace
{

TEST(OfflineSession, FindsABundledSceneByItsName)
{
  const OfflineSession by_name("tube");
  const OfflineSession by_path(PROJECT_DIR "/config/scenes/tube.yaml");
  EXPECT_EQ(by_name.scene().resolved_yaml, by_path.scene().resolved_yaml);
}

TEST(OfflineSession, EndsAfterTheDurationOfTheScene)
{
  OfflineSession session("tube", {"duration=0.01"});
  while (!session.isOver())
    session.step();
  EXPECT_EQ(session.simulation().steps(), 10U);
}

TEST(OfflineSession, NeedsNoVessel)
{
  OfflineSession session("straight_wire", {"duration=0.01"});
  session.step();
  EXPECT_EQ(session.vessel(), nullptr);
  EXPECT_EQ(session.simulation().steps(), 1U);
}

TEST(OfflineSession, RefusesASceneThatDoesNotExist)
{
  EXPECT_THROW(OfflineSession("no_such_scene"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::simulation
