#include "rviz_plugin/model/motion_obstacle.h"

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

/** A soft wire and a catheter outside, a wire inside: the soft wire does not fit beside the wire. */
SessionState running()
{
  InstrumentSummary soft_wire, wire, catheter;
  soft_wire.shape.name = "soft_wire";
  soft_wire.conflicts = {"wire"};
  wire.shape.name = "wire";
  wire.conflicts = {"soft_wire"};
  catheter.shape.name = "catheter";
  SessionState state;
  for (InstrumentSummary* instrument : {&soft_wire, &wire, &catheter})
  {
    instrument->takes_commands = true;
    instrument->force_limit = 5.0;
    instrument->torque_limit = 0.05;
    instrument->largest_insertion = 0.65;
    instrument->outside_insertion = -0.027;
    state.scene.instruments.push_back(*instrument);
  }
  state.has_wire = true;
  state.wire.insertion = {-0.027, 0.2, -0.027};
  state.wire.hand_force = {0.0, 0.0, 0.0};
  state.wire.hand_torque = {0.0, 0.0, 0.0};
  return state;
}

TEST(MotionObstacle, NamesTheInstrumentInTheWay)
{
  EXPECT_EQ(motionObstacle(running(), 0, 0.02), "waits outside: wire is in the way; pull it out first");
  EXPECT_EQ(motionObstacle(running(), 2, 0.02), "") << "the catheter fits over the wire";
  SessionState state = running();
  state.wire.insertion[1] = -0.027;
  EXPECT_EQ(motionObstacle(state, 0, 0.02), "");
  EXPECT_EQ(motionObstacle(state, 0, -0.02), "is out completely");
}

TEST(MotionObstacle, AnInstrumentIsInTheWayUntilItIsOutCompletely)
{
  SessionState state = running();
  state.wire.insertion[1] = -0.01;
  EXPECT_EQ(motionObstacle(state, 0, 0.02), "waits outside: wire is in the way; pull it out first");
  EXPECT_EQ(motionObstacle(state, 1, -0.02), "");
}

TEST(MotionObstacle, NamesTheEndOfTheInstrumentForAPushOnly)
{
  SessionState state = running();
  state.wire.insertion[1] = 0.6495;
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "end of its length: 650 mm are in");
  EXPECT_EQ(motionObstacle(state, 1, 0.0), "");
  EXPECT_EQ(motionObstacle(state, 1, -0.02), "");
}

TEST(MotionObstacle, NamesTheLimitAtWhichTheGripSlips)
{
  SessionState state = running();
  state.wire.hand_force[1] = 4.95;
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "slips at 5 N: it is held; pull back");
  state.wire.hand_force[1] = -5.0;
  EXPECT_EQ(motionObstacle(state, 1, -0.02), "slips at 5 N: it is held; push or twist");
  state.wire.hand_force[1] = 4.0;
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "");
  state.wire.hand_torque[1] = 0.05;
  EXPECT_EQ(motionObstacle(state, 1, 0.0), "slips at 50 mN·m: its rotation is held; turn back");
}

TEST(MotionObstacle, AdvisesAgainstTheDirectionOfTheMotion)
{
  SessionState state = running();
  state.operating["wire"].reason =
      "the grip slips in the insertion: the instrument is held with drive.force_limit, jammed or at a stop; pull back";
  EXPECT_EQ(motionObstacle(state, 1, -0.02), "slips: it is held; push or twist");
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "slips: it is held; pull back");
  state.operating["wire"].reason = "the grip slips in the rotation: the instrument is held with drive.torque_limit";
  EXPECT_EQ(motionObstacle(state, 1, 0.0), "slips: its rotation is held; turn back");
}

TEST(MotionObstacle, NamesAPauseAndTheReasonOfTheState)
{
  SessionState state = running();
  state.operating["wire"].state = drive::OperatingState::kPaused;
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "the simulation is paused; press Start");
  state.operating["wire"].reason = "the contact node does not respond";
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "paused: the contact node does not respond");
  state.operating["wire"].state = drive::OperatingState::kEnabled;
  state.operating["wire"].reason = "waits at a stop";
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "waits at a stop");
  state.scene.instruments[1].takes_commands = false;
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "driven by the scene");
}

TEST(MotionObstacle, IsEmptyWithoutAState)
{
  EXPECT_EQ(motionObstacle({}, 0, 0.02), "");
  SessionState state = running();
  EXPECT_EQ(motionObstacle(state, 99, 0.02), "");
  state.wire.insertion.clear();
  state.wire.hand_force.clear();
  state.wire.hand_torque.clear();
  EXPECT_EQ(motionObstacle(state, 1, 0.02), "");
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
