#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "common/archive.h"
#include "drive/hand_control.h"

namespace endovascular_sim::drive
{
namespace
{

constexpr double kStep = 1e-3;  // s
const HandMotion kStart = {0.05, 0.2};
const DriveLimits kLimits = DriveLimits().completed(0.6, 1.0, 0.01);

void run(HandControl& control, int steps)
{
  for (int k = 0; k < steps; ++k)
  {
    const HandMotion now = control.setpoint().motion;
    control.next(kStep, {{now.insertion, 0.1}, {now.rotation, 0.0}});
  }
}

std::string saved(HandControl& control)
{
  Archive archive;
  control.archive(archive);
  return archive.bytes();
}

/** Saves and loads a control after some steps, and compares the further motion. */
void expectSameMotion(const std::function<void(HandControl&)>& command, int steps)
{
  HandControl control(kStart, kLimits);
  command(control);
  run(control, steps);
  Archive archive(saved(control));
  HandControl loaded(kStart, kLimits);
  loaded.archive(archive);
  EXPECT_TRUE(archive.atEnd());
  EXPECT_EQ(loaded.state().state, control.state().state);
  EXPECT_EQ(loaded.state().is_busy, control.state().is_busy);
  for (int k = 0; k < 1000; ++k)
  {
    run(control, 1);
    run(loaded, 1);
    ASSERT_EQ(loaded.setpoint().motion.insertion, control.setpoint().motion.insertion) << k;
    ASSERT_EQ(loaded.setpoint().motion.rotation, control.setpoint().motion.rotation) << k;
    ASSERT_EQ(loaded.setpoint().pressure, control.setpoint().pressure) << k;
    ASSERT_EQ(loaded.state().is_busy, control.state().is_busy) << k;
  }
}

TEST(ASavedHandControl, ContinuesEveryModeBitForBit)
{
  for (const CommandKind kind : {CommandKind::kServoPosition, CommandKind::kServoRelative, CommandKind::kServoVelocity,
                                 CommandKind::kServoForce, CommandKind::kMovePosition, CommandKind::kMoveRelative})
    for (const int steps : {0, 40, 210})
      expectSameMotion(
          [kind](HandControl& control) {
            EXPECT_EQ(control.command("/a", JointCommand{kind, 0.06, 0.001, std::nullopt}), CommandVerdict::kAccepted);
          },
          steps);
}

TEST(ASavedHandControl, ContinuesWithCommandsThatHaveArrivedTogether)
{
  const auto send = [](HandControl& control)
  {
    for (int k = 0; k < 10; ++k)
      EXPECT_EQ(control.command("/a", JointCommand{CommandKind::kServoRelative, 2e-4, 0.01, std::nullopt}),
                CommandVerdict::kAccepted);
    run(control, 50);  // the approach to the first command of the stream
    for (int k = 0; k < 10; ++k)
      EXPECT_EQ(control.command("/a", JointCommand{CommandKind::kServoRelative, 2e-4, 0.01, std::nullopt}),
                CommandVerdict::kAccepted);
  };
  for (const int steps : {0, 3})
    expectSameMotion(send, steps);
}

TEST(ASavedHandControl, StaysFree)
{
  expectSameMotion([](HandControl& control) { EXPECT_TRUE(control.stateCommand("/a", "free")); }, 300);
}

TEST(ASavedHandControl, KeepsItsOperatingState)
{
  expectSameMotion(
      [](HandControl& control)
      {
        EXPECT_TRUE(control.stateCommand("/a", "unhome"));
        EXPECT_EQ(control.command("/a", JointCommand{CommandKind::kMoveRelative, 0.01, 0.0, 2e5}),
                  CommandVerdict::kAccepted);
      },
      50);
  HandControl control(kStart, kLimits);
  EXPECT_TRUE(control.stateCommand("/a", "disable"));
  Archive archive(saved(control));
  HandControl loaded(kStart, kLimits);
  loaded.archive(archive);
  EXPECT_EQ(loaded.command("/a", JointCommand{CommandKind::kServoPosition, 0.05, 0.2, std::nullopt}),
            CommandVerdict::kNotEnabled);
}

TEST(ASavedHandControl, IsFreeForAnyClient)
{
  HandControl control(kStart, kLimits);
  EXPECT_EQ(control.command("/a", JointCommand{CommandKind::kServoPosition, 0.05, 0.2, std::nullopt}),
            CommandVerdict::kAccepted);
  Archive archive(saved(control));
  control.archive(archive);
  EXPECT_EQ(control.arbiter().driver(), "");
  EXPECT_EQ(control.command("/b", JointCommand{CommandKind::kServoPosition, 0.05, 0.2, std::nullopt}),
            CommandVerdict::kAccepted);
}

TEST(ASavedHandControl, IsRefusedWhereItsDataAreDamaged)
{
  HandControl control(kStart, kLimits);
  const std::string bytes = saved(control);
  for (std::size_t size = 0; size < bytes.size(); size += 5)
  {
    Archive archive(bytes.substr(0, size));
    HandControl loaded(kStart, kLimits);
    EXPECT_THROW(loaded.archive(archive), ArchiveError);
  }
  Archive archive(std::string(bytes.size(), '\xff'));
  HandControl loaded(kStart, kLimits);
  EXPECT_THROW(loaded.archive(archive), ArchiveError);
}

TEST(AHandControl, RestsAtAPositionWithoutADriver)
{
  HandControl control(kStart, kLimits);
  EXPECT_EQ(control.command("/a", JointCommand{CommandKind::kMovePosition, 0.3, 1.0, std::nullopt}),
            CommandVerdict::kAccepted);
  run(control, 100);
  control.restAt({0.1, 0.5}, std::nullopt);
  run(control, 300);
  EXPECT_EQ(control.setpoint().motion.insertion, 0.1);
  EXPECT_EQ(control.setpoint().motion.rotation, 0.5);
  EXPECT_FALSE(control.state().is_busy);
  EXPECT_EQ(control.arbiter().driver(), "");
}

}  // namespace
}  // namespace endovascular_sim::drive
