#include "rviz_plugin/model/pressure_monitor.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

sensor_msgs::FluidPressure reading(const std::string& frame, double time, double pressure)
{
  sensor_msgs::FluidPressure message;
  message.header.frame_id = frame;
  message.header.stamp = ros::Time(time);
  message.fluid_pressure = pressure;
  return message;
}

HeartPhase heart(double time, double phase)
{
  HeartPhase message;
  message.header.stamp = ros::Time(time);
  message.phase = phase;
  message.heart_rate = 1.0;
  message.mean_pressure = 12e3;
  message.mean_root_pressure = 12e3;
  message.mean_readings = {9e3, 12e3};
  return message;
}

PressureMonitor twoLines()
{
  PressureMonitor monitor;
  monitor.setLines({"wire", "catheter"}, {"wire_tip", "catheter_tip"});
  return monitor;
}

TEST(PressureMonitor, KnowsNothingBeforeTheFirstMessageOfTheHeart)
{
  EXPECT_FALSE(twoLines().state().has_value());
}

TEST(PressureMonitor, KeepsTheLastSecondsAndTheExtremesOfABeat)
{
  PressureMonitor monitor = twoLines();
  for (int k = 0; k < 2000; ++k)
  {
    const double time = 5e-3 * k;
    // The pressure of the first seconds is higher than that of the last beat.
    const double pressure = 1e3 * (time < 8.0 ? 20.0 : 12.0) + 3e3 * std::sin(2.0 * M_PI * time);
    monitor.add(reading("catheter_tip", time, pressure));
    monitor.add(heart(time, time - std::floor(time)));
  }
  const BloodState state = *monitor.state();
  ASSERT_EQ(state.lines.size(), 2U);
  EXPECT_TRUE(state.lines[0].readings.empty());
  const PressureTrace& catheter = state.lines[1];
  EXPECT_EQ(catheter.name, "catheter");
  EXPECT_NEAR(catheter.readings.back().first - catheter.readings.front().first, PressureMonitor::kDuration, 0.01);
  EXPECT_NEAR(catheter.highest, 15e3, 10.0);
  EXPECT_NEAR(catheter.lowest, 9e3, 10.0);
  EXPECT_EQ(catheter.mean, 12e3);
}

TEST(PressureMonitor, DividesTheInnermostMeanByTheOutermostOne)
{
  PressureMonitor monitor = twoLines();
  HeartPhase beat = heart(1.0, 0.0);
  monitor.add(beat);
  EXPECT_NEAR(*monitor.state()->ratio, 0.75, 1e-12);
  EXPECT_FALSE(monitor.state()->is_reserve);
  beat = heart(2.0, 0.0);
  beat.mean_hyperaemia = 1;
  monitor.add(beat);
  EXPECT_TRUE(monitor.state()->is_reserve);
  beat = heart(3.0, 0.0);
  beat.mean_readings = {0.0, 12e3};
  monitor.add(beat);
  EXPECT_FALSE(monitor.state()->ratio.has_value()) << "the wire is outside";
}

TEST(PressureMonitor, BeginsAgainAfterAJumpBack)
{
  PressureMonitor monitor = twoLines();
  for (int k = 0; k < 400; ++k)
  {
    monitor.add(reading("catheter_tip", 5e-3 * k, 12e3));
    monitor.add(heart(5e-3 * k, 0.5));
  }
  monitor.add(heart(0.1, 0.1));
  monitor.add(reading("catheter_tip", 0.1, 11e3));
  const BloodState state = *monitor.state();
  ASSERT_EQ(state.lines[1].readings.size(), 1U);
  EXPECT_EQ(state.phases.size(), 1U);
}

TEST(PressureMonitor, IgnoresWhatIsNoNumberAndUnknownFrames)
{
  PressureMonitor monitor = twoLines();
  monitor.add(heart(1.0, 0.0));
  monitor.add(heart(1.1, std::nan("")));
  monitor.add(reading("catheter_tip", 1.0, std::nan("")));
  monitor.add(reading("somewhere", 1.0, 1e3));
  EXPECT_EQ(monitor.state()->phases.size(), 1U);
  EXPECT_TRUE(monitor.state()->lines[1].readings.empty());
}

TEST(Electrocardiogram, HasItsRWaveBeforeTheOpeningOfTheValveAndIsPeriodic)
{
  double highest = 0.0, at = 0.0;
  for (int k = 0; k <= 1000; ++k)
    if (const double voltage = electrocardiogram(1e-3 * k); voltage > highest)
    {
      highest = voltage;
      at = 1e-3 * k;
    }
  EXPECT_NEAR(highest, 1.0, 0.1);
  EXPECT_GT(at, 0.9);
  EXPECT_LT(at, 0.97);
  EXPECT_NEAR(electrocardiogram(0.0), electrocardiogram(1.0), 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
