#include "robot/robot_control.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "robot/urdf/urdf_reader.h"

namespace endovascular_sim::robot
{
namespace
{

using drive::CommandKind;
using drive::CommandVerdict;

constexpr double kPlay = 2e-3;   // of the wire's insertion [m]
constexpr double kRatio = 0.02;  // of the roller [m/rad]
constexpr double kTimeOut = 0.2;

const RobotModel kModel = parseUrdf(
    "<robot name=\"r\"><link name=\"base\"/><link name=\"a\"/><link name=\"b\"/><link name=\"c\"/><link name=\"d\"/>"
    "<link name=\"e\"/>"
    "<joint name=\"carriage\" type=\"prismatic\"><parent link=\"base\"/><child link=\"a\"/>"
    "<limit lower=\"0\" upper=\"0.3\" velocity=\"0.1\" effort=\"5\"/></joint>"
    "<joint name=\"chuck\" type=\"continuous\"><parent link=\"base\"/><child link=\"b\"/></joint>"
    "<joint name=\"roller\" type=\"continuous\"><parent link=\"base\"/><child link=\"c\"/>"
    "<limit velocity=\"20\" effort=\"0.1\"/></joint>"
    "<joint name=\"follower\" type=\"continuous\"><parent link=\"base\"/><child link=\"d\"/>"
    "<mimic joint=\"roller\" multiplier=\"-1\"/></joint>"
    "<joint name=\"arm\" type=\"revolute\"><parent link=\"base\"/><child link=\"e\"/>"
    "<limit lower=\"0.2\" upper=\"1\" velocity=\"1\" effort=\"1\"/></joint></robot>",
    "r.urdf");

const std::vector<JointLink> kLinks = {{"carriage", "catheter", Motion::kInsertion, 1.0, -0.1, 0.0},
                                       {"chuck", "catheter", Motion::kRotation, -1.0, 0.0, 0.0},
                                       {"roller", "wire", Motion::kInsertion, kRatio, 0.0, kPlay}};

/** Control of two enabled instruments: the catheter outside of the introducer, the wire in it. */
RobotControl makeControl(drive::BeyondLimit beyond = drive::BeyondLimit::kRefuse)
{
  RobotControl control(kModel, kLinks,
                       {{"catheter", beyond, kTimeOut, {-0.1, 0.0, 0.0}}, {"wire", beyond, kTimeOut, {0.1, 0.4, 0.0}}});
  drive::ControlState enabled;
  enabled.state = drive::OperatingState::kEnabled;
  control.setState(0, enabled);
  control.setState(1, enabled);
  return control;
}

RobotAnswer send(RobotControl& control, CommandKind kind, const std::vector<double>& values, double time = 0.0)
{
  return control.command("client", kind, {}, values, time);
}

TEST(RobotControl, UnnamedPositionsGoToTheInstrumentsThroughTheirRatios)
{
  RobotControl control = makeControl();
  const RobotAnswer answer = send(control, CommandKind::kServoPosition, {0.12, 0.5, 5.1});
  ASSERT_EQ(answer.commands.size(), 2U);
  EXPECT_EQ(answer.commands[0].instrument, 0U);
  EXPECT_NEAR(answer.commands[0].joints.insertion, 0.02, 1e-15);
  EXPECT_EQ(answer.commands[0].joints.rotation, -0.5);
  EXPECT_FALSE(answer.commands[0].joints.pressure);
  EXPECT_NEAR(answer.commands[1].joints.insertion, 0.102 - 0.5 * kPlay, 1e-15) << "half of the play behind";
  EXPECT_FALSE(answer.commands[1].joints.rotation) << "no joint rotates the wire";
}

TEST(RobotControl, MissingLastJointsHold)
{
  RobotControl control = makeControl();
  const RobotAnswer answer = send(control, CommandKind::kServoPosition, {0.12});
  ASSERT_EQ(answer.commands.size(), 1U) << "the wire is not concerned";
  EXPECT_FALSE(answer.commands[0].joints.rotation);
}

TEST(RobotControl, NamedJointsMayHaveAnyOrderAndOthersOfTheRobotAreIgnored)
{
  RobotControl control = makeControl();
  const RobotAnswer answer = control.command("client", CommandKind::kServoPosition,
                                             {"arm", "chuck", "follower", "carriage"}, {0.5, 0.3, 9.0, 0.02}, 0.0);
  ASSERT_EQ(answer.commands.size(), 1U);
  EXPECT_NEAR(answer.commands[0].joints.insertion, -0.08, 1e-15);
  EXPECT_EQ(answer.commands[0].joints.rotation, -0.3);
}

TEST(RobotControl, AnInstrumentHoldsItsInsertionWhileItsRotationMoves)
{
  RobotControl control = makeControl();
  control.follow(0, {-0.05, 0.0, 0.0}, 0.3);
  const auto turn = [&](CommandKind kind)
  { return control.command("client", kind, {"chuck"}, {0.1}, 0.3).commands.at(0).joints.insertion; };
  EXPECT_EQ(turn(CommandKind::kServoPosition), -0.05);
  EXPECT_EQ(turn(CommandKind::kMovePosition), -0.05);
  EXPECT_EQ(turn(CommandKind::kServoRelative), 0.0);
  EXPECT_EQ(turn(CommandKind::kServoVelocity), 0.0);
  const RobotAnswer force = control.command("client", CommandKind::kServoForce, {"chuck"}, {0.01}, 0.3);
  EXPECT_EQ(force.verdict, CommandVerdict::kMalformed) << "a force of zero would not hold the insertion";
  EXPECT_NE(force.reason.find("needs the force of its insertion"), std::string::npos);
}

TEST(RobotControl, MalformedCommandsAreRejectedWithTheReason)
{
  RobotControl control = makeControl();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto reasonOf = [&](const std::vector<std::string>& names, const std::vector<double>& values)
  {
    const RobotAnswer answer = control.command("client", CommandKind::kServoPosition, names, values, 0.0);
    EXPECT_TRUE(answer.commands.empty());
    return answer.reason;
  };
  EXPECT_NE(reasonOf({}, {}).find("0 values"), std::string::npos);
  EXPECT_NE(reasonOf({}, {0.0, 0.0, 5.0, 0.0}).find("4 values without names for 3 joints"), std::string::npos);
  EXPECT_NE(reasonOf({"carriage", "chuck"}, {0.1}).find("2 names, but 1 values"), std::string::npos);
  EXPECT_NE(reasonOf({"cariage"}, {0.1}).find("has no joint 'cariage'; it has carriage, chuck"), std::string::npos);
  EXPECT_NE(reasonOf({"chuck", "chuck"}, {0.1, 0.2}).find("'chuck' is repeated"), std::string::npos);
  EXPECT_NE(reasonOf({"arm"}, {0.3}).find("no value of a joint that moves an instrument"), std::string::npos);
  EXPECT_NE(reasonOf({}, {nan}).find("joint 'carriage': not finite"), std::string::npos);
  EXPECT_NE(reasonOf({}, {0.1, -HUGE_VAL}).find("joint 'chuck': not finite"), std::string::npos);
  EXPECT_EQ(control.arbiter().rejected().malformed, 6U);
  EXPECT_EQ(control.arbiter().rejected().not_finite, 2U);
  EXPECT_EQ(control.arbiter().accepted(), 0U);
  EXPECT_EQ(control.arbiter().driver(), "");
}

TEST(RobotControl, LimitsOfTheUrdfRefuseOrClamp)
{
  RobotControl refusing = makeControl();
  const RobotAnswer answer = send(refusing, CommandKind::kServoPosition, {0.31});
  EXPECT_EQ(answer.verdict, CommandVerdict::kOutOfRange);
  EXPECT_EQ(answer.reason, "servo_jp of client: joint 'carriage': 0.31 is beyond the limits 0 to 0.3 of the URDF");
  EXPECT_EQ(send(refusing, CommandKind::kServoVelocity, {-0.11}).verdict, CommandVerdict::kOutOfRange);
  EXPECT_EQ(send(refusing, CommandKind::kServoForce, {5.1}).verdict, CommandVerdict::kOutOfRange);
  EXPECT_EQ(send(refusing, CommandKind::kServoPosition, {0.1, 1e6}).verdict, CommandVerdict::kAccepted)
      << "a continuous joint without a limit";
  EXPECT_EQ(refusing.arbiter().rejected().out_of_range, 3U);

  RobotControl clamping = makeControl(drive::BeyondLimit::kClamp);
  EXPECT_NEAR(send(clamping, CommandKind::kServoPosition, {0.5}).commands.at(0).joints.insertion, 0.2, 1e-15);
  EXPECT_EQ(send(clamping, CommandKind::kServoVelocity, {-0.5}).commands.at(0).joints.insertion, -0.1);
  EXPECT_EQ(send(clamping, CommandKind::kServoForce, {50.0}).commands.at(0).joints.insertion, 5.0);
  EXPECT_EQ(clamping.arbiter().rejected().clamped, 3U);
}

TEST(RobotControl, RelativeCommandsEndAtTheLimits)
{
  RobotControl control = makeControl();
  for (int k = 0; k < 30; ++k)
    ASSERT_EQ(send(control, CommandKind::kServoRelative, {0.01}).verdict, CommandVerdict::kAccepted) << k;
  EXPECT_EQ(send(control, CommandKind::kServoRelative, {0.01}).verdict, CommandVerdict::kOutOfRange);
  EXPECT_EQ(send(control, CommandKind::kMoveRelative, {-0.01}, 0.1).verdict, CommandVerdict::kOutOfRange)
      << "relative to the setpoint, which is still at the start";
}

TEST(RobotControl, VelocitiesAndEffortsPassTheRatioAndItsTranspose)
{
  RobotControl control = makeControl();
  const double velocity = send(control, CommandKind::kServoVelocity, {0.05, 2.0}).commands.at(0).joints.insertion;
  EXPECT_EQ(velocity, 0.05);
  const RobotAnswer torque = control.command("client", CommandKind::kServoForce, {"roller"}, {0.05}, 0.0);
  EXPECT_EQ(torque.commands.at(0).joints.insertion, 0.05 / kRatio);
}

TEST(RobotControl, AStreamOfPositionsCrossesThePlay)
{
  RobotControl control = makeControl();
  const auto move = [&](double motion)
  {
    return control.command("client", CommandKind::kServoPosition, {"roller"}, {motion / kRatio}, 0.0)
        .commands.at(0)
        .joints.insertion;
  };
  EXPECT_NEAR(move(0.11), 0.11 - 0.5 * kPlay, 1e-15);
  EXPECT_NEAR(move(0.11 - 0.9 * kPlay), 0.11 - 0.5 * kPlay, 1e-15) << "in the play";
  EXPECT_NEAR(move(0.11 - 1.5 * kPlay), 0.11 - kPlay, 1e-15);
}

TEST(RobotControl, RelativePositionsCrossThePlayToo)
{
  RobotControl control = makeControl();
  const auto move = [&](double motion)
  {
    return control.command("client", CommandKind::kServoRelative, {"roller"}, {motion / kRatio}, 0.0)
        .commands.at(0)
        .joints.insertion;
  };
  EXPECT_NEAR(move(0.75 * kPlay), 0.25 * kPlay, 1e-15) << "from the middle of the play";
  EXPECT_NEAR(move(-0.5 * kPlay), 0.0, 1e-15);
  EXPECT_NEAR(move(-kPlay), -0.5 * kPlay, 1e-15);
}

TEST(RobotControl, AVelocityMovesTheJointThroughItsPlayBeforeTheInstrument)
{
  RobotControl control = makeControl();
  control.follow(1, {0.1, 0.4, 0.0}, 0.0);
  const double speed = 0.01;  // m/s of the wire
  const RobotAnswer first = control.command("client", CommandKind::kServoVelocity, {"roller"}, {speed / kRatio}, 0.0);
  EXPECT_EQ(first.commands.at(0).joints.insertion, 0.0) << "half of the play lies before it";
  double insertion = 0.1;
  double given = 0.0;
  double last = control.position(2, insertion);
  for (int k = 1; k <= 190; ++k)
  {
    insertion += 1e-3 * given;
    const auto command = control.follow(1, {insertion, 0.4, 0.0}, 1e-3 * k);
    if (command)
    {
      EXPECT_NEAR(1e-3 * k, 0.5 * kPlay / speed, 1.1e-3) << "once, when the play is used up";
      given = command->joints.insertion;
    }
    const double position = control.position(2, insertion);
    ASSERT_NEAR(position - last, 1e-3 * speed / kRatio, 1e-9) << "the joint moves evenly";
    last = position;
  }
  EXPECT_EQ(given, speed);
  EXPECT_NEAR(kLinks[2].toMotion(last) - insertion, 0.5 * kPlay, 1e-12);
  const RobotAnswer again = control.command("client", CommandKind::kServoVelocity, {"roller"}, {speed / kRatio}, 0.19);
  EXPECT_EQ(again.commands.at(0).joints.insertion, speed) << "engaged";
  const RobotAnswer back = control.command("client", CommandKind::kServoVelocity, {"roller"}, {-speed / kRatio}, 0.19);
  EXPECT_EQ(back.commands.at(0).joints.insertion, 0.0) << "the whole play lies behind it";
}

TEST(RobotControl, AForceTakesThePlayUpAtOnce)
{
  RobotControl control = makeControl();
  control.command("client", CommandKind::kServoForce, {"roller"}, {0.05}, 0.0);
  control.follow(1, {0.1005, 0.4, 0.0}, 1e-3);
  EXPECT_NEAR(control.position(2, 0.1005), (0.1005 + 0.5 * kPlay) / kRatio, 1e-12);
}

TEST(RobotControl, TheJointFollowsAnInstrumentThatAnotherClientMoves)
{
  RobotControl control = makeControl();
  control.follow(0, {0.15, 0.0, 0.0}, 1.0);
  control.follow(1, {0.2, 0.4, 0.0}, 1.0);
  EXPECT_NEAR(control.position(0, 0.15), 0.25, 1e-15);
  EXPECT_NEAR(control.position(2, 0.2), (0.2 - 0.5 * kPlay) / kRatio, 1e-12) << "drawn along at the end of the play";
  EXPECT_EQ(send(control, CommandKind::kServoRelative, {0.06}, 1.0).verdict, CommandVerdict::kOutOfRange);
  EXPECT_NEAR(send(control, CommandKind::kMoveRelative, {0.04}, 1.0).commands.at(0).joints.insertion, 0.04, 1e-15);
}

TEST(RobotControl, AMoveThatOutlastsTheTimeOutEndsAtItsGoal)
{
  RobotControl control = makeControl();
  const RobotAnswer answer = control.command("client", CommandKind::kMovePosition, {"roller"}, {0.2 / kRatio}, 0.0);
  const double goal = answer.commands.at(0).joints.insertion;
  for (int k = 1; k <= 1000; ++k)
    control.follow(1, {0.1 + 1e-3 * k * (goal - 0.1), 0.4, 0.0}, 1e-3 * k);
  EXPECT_NEAR(control.position(2, goal), 0.2 / kRatio, 1e-12);
}

TEST(RobotControl, ASlippedInstrumentLeavesTheJointAtTheNearestPositionOfItsPlay)
{
  RobotControl control = makeControl();
  control.command("client", CommandKind::kServoPosition, {"roller"}, {0.12 / kRatio}, 0.0);
  EXPECT_NEAR(control.position(2, 0.12 - 0.5 * kPlay), 0.12 / kRatio, 1e-12) << "not slipped";
  EXPECT_NEAR(control.position(2, 0.11), (0.11 + 0.5 * kPlay) / kRatio, 1e-12);
}

TEST(RobotControl, OneClientDrivesUntilTheTimeOut)
{
  RobotControl control = makeControl();
  EXPECT_EQ(control.command("a", CommandKind::kServoPosition, {}, {0.01}, 1.0).verdict, CommandVerdict::kAccepted);
  const RobotAnswer other = control.command("b", CommandKind::kServoPosition, {}, {0.01}, 1.1);
  EXPECT_EQ(other.verdict, CommandVerdict::kForeign);
  EXPECT_EQ(other.reason, "servo_jp of b: a drives the robot");
  EXPECT_NE(control.stateCommand("b", "home", 1.1), "");
  EXPECT_EQ(control.stateCommand("b", "pause", 1.1), "");
  EXPECT_EQ(control.command("b", CommandKind::kServoPosition, {}, {0.01}, 1.25).verdict, CommandVerdict::kAccepted);
  EXPECT_EQ(control.stateCommand("a", "disable", 1.2), "");
  EXPECT_EQ(control.arbiter().driver(), "");
  EXPECT_EQ(control.command("a", CommandKind::kServoPosition, {}, {0.01}, 0.1).verdict, CommandVerdict::kAccepted);
  EXPECT_EQ(control.command("b", CommandKind::kServoPosition, {}, {0.01}, 0.0).verdict, CommandVerdict::kAccepted)
      << "after a reset of the time";
  EXPECT_NE(control.stateCommand("a", "dance", 0.0).find("unknown word"), std::string::npos);
}

TEST(RobotControl, TheClientOfAMoveDrivesUntilItsEnd)
{
  RobotControl control = makeControl();
  control.command("a", CommandKind::kMovePosition, {}, {0.2}, 0.0);
  drive::ControlState busy;
  busy.state = drive::OperatingState::kEnabled;
  busy.is_busy = true;
  control.setState(0, busy);
  EXPECT_TRUE(control.state().is_busy);
  EXPECT_EQ(control.command("b", CommandKind::kServoPosition, {}, {0.01}, 9.0).verdict, CommandVerdict::kForeign);
}

TEST(RobotControl, HasTheWorstStateOfItsInstruments)
{
  RobotControl control = makeControl();
  EXPECT_EQ(control.state().state, drive::OperatingState::kEnabled);
  drive::ControlState paused;
  paused.state = drive::OperatingState::kPaused;
  paused.reason = "no contact";
  control.setState(0, paused);
  EXPECT_EQ(control.state().state, drive::OperatingState::kPaused);
  EXPECT_EQ(control.state().reason, "catheter: no contact");
  drive::ControlState disabled;
  disabled.state = drive::OperatingState::kDisabled;
  disabled.is_homed = false;
  control.setState(1, disabled);
  EXPECT_EQ(control.state().state, drive::OperatingState::kDisabled);
  EXPECT_FALSE(control.state().is_homed);
  const RobotAnswer answer = send(control, CommandKind::kServoPosition, {0.1});
  EXPECT_EQ(answer.verdict, CommandVerdict::kNotEnabled);
  EXPECT_NE(answer.reason.find("'catheter' is PAUSED"), std::string::npos);
}

TEST(RobotControl, PassesTheWarningOfAnEnabledInstrumentOn)
{
  RobotControl control = makeControl();
  drive::ControlState slipping;
  slipping.state = drive::OperatingState::kEnabled;
  slipping.reason = "the grip slips";
  control.setState(1, slipping);
  EXPECT_EQ(control.state().state, drive::OperatingState::kEnabled);
  EXPECT_EQ(control.state().reason, "wire: the grip slips");
}

TEST(RobotControl, FollowsTheInstrumentsAfterHold)
{
  RobotControl control = makeControl();
  EXPECT_EQ(send(control, CommandKind::kServoVelocity, {0.1}).verdict, CommandVerdict::kAccepted);
  EXPECT_NE(control.stateCommand("other", "hold", 0.0), "") << "another client drives";
  EXPECT_EQ(control.stateCommand("client", "hold", 0.0), "");
  EXPECT_FALSE(control.follow(0, {0.02, 0.0, 0.0}, 0.01)) << "no velocity is given again";
  const RobotAnswer answer = send(control, CommandKind::kServoRelative, {0.001}, 0.02);
  EXPECT_EQ(answer.verdict, CommandVerdict::kAccepted);
}

TEST(RobotControl, IsDisabledBeforeTheFirstStates)
{
  const RobotControl control(kModel, kLinks, {{"catheter"}, {"wire"}});
  EXPECT_EQ(control.state().state, drive::OperatingState::kDisabled);
  EXPECT_EQ(control.state().reason, "catheter: no state of 'catheter' yet");
}

TEST(RobotControl, AllJointsContainMimicsAndJointsAtRest)
{
  const RobotControl control = makeControl();
  EXPECT_EQ(control.allNames(), (std::vector<std::string>{"carriage", "chuck", "roller", "follower", "arm"}));
  EXPECT_EQ(control.allJoints({0.1, 0.2, 5.0}, true), (std::vector<double>{0.1, 0.2, 5.0, -5.0, 0.2}));
  EXPECT_EQ(control.allJoints({0.1, 0.2, 5.0}, false), (std::vector<double>{0.1, 0.2, 5.0, -5.0, 0.0}));
}

TEST(RobotControl, APressureChangesByPositionsOnly)
{
  const std::vector<JointLink> links = {{"carriage", "balloon", Motion::kInsertion, 1.0, 0.0, 0.0},
                                        {"roller", "balloon", Motion::kPressure, 1e4, 0.0, 0.0}};
  RobotControl control(kModel, links, {{"balloon", drive::BeyondLimit::kRefuse, kTimeOut, {0.0, 0.3, 0.0}}});
  drive::ControlState enabled;
  enabled.state = drive::OperatingState::kEnabled;
  control.setState(0, enabled);
  const RobotAnswer answer = send(control, CommandKind::kServoPosition, {0.01, 20.0});
  EXPECT_EQ(answer.commands.at(0).joints.pressure, 2e5);
  EXPECT_EQ(answer.commands.at(0).joints.rotation, 0.3) << "held; an instrument takes a pressure after a rotation only";
  EXPECT_EQ(send(control, CommandKind::kServoVelocity, {0.01, 1.0}).verdict, CommandVerdict::kMalformed);
  EXPECT_EQ(send(control, CommandKind::kServoVelocity, {0.01, 0.0}).verdict, CommandVerdict::kAccepted);
}

}  // namespace
}  // namespace endovascular_sim::robot
