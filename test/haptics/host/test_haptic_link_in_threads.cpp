#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "haptics/device/device_simulator.h"
#include "haptics/host/haptic_link.h"
#include "test/haptics/host_fixture.h"

// The threads of the haptic node and of the device: one serves the line, one commands forces, one is the device.

namespace endovascular_sim::haptics
{
namespace
{

constexpr std::uint64_t kForces = 50;
constexpr WallTime kWall{1800000000U, 5U};

double now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void pause()
{
  std::this_thread::sleep_for(std::chrono::microseconds(500));
}

SimulatorOptions deviceAt(const std::string& path)
{
  SimulatorOptions options;
  options.link = path;
  options.device = test::deviceOptions();
  options.motion = [](double t)
  {
    HandMotion hand;
    hand.insertion = 1e-3 * t;
    return hand;
  };
  options.duration = std::numeric_limits<double>::infinity();
  return options;
}

TEST(HapticLinkInThreads, DeliversForcesThatOneThreadCommandsAndAnotherSends)
{
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("evs_link_in_threads_" + std::to_string(getpid()));
  LinkOptions options;
  options.port = path.string();
  options.host = test::hostOptions();
  HapticLink link(options);
  std::mutex mutex;
  std::atomic<bool> stop{false};
  std::atomic<std::uint64_t> forces{0};
  std::thread device(
      [&]
      {
        DeviceSimulator simulator(deviceAt(path.string()));
        simulator.plug(now());
        for (; !stop; pause())
        {
          simulator.step(now());
          forces = simulator.report().forces;
        }
      });
  std::thread line(
      [&]
      {
        for (; !stop; pause())
        {
          const std::lock_guard<std::mutex> lock(mutex);
          link.service(now(), kWall);
        }
      });
  std::uint64_t samples = 0;
  for (int k = 0; k < 20000 && (forces < kForces || samples < kForces); ++k, pause())
  {
    const std::lock_guard<std::mutex> lock(mutex);
    HandMotion newest;
    for (const MotionSample& motion : link.host().takeMotion())
    {
      newest = motion.command;
      ++samples;
    }
    link.commandForce({1.0, 0.01}, newest, now(), kWall);
  }
  stop = true;
  line.join();
  device.join();
  EXPECT_GE(forces, kForces);
  EXPECT_GE(samples, kForces);
}

}  // namespace
}  // namespace endovascular_sim::haptics
