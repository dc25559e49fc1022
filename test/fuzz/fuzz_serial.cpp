#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "test/haptics/host_fixture.h"

// Bytes of the serial line, in both directions. The first byte of an input selects the receiver and the size of the
// blocks that it receives; every block is a millisecond apart.

using namespace endovascular_sim::haptics;  // NOLINT: a program's main file

namespace
{

void receiveAsHost(const std::uint8_t* data, std::size_t size, std::size_t block)
{
  RosserialHost host(test::hostOptions());
  test::BufferSink sink;
  double now = 100.0;
  host.lineOpened(now);
  for (std::size_t at = 0; at < size; at += block)
  {
    now += 1e-3;
    host.receive(data + at, std::min(block, size - at), now, {1800000000U, 5U});
    HandMotion newest;
    for (const MotionSample& motion : host.takeMotion())
    {
      newest = motion.command;
      if (!std::isfinite(newest.insertion) || !std::isfinite(newest.rotation))
        std::abort();
    }
    host.commandForce({1.0, 0.01}, newest, now);
    host.tick(now, {1800000000U, 5U});
    host.output().flush(sink, now);
    host.takeLog();
    if (!std::isfinite(host.renderedForce().force) || !std::isfinite(host.renderedForce().torque))
      std::abort();
  }
}

void receiveAsDevice(const std::uint8_t* data, std::size_t size, std::size_t block)
{
  RosserialDevice device(test::deviceOptions());
  double now = 100.0;
  for (std::size_t at = 0; at < size; at += block)
  {
    now += 1e-3;
    device.receive(data + at, std::min(block, size - at), now);
    device.tick(now);
    device.takeOutput();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  if (size == 0)
    return 0;
  const std::size_t block = 1 + data[0] / 2U;
  if (data[0] % 2U == 0)
    receiveAsHost(data + 1, size - 1, block);
  else
    receiveAsDevice(data + 1, size - 1, block);
  return 0;
}
