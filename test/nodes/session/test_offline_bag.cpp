#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/offline_bag.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "session/session.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::nodes
{
namespace
{

TEST(OfflineBag, OfAMovingPatientReplaysWithItsControls)
{
  const TemporaryFolder folder;
  const std::string file = folder.file("session.bag");
  session::Session session(session::World::open(TEST_DATA_DIR "/catheter_in_motion.yaml"));
  OfflineBag bag(file, session, "");
  const auto advance = [&session, &bag](int steps)
  {
    for (int k = 0; k < steps; ++k)
    {
      session.step();
      bag.addStep(session);
    }
  };
  advance(100);
  session.setMotionControls({2.0, 0.5, true});
  advance(900);
  bag.close();

  const SessionBag recording = readSessionBag(file);
  ASSERT_EQ(recording.motion_controls.size(), 2U);
  EXPECT_EQ(recording.motion_controls.at(0), (motion::MotionControls{1.25, 0.25, false}));
  EXPECT_EQ(recording.motion_controls.at(100), (motion::MotionControls{2.0, 0.5, true}));
  RecordedSimulation replay(recording, file);
  for (const auto& [step, applied] : recording.steps)
    replay.step(*applied);
  EXPECT_EQ(replay.simulation().trajectoryHash(), session.simulation().trajectoryHash());
  ASSERT_NE(replay.simulation().motion(), nullptr);
  EXPECT_EQ(replay.simulation().motion()->patient().heart().phase(), session.observe().motion()->heart().phase());
  EXPECT_EQ(replay.simulation().motion()->controls(), session.motionControls());
}

TEST(OfflineBag, HasTheMotionBeforeEveryStateOfTheInstruments)
{
  const TemporaryFolder folder;
  const std::string file = folder.file("session.bag");
  session::Session session(session::World::open(TEST_DATA_DIR "/catheter_in_motion.yaml"));
  OfflineBag bag(file, session, "");
  for (int k = 0; k < 300; ++k)
  {
    session.step();
    bag.addStep(session);
  }
  bag.close();
  int states = 0, rods = 0;
  std::uint64_t newest = 0;
  readBagMessages(file,
                  [&](const BagMessage& message)
                  {
                    if (isTopic(message.topic, names::kMotionState))
                    {
                      newest = message.read<MotionState>()->step;
                      ++states;
                    }
                    if (!isTopic(message.topic, names::kRodStateVisual))
                      return;
                    ++rods;
                    EXPECT_EQ(message.read<RodStateVisual>()->step, newest);
                  });
  EXPECT_EQ(states, rods);
  EXPECT_GE(rods, 9);
}

}  // namespace
}  // namespace endovascular_sim::nodes
