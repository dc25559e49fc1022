#include "robot/command_faults.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/archive.h"

namespace endovascular_sim::robot
{
namespace
{

constexpr double kStep = 1e-3;   // s
constexpr double kSpeed = 0.01;  // m per step

using Commands = std::vector<drive::HandCommand>;

FaultSettings fault(FaultKind kind, double amount, double start = 0.0,
                    double end = std::numeric_limits<double>::infinity())
{
  FaultSettings settings;
  settings.kind = kind;
  settings.amount = amount;
  settings.start = start;
  settings.end = end;
  return settings;
}

/** Insertion commanded for the end of a step. */
Commands pushed(std::uint64_t step)
{
  return {{kSpeed * static_cast<double>(step + 1), 0.0, 0.0}};
}

CommandFaults with(const std::vector<FaultSettings>& faults, std::uint64_t seed = 0)
{
  return {faults, Commands(1), kStep, seed};
}

/** Positions of a pushed handle after each step. */
std::vector<double> run(CommandFaults& faults, std::uint64_t steps, std::uint64_t first = 0)
{
  std::vector<double> positions;
  for (std::uint64_t step = first; step < first + steps; ++step)
    positions.push_back(faults.execute(step, pushed(step))[0].insertion);
  return positions;
}

TEST(CommandFaults, WithoutAFaultTheCommandsThemselvesPass)
{
  CommandFaults faults = with({});
  const Commands commands = pushed(3);
  EXPECT_EQ(&faults.execute(3, commands), &commands);
  EXPECT_TRUE(faults.empty());
}

TEST(CommandFaults, AStuckHandleStaysAndFollowsAfterwards)
{
  CommandFaults faults = with({fault(FaultKind::kStuck, 0.0, 0.010, 0.020)});
  const std::vector<double> positions = run(faults, 30);
  for (std::uint64_t step = 0; step < 30; ++step)
    EXPECT_EQ(positions[step], step >= 10 && step < 20 ? pushed(9)[0].insertion : pushed(step)[0].insertion) << step;
  EXPECT_EQ(faults.lag(0).insertion, 0.0);
}

TEST(CommandFaults, ASlippingHandleLosesAShareOfTheMotionForGood)
{
  CommandFaults faults = with({fault(FaultKind::kSlipping, 0.25, 0.010, 0.020)});
  const std::vector<double> positions = run(faults, 30);
  EXPECT_EQ(positions[9], pushed(9)[0].insertion);
  EXPECT_NEAR(positions[19], pushed(19)[0].insertion - 0.25 * 10 * kSpeed, 1e-12);
  EXPECT_NEAR(positions[29], pushed(29)[0].insertion - 0.25 * 10 * kSpeed, 1e-12);
  EXPECT_NEAR(faults.lag(0).insertion, 0.25 * 10 * kSpeed, 1e-12);
}

TEST(CommandFaults, ADelayedHandleFollowsTheCommandsAfterTheDelay)
{
  CommandFaults faults = with({fault(FaultKind::kDelayed, 5e-3, 0.010, 0.030)});
  const std::vector<double> positions = run(faults, 40);
  for (std::uint64_t step = 0; step < 40; ++step)
  {
    const std::uint64_t executed = step < 10 || step >= 30 ? step : step < 15 ? 9 : step - 5;
    EXPECT_EQ(positions[step], pushed(executed)[0].insertion) << step;
  }
}

TEST(CommandFaults, BacklashFollowsAfterHalfThePlay)
{
  CommandFaults faults = with({fault(FaultKind::kBacklash, 4.0 * kSpeed)});
  const std::vector<double> forth = run(faults, 20);
  EXPECT_NEAR(forth.back(), pushed(19)[0].insertion - 2.0 * kSpeed, 1e-12);
  std::vector<double> back;
  for (std::uint64_t step = 20; step < 30; ++step)
    back.push_back(faults.execute(step, pushed(38 - step))[0].insertion);
  EXPECT_EQ(back[0], forth.back());
  EXPECT_EQ(back[2], forth.back());
  EXPECT_NEAR(back.back(), pushed(9)[0].insertion + 2.0 * kSpeed, 1e-12);
}

TEST(CommandFaults, OtherAxesPassUnchanged)
{
  FaultSettings turning = fault(FaultKind::kStuck, 0.0);
  turning.axis = FaultAxis::kRotation;
  turning.instrument = 1;
  CommandFaults faults({turning}, Commands(2), kStep, 0);
  const Commands& executed = faults.execute(0, {{0.1, 1.0, 2.0}, {0.3, 3.0, 4.0}});
  EXPECT_EQ(executed[0].insertion, 0.1);
  EXPECT_EQ(executed[0].rotation, 1.0);
  EXPECT_EQ(executed[0].pressure, 2.0);
  EXPECT_EQ(executed[1].insertion, 0.3);
  EXPECT_EQ(executed[1].rotation, 0.0);
  EXPECT_EQ(executed[1].pressure, 4.0);
}

TEST(CommandFaults, IntervalsAreFaultyWithTheProbabilityAndTheSeed)
{
  FaultSettings settings = fault(FaultKind::kStuck, 0.0, 0.5);
  settings.probability = 0.3;
  settings.interval = 0.01;
  const CommandFault first(settings, kStep, 1, 0.0);
  const CommandFault same(settings, kStep, 1, 0.0);
  const CommandFault other(settings, kStep, 2, 0.0);
  int active = 0;
  int different = 0;
  constexpr std::uint64_t kSteps = 1000000;
  for (std::uint64_t step = 0; step < kSteps; ++step)
  {
    ASSERT_EQ(first.isActive(step), same.isActive(step));
    if (step < 500)
    {
      ASSERT_FALSE(first.isActive(step));
    }
    else if ((step - 500) % 10 != 0)
    {
      ASSERT_EQ(first.isActive(step), first.isActive(step - 1)) << step;
    }
    active += first.isActive(step) ? 1 : 0;
    different += first.isActive(step) != other.isActive(step) ? 1 : 0;
  }
  EXPECT_NEAR(active / static_cast<double>(kSteps), 0.3, 5.0 * std::sqrt(0.3 * 0.7 / (kSteps / 10.0)));
  EXPECT_NEAR(different / static_cast<double>(kSteps), 0.42, 0.01);
}

TEST(CommandFaults, AFaultThatIsAddedBeginsWhereTheHandleIs)
{
  CommandFaults faults = with({});
  const std::vector<double> before = run(faults, 10);
  faults.add(fault(FaultKind::kStuck, 0.0));
  EXPECT_EQ(run(faults, 5, 10), std::vector<double>(5, before.back()));
  EXPECT_EQ(faults.remove(0, FaultAxis::kRotation), 0U);
  EXPECT_EQ(faults.remove(0, FaultAxis::kInsertion), 1U);
  EXPECT_EQ(run(faults, 1, 15).front(), pushed(15)[0].insertion);
}

TEST(CommandFaults, MotionThatHasSlippedStaysLostWhenTheFaultIsRemoved)
{
  CommandFaults faults = with({fault(FaultKind::kSlipping, 0.5)});
  const std::vector<double> before = run(faults, 10);
  faults.remove(0, FaultAxis::kInsertion);
  EXPECT_FALSE(faults.empty());
  EXPECT_NEAR(run(faults, 1, 10).front(), before.back() + kSpeed, 1e-12);
}

TEST(CommandFaults, SavedFaultsContinueBitForBit)
{
  FaultSettings slipping = fault(FaultKind::kSlipping, 0.3);
  slipping.probability = 0.5;
  slipping.interval = 4e-3;
  const std::vector<FaultSettings> settings = {slipping, fault(FaultKind::kDelayed, 7e-3),
                                               fault(FaultKind::kBacklash, 0.02)};
  CommandFaults faults = with(settings, 5);
  run(faults, 33);
  faults.add(fault(FaultKind::kStuck, 0.0, 0.05, 0.06));
  run(faults, 3, 33);
  Archive saved;
  saved(faults);
  CommandFaults loaded = with({});
  Archive reading(saved.bytes());
  reading(loaded);
  EXPECT_TRUE(reading.atEnd());
  EXPECT_EQ(run(faults, 100, 36), run(loaded, 100, 36));
}

TEST(CommandFaults, ImpossibleValuesAreRefusedWithTheirName)
{
  const auto refusal = [](FaultKind kind, double amount, double start, double end, double probability, double interval)
  {
    FaultSettings settings = fault(kind, amount, start, end);
    settings.probability = probability;
    settings.interval = interval;
    return refusalOf(settings);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(FaultKind::kStuck, 0.0, 0.0, 1.0, 1.0, 0.1), "");
  EXPECT_EQ(refusal(FaultKind::kSlipping, 1.1, 0.0, 1.0, 1.0, 0.1).rfind("amount", 0), 0U);
  EXPECT_EQ(refusal(FaultKind::kDelayed, 11.0, 0.0, 1.0, 1.0, 0.1).rfind("amount", 0), 0U);
  EXPECT_EQ(refusal(FaultKind::kBacklash, nan, 0.0, 1.0, 1.0, 0.1).rfind("amount", 0), 0U);
  EXPECT_EQ(refusal(FaultKind::kBacklash, -1.0, 0.0, 1.0, 1.0, 0.1).rfind("amount", 0), 0U);
  EXPECT_EQ(refusal(FaultKind::kStuck, 0.0, -1.0, 1.0, 1.0, 0.1).rfind("start", 0), 0U);
  EXPECT_EQ(refusal(FaultKind::kStuck, 0.0, 1.0, 1.0, 1.0, 0.1).rfind("end", 0), 0U);
  EXPECT_EQ(refusal(FaultKind::kStuck, 0.0, 0.0, 1.0, nan, 0.1).rfind("probability", 0), 0U);
  EXPECT_EQ(refusal(FaultKind::kStuck, 0.0, 0.0, 1.0, 1.0, 0.0).rfind("interval", 0), 0U);
}

}  // namespace
}  // namespace endovascular_sim::robot
