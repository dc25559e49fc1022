#pragma once

#include <string>
#include <utility>
#include <vector>

#include "haptics/device/rosserial_device.h"
#include "haptics/host/rosserial_host.h"

namespace endovascular_sim::haptics::test
{

inline const std::string kSampleMd5 = "5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a";
inline const std::string kForceMd5 = "f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0";

/** Options with all types that a host supports; standard types have their true md5 sums. */
inline HostOptions hostOptions()
{
  HostOptions options;
  options.limits.return_time = 1e-3;  // tests of the return set their own
  options.types = {
      {PayloadFormat::kHapticSample, "endovascular_sim/HapticSample", kSampleMd5},
      {PayloadFormat::kJointState, "sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd"},
      {PayloadFormat::kHapticForce, "endovascular_sim/HapticForce", kForceMd5},
      {PayloadFormat::kWrench, "geometry_msgs/Wrench", "4f539cf138b23283b520fd271b567936"},
      {PayloadFormat::kWrenchStamped, "geometry_msgs/WrenchStamped", "d78d3cb249ce23087ade7e7d0c40cfa7"},
  };
  return options;
}

inline DeviceOptions deviceOptions()
{
  DeviceOptions options;
  options.sample.md5 = kSampleMd5;
  options.force.md5 = kForceMd5;
  return options;
}

/** Sink that stores the bytes and can be blocked. */
class BufferSink : public ByteSink
{
public:
  std::size_t write(const std::uint8_t* data, std::size_t size) override
  {
    if (blocked)
      return 0;
    bytes.insert(bytes.end(), data, data + size);
    return size;
  }
  Bytes take() { return std::exchange(bytes, {}); }
  bool blocked = false;
  Bytes bytes;
};

/** Host and device connected through memory, in steps of 1 ms of simulated time. */
struct Bench
{
  explicit Bench(HostOptions host_options = hostOptions(), DeviceOptions device_options = deviceOptions())
    : host(std::move(host_options)), device(std::move(device_options))
  {
    host.lineOpened(now);
  }

  /** Advances by 1 ms; sends a sample if the device is active, and a force if the simulation is active. */
  void step()
  {
    now += 1e-3;
    ++milliseconds;
    if (device_active)
    {
      device.sendSample({milliseconds * 1000U, insertion, rotation, flags});
      const Bytes bytes = device.takeOutput();
      host.receive(bytes.data(), bytes.size(), now, wall);
    }
    for (const MotionSample& motion : host.takeMotion())
      motions.push_back(motion);
    if (simulation_active)
      host.commandForce(simulated, motions.empty() ? HandMotion() : motions.back().command, now);
    host.tick(now, wall);
    host.output().flush(sink, now);
    const Bytes bytes = sink.take();
    for (const HapticForce& force : device.receive(bytes.data(), bytes.size(), now))
      forces.push_back(force);
    device.tick(now);
  }

  void run(int steps)
  {
    for (int i = 0; i < steps; ++i)
      step();
  }

  double now = 100.0;
  WallTime wall{1800000000U, 5U};
  RosserialHost host;
  RosserialDevice device;
  BufferSink sink;
  std::uint32_t milliseconds = 0;
  float insertion = 0.0F;
  float rotation = 0.0F;
  std::uint8_t flags = HapticSample::kEnabled;
  HandForce simulated{1.0, 0.01};
  bool device_active = true;
  bool simulation_active = true;
  std::vector<MotionSample> motions;
  std::vector<HapticForce> forces;
};

}  // namespace endovascular_sim::haptics::test
