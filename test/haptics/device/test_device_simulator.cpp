#include "haptics/device/device_simulator.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "common/error.h"
#include "haptics/device/motion_script.h"
#include "haptics/host/haptic_link.h"
#include "test/common/temporary_folder.h"
#include "test/haptics/host_fixture.h"

namespace endovascular_sim::haptics
{
namespace
{

/** Simulator and link on a real pty in simulated time, in steps of 0.1 ms; the simulation responds immediately. */
struct SimulatorBench
{
  explicit SimulatorBench(double baud = 230400.0)
  {
    SimulatorOptions options;
    options.link = link_path;
    options.baud = baud;
    options.device = test::deviceOptions();
    options.duration = std::numeric_limits<double>::infinity();
    options.motion = [](double time) -> HandMotion { return {0.02 * time, 0.5 * time}; };
    simulator.emplace(options);
    simulator->plug(now);
    LinkOptions host;
    host.port = link_path;
    host.baud = static_cast<int>(baud);
    host.host = test::hostOptions();
    link.emplace(host);
  }

  void run(double seconds)
  {
    for (const double end = now + seconds; now < end; now += 1e-4)
    {
      simulator->step(now);
      link->service(now, {});
      for (const MotionSample& motion : link->host().takeMotion())
        link->commandForce({1.0, 0.01}, motion.command, now, {});
    }
  }

  double now = 10.0;
  TemporaryFolder folder;
  std::string link_path = folder.file("device");
  std::optional<DeviceSimulator> simulator;
  std::optional<HapticLink> link;
};

TEST(DeviceSimulator, MeasuresTheTransmissionTimeOfTheLine)
{
  SimulatorBench bench;
  bench.run(1.0);
  EXPECT_TRUE(bench.simulator->hasStarted());
  const auto report = bench.simulator->report();
  // 21 bytes in each direction at 10 bits per byte take 1.823 ms; steps of 0.1 ms round up.
  EXPECT_GE(report.motion_to_force.percentile(0.0), 1.82e-3);
  EXPECT_LE(report.motion_to_force.percentile(0.5), 2.2e-3);
  EXPECT_GT(report.motion_to_force.count(), 900U);
  EXPECT_NEAR(report.forceRate(), 1000.0, 20.0);
  EXPECT_EQ(report.largest_force, 1.0);
  EXPECT_EQ(report.bytes_lost, 0U);
  EXPECT_EQ(report.watchdog_trips, 0U);
}

TEST(DeviceSimulator, LosesBytesOnASlowLineAndTheHostResynchronises)
{
  SimulatorBench bench(57600.0);
  bench.run(2.0);
  EXPECT_GT(bench.simulator->report().bytes_lost, 1000U);
  EXPECT_GT(bench.link->host().parserCounters().resyncs, 0U);
  EXPECT_GT(bench.link->host().counters().samples, 5U) << "complete frames between truncated ones are found";
  EXPECT_EQ(bench.simulator->report().resyncs, 0U) << "the host does not exceed the speed of the line";
}

TEST(DeviceSimulator, RestartsItsCountAfterAReplugWithoutAJumpOfTheCommand)
{
  SimulatorBench bench;
  bench.run(1.0);
  const double before = bench.link->host().motion().command().insertion;
  EXPECT_GT(before, 0.015);
  bench.simulator->unplug();
  bench.run(0.3);
  EXPECT_EQ(bench.link->host().renderedForce().force, 0.0);
  bench.simulator->plug(bench.now);
  bench.run(0.5);
  EXPECT_EQ(bench.link->host().state(), DeviceState::kEnabled);
  const double after = bench.link->host().motion().command().insertion;
  EXPECT_GT(after, before);
  EXPECT_LT(after, before + 0.02 * 0.55) << "motion while unplugged is not added";
}

TEST(DeviceSimulator, DoesNotReplaceAFileThatIsNotALink)
{
  const TemporaryFolder folder;
  const std::string path = folder.write("file", "content");
  Pty pty;
  EXPECT_THROW(pty.plug(path), InputError);
  EXPECT_EQ(std::filesystem::file_size(path), 7U);
}

TEST(MotionScript, InterpolatesAndHolds)
{
  const TemporaryFolder folder;
  const MotionScript script =
      MotionScript::load(folder.write("script.csv", "time,insertion,rotation\n# a comment\n1, 0.1, 1\n\n3, 0.3, -1\n"));
  EXPECT_EQ(script.at(0.0).insertion, 0.1);
  EXPECT_DOUBLE_EQ(script.at(2.0).insertion, 0.2);
  EXPECT_DOUBLE_EQ(script.at(2.0).rotation, 0.0);
  EXPECT_EQ(script.at(9.0).insertion, 0.3);
  EXPECT_EQ(script.duration(), 3.0);
}

TEST(MotionScript, RejectsInvalidRowsWithTheirLineNumber)
{
  const TemporaryFolder folder;
  for (const char* text : {"1,2\n", "1,2,3,4\n", "1,0,0\n1,0,0\n", "1,nan,0\n", "", "1,x,0\n"})
    EXPECT_THROW(MotionScript::load(folder.write("bad.csv", text)), InputError) << text;
  EXPECT_THROW(MotionScript::load(folder.file("missing.csv")), InputError);
}

TEST(LatencyRecord, ReturnsExactPercentiles)
{
  LatencyRecord record;
  EXPECT_EQ(record.percentile(0.5), 0.0);
  for (int i = 100; i >= 1; --i)
    record.add(i);
  EXPECT_EQ(record.percentile(0.5), 50.0);
  EXPECT_EQ(record.percentile(0.99), 99.0);
  EXPECT_EQ(record.percentile(1.0), 100.0);
}

}  // namespace
}  // namespace endovascular_sim::haptics
