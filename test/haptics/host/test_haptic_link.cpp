#include "haptics/host/haptic_link.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "haptics/serial/pty.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"
#include "test/haptics/host_fixture.h"

namespace endovascular_sim::haptics
{
namespace
{

/** Device on a real pty that can be unplugged. Its path is a symbolic link, as in /dev/serial/by-id. */
class PtyDevice
{
public:
  ~PtyDevice() { unplug(); }

  void plug()
  {
    device.emplace(test::deviceOptions());
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    ASSERT_GE(master_, 0);
    ASSERT_EQ(grantpt(master_), 0);
    ASSERT_EQ(unlockpt(master_), 0);
    std::filesystem::create_symlink(ptsname(master_), path());
  }

  void unplug()
  {
    if (master_ < 0)
      return;
    std::filesystem::remove(path());
    close(master_);
    master_ = -1;
  }

  /** Transfers bytes in both directions. @return forces received */
  std::vector<HapticForce> exchange(double now)
  {
    std::vector<HapticForce> forces;
    if (master_ < 0)
      return forces;
    const Bytes out = device->takeOutput();
    if (!out.empty())
    {
      EXPECT_EQ(write(master_, out.data(), out.size()), static_cast<ssize_t>(out.size()));
    }
    // The kernel transfers written bytes with a delay. Only a read that finds nothing waits for the transfer.
    std::uint8_t in[4096];
    for (ssize_t count = 0; (count = read(master_, in, sizeof in)) > 0;)
      for (const HapticForce& force : device->receive(in, static_cast<std::size_t>(count), now))
        forces.push_back(force);
    return forces;
  }

  std::string path() const { return folder_.file("haptic"); }

  std::optional<RosserialDevice> device;

private:
  TemporaryFolder folder_;
  int master_ = -1;
};

/** Link and device on a pty, in simulated time. */
struct LinkBench
{
  LinkBench()
  {
    LinkOptions options;
    options.port = pty.path();
    options.baud = 230400;
    options.host = test::hostOptions();
    link.emplace(options);
  }

  void step()
  {
    now += 1e-3;
    ++milliseconds;
    if (pty.device)
      pty.device->sendSample({milliseconds * 1000U, insertion, 0.0F, HapticSample::kEnabled});
    for (const HapticForce& force : pty.exchange(now))
      last = force;
    link->service(now, wall);
    for (const MotionSample& motion : link->host().takeMotion())
    {
      largest_jump = std::max(largest_jump, std::abs(motion.command.insertion - command.insertion));
      command = motion.command;
    }
    link->commandForce({1.0, 0.0}, command, now, wall);
  }

  void run(int steps)
  {
    for (int i = 0; i < steps; ++i)
      step();
  }

  PtyDevice pty;
  std::optional<HapticLink> link;
  WallTime wall{1800000000U, 0U};
  double now = 0.0;
  std::uint32_t milliseconds = 0;
  float insertion = 0.0F;
  HandMotion command;
  double largest_jump = 0.0;
  HapticForce last;
};

TEST(HapticLink, ConnectsOverAPtyWithRawBytes)
{
  LinkBench bench;
  bench.pty.plug();
  // Times with bytes for carriage return, line feed, XON, XOFF and interrupt. A line in cooked mode would change them.
  bench.milliseconds = 0x0d0a11;
  bench.run(50);
  for (int i = 0; i < 200; ++i)
  {
    bench.insertion += 1e-4F;
    bench.step();
  }
  EXPECT_EQ(bench.link->host().state(), DeviceState::kEnabled);
  EXPECT_EQ(bench.last.force, 1.0F);
  EXPECT_NEAR(bench.command.insertion, 0.02, 2e-4);
  EXPECT_EQ(bench.link->host().parserCounters().resyncs, 0U);
  EXPECT_EQ(bench.pty.device->parserCounters().resyncs, 0U);
}

TEST(HapticLink, WaitsForADeviceThatIsNotYetConnected)
{
  LinkBench bench;
  bench.run(500);
  EXPECT_FALSE(bench.link->isOpen());
  EXPECT_NE(bench.link->host().reason().find("No such file"), std::string::npos);
  bench.pty.plug();
  bench.run(500);
  EXPECT_EQ(bench.link->host().state(), DeviceState::kEnabled);
}

TEST(HapticLink, ReleasesTheForceWhenUnpluggedAndContinuesWithoutAJump)
{
  LinkBench bench;
  bench.pty.plug();
  bench.run(50);
  for (int i = 0; i < 1000; ++i)
  {
    bench.insertion += 5e-5F;
    bench.step();
  }
  const double held = bench.command.insertion;
  ASSERT_GT(held, 0.045);
  ASSERT_EQ(bench.link->host().renderedForce().force, 1.0);

  bench.pty.unplug();
  bench.run(2);
  EXPECT_FALSE(bench.link->isOpen());
  EXPECT_EQ(bench.link->host().renderedForce().force, 0.0);
  EXPECT_EQ(bench.link->host().state(), DeviceState::kDisabled);
  bench.run(700);

  bench.insertion = 0.0F;  // the count restarts with the device
  bench.pty.plug();
  bench.run(500);
  EXPECT_EQ(bench.link->host().state(), DeviceState::kEnabled) << "reconnected within 0.5 s";
  EXPECT_EQ(bench.link->opened(), 2U);
  EXPECT_EQ(bench.command.insertion, held);
  for (int i = 0; i < 100; ++i)
  {
    bench.insertion += 5e-5F;
    bench.step();
  }
  EXPECT_GT(bench.command.insertion, held + 0.004);
  EXPECT_LT(bench.largest_jump, 1e-3);
}

TEST(HapticLink, SendsZeroForceAndStopAtShutdown)
{
  LinkBench bench;
  bench.pty.plug();
  bench.run(100);
  bench.link->shutDown(bench.now, bench.wall);
  bench.link->flush(bench.now + 0.1);
  EXPECT_TRUE(bench.link->isIdle());
  const auto forces = bench.pty.exchange(bench.now);
  ASSERT_FALSE(forces.empty());
  EXPECT_EQ(forces.back().force, 0.0F);
  EXPECT_EQ(bench.pty.device->stops(), 1U);
}

TEST(SerialPort, OpensAtAnySpeedSuchAs250000OfArduino)
{
  EXPECT_NO_THROW(SerialPort::checkBaud(250000, "baud"));
  Pty pty;
  const TemporaryFolder folder;
  const std::string link = folder.file("device");
  pty.plug(link);
  SerialPort port;
  EXPECT_TRUE(port.open(link, 250000)) << port.error();
  EXPECT_TRUE(port.open(link, 74880)) << port.error();
}

TEST(SerialPort, RejectsASpeedThatNoLineHas)
{
  LinkOptions options;
  options.baud = 96;
  const std::string message = inputErrorOf([&] { HapticLink link(options); });
  EXPECT_NE(message.find("between 1200 and"), std::string::npos) << message;
  EXPECT_NO_THROW(SerialPort::checkBaud(2000000, "baud"));
}

}  // namespace
}  // namespace endovascular_sim::haptics
