#include "haptics/host/rosserial_host.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "test/haptics/host_fixture.h"
#include "test/haptics/recordings.h"

namespace endovascular_sim::haptics
{
namespace
{

using test::Bench;

TEST(RosserialHost, RequestsTheTopicsAndAnswersTimeRequestsWithTheWallClock)
{
  test::BufferSink sink;
  RosserialHost host(test::hostOptions());
  host.lineOpened(0.0);
  host.output().flush(sink, 0.0);
  EXPECT_EQ(sink.take(), encodeTopicRequest());
  const Bytes question = encodeFrame(kTime, encode(WallTime()));
  host.receive(question.data(), question.size(), 0.001, {1800000000U, 5U});
  host.output().flush(sink, 0.001);
  EXPECT_EQ(sink.take(), encodeFrame(kTime, encode(WallTime{1800000000U, 5U})));
}

TEST(RosserialHost, RepeatsTheTopicRequestWhileTheDeviceIsSilent)
{
  Bench bench;
  bench.device_active = false;
  bench.run(2100);
  EXPECT_EQ(bench.host.counters().topic_requests, 5U);
  EXPECT_EQ(bench.host.state(), DeviceState::kDisabled);
}

TEST(RosserialHost, TransfersMotionFromTheDeviceAndForceToIt)
{
  Bench bench;
  bench.run(20);
  EXPECT_TRUE(bench.device.isSubscribed());
  bench.insertion = 0.002F;
  bench.run(30);
  EXPECT_EQ(bench.host.state(), DeviceState::kEnabled);
  EXPECT_EQ(bench.motions.back().command.insertion, static_cast<double>(0.002F));
  ASSERT_FALSE(bench.forces.empty());
  EXPECT_EQ(bench.forces.back().force, 1.0F);
  EXPECT_EQ(bench.forces.back().torque, 0.01F);
  EXPECT_EQ(bench.forces.back().state, DeviceState::kEnabled);
  EXPECT_EQ(bench.forces.back().sample_time, bench.milliseconds * 1000U) << "responds to the newest sample";
  EXPECT_GE(bench.forces.size(), 48U) << "sent on arrival, not polled";
}

TEST(RosserialHost, IdentifiesTheSampleThatAForceRespondsTo)
{
  Bench bench;
  std::vector<HandMotion> commands;
  for (int i = 0; i < 100; ++i)
  {
    bench.insertion += 1e-4F;
    bench.simulation_active = false;
    bench.step();
    commands.push_back(bench.motions.empty() ? HandMotion() : bench.motions.back().command);
  }
  bench.host.commandForce({1.0, 0.0}, commands[60], bench.now);
  bench.step();
  EXPECT_EQ(bench.forces.back().sample_time, 61U * 1000U);
}

TEST(RosserialHost, RemovesTheForceWhenTheDeviceBecomesSilent)
{
  Bench bench;
  bench.run(100);
  ASSERT_EQ(bench.forces.back().force, 1.0F);
  bench.device_active = false;
  bench.run(100);
  EXPECT_EQ(bench.forces.back().force, 0.0F);
  EXPECT_EQ(bench.forces.back().torque, 0.0F);
  EXPECT_EQ(bench.host.state(), DeviceState::kDisabled);
  EXPECT_EQ(bench.host.counters().links_lost, 1U);
  bench.device_active = true;
  bench.run(50);
  EXPECT_EQ(bench.forces.back().force, 1.0F) << "the force returns";
}

TEST(RosserialHost, RemovesTheForceWhenTheSimulationBecomesSilent)
{
  Bench bench;
  bench.run(100);
  ASSERT_EQ(bench.forces.back().force, 1.0F);
  bench.simulation_active = false;
  bench.run(51);
  EXPECT_EQ(bench.forces.back().force, 0.0F);
  EXPECT_EQ(bench.forces.back().state, DeviceState::kPaused);
  const std::size_t before = bench.forces.size();
  const std::size_t motions = bench.motions.size();
  bench.run(100);
  EXPECT_GE(bench.forces.size(), before + 4) << "zero force is sent explicitly and repeatedly";
  EXPECT_EQ(bench.motions.size(), motions + 100) << "motion continues";
  EXPECT_EQ(bench.device.watchdogTrips(), 0U);
}

TEST(RosserialHost, IsPausedWithoutForceWhileTheSimulationIs)
{
  Bench bench;
  bench.run(100);
  ASSERT_EQ(bench.host.state(), DeviceState::kEnabled);
  bench.host.setSimulationState("no response of the contact node", bench.now);
  bench.run(50);  // the simulation still publishes forces
  EXPECT_EQ(bench.host.state(), DeviceState::kPaused);
  EXPECT_EQ(bench.host.reason(), "no response of the contact node");
  EXPECT_EQ(bench.forces.back().force, 0.0F);
  bench.host.setSimulationState("", bench.now);
  bench.run(50);
  EXPECT_EQ(bench.host.state(), DeviceState::kEnabled);
  EXPECT_EQ(bench.forces.back().force, 1.0F);
}

TEST(RosserialHost, StartsAtThePositionOfTheInstrumentAndMovesNothingBefore)
{
  HostOptions options = test::hostOptions();
  options.start = std::nullopt;
  Bench bench(options);
  bench.simulation_active = false;
  bench.insertion = 0.3F;  // the device's count does not start at zero
  bench.run(100);
  EXPECT_TRUE(bench.motions.empty());
  bench.host.commandForce({0.0, 0.0}, {0.06, 1.5}, bench.now);
  bench.run(1);
  ASSERT_FALSE(bench.motions.empty());
  EXPECT_EQ(bench.motions.front().command.insertion, 0.06);
  EXPECT_EQ(bench.motions.front().command.rotation, 1.5);
}

TEST(RosserialHost, HoldsTheCommandWhileTheHandDoesNotHoldTheWire)
{
  Bench bench;
  bench.run(20);
  for (int i = 0; i < 100; ++i)
  {
    bench.insertion += 1e-4F;
    bench.step();
  }
  const HandMotion held = bench.motions.back().command;
  bench.flags = 0;
  bench.run(50);
  EXPECT_EQ(bench.host.state(), DeviceState::kDisabled);
  EXPECT_EQ(bench.forces.back().force, 0.0F);
  bench.insertion = 0.0F;
  bench.run(10);
  EXPECT_EQ(bench.motions.back().command.insertion, held.insertion);
  bench.flags = HapticSample::kEnabled;
  bench.run(20);
  EXPECT_EQ(bench.host.state(), DeviceState::kEnabled);
  EXPECT_EQ(bench.motions.back().command.insertion, held.insertion)
      << "no jump after the handle is gripped at another position";
  bench.flags = HapticSample::kEnabled | HapticSample::kFault;
  bench.run(30);
  EXPECT_EQ(bench.host.state(), DeviceState::kFault);
  EXPECT_EQ(bench.forces.back().force, 0.0F);
}

TEST(RosserialHost, FaultsOnAForceThatIsNotANumber)
{
  Bench bench;
  bench.run(100);
  bench.simulated.force = std::nan("");
  for (int i = 0; i < 60; ++i)
  {
    bench.step();
    EXPECT_TRUE(std::isfinite(bench.forces.back().force));
  }
  EXPECT_EQ(bench.forces.back().force, 0.0F);
  EXPECT_EQ(bench.forces.back().state, DeviceState::kFault);
  bench.simulated.force = 1.0;
  bench.run(600);
  EXPECT_EQ(bench.host.state(), DeviceState::kEnabled);
  EXPECT_EQ(bench.forces.back().force, 1.0F);
}

TEST(RosserialHost, ClampsTheForceToItsLimits)
{
  HostOptions options = test::hostOptions();
  options.limits.force = 2.0;
  Bench bench(options);
  bench.simulated = {-50.0, 50.0};
  bench.run(200);
  EXPECT_EQ(bench.forces.back().force, -2.0F);
  EXPECT_EQ(bench.forces.back().torque, 0.05F);
}

TEST(RosserialHost, RefusesATopicWithADifferentDefinition)
{
  DeviceOptions options = test::deviceOptions();
  options.sample.md5 = "00000000000000000000000000000000";
  Bench bench(test::hostOptions(), options);
  bench.run(100);
  EXPECT_TRUE(bench.motions.empty());
  ASSERT_EQ(bench.host.topics().refused().size(), 1U);
  EXPECT_NE(bench.host.topics().refused().begin()->second.reason.find("md5"), std::string::npos);
  EXPECT_NE(bench.host.reason().find("md5"), std::string::npos) << "the operating state reports the reason";
  EXPECT_GT(bench.host.counters().unused_frames, 0U);
}

TEST(RosserialHost, RefusesABufferSmallerThanAFrame)
{
  for (const std::int32_t size : {20, 0, -1})
  {
    DeviceOptions options = test::deviceOptions();
    options.buffer_size = size;
    Bench bench(test::hostOptions(), options);
    bench.run(100);
    EXPECT_TRUE(bench.motions.empty());
    EXPECT_TRUE(bench.forces.empty()) << "no force may be sent to a buffer that it would overrun";
    ASSERT_EQ(bench.host.topics().refused().size(), 2U);
    EXPECT_NE(bench.host.topics().refused().begin()->second.reason.find("too small"), std::string::npos);
  }
  DeviceOptions options = test::deviceOptions();
  options.buffer_size = 21;
  Bench bench(test::hostOptions(), options);
  bench.run(100);
  EXPECT_EQ(bench.host.state(), DeviceState::kEnabled);
}

TEST(RosserialHost, RefusesWrongTypesDirectionsIdsAndDuplicates)
{
  TopicRegistry topics(test::hostOptions().types);
  const TopicInfo good{125, "a", "endovascular_sim/HapticSample", test::kSampleMd5, 100};
  TopicInfo other = good;
  other.type = "std_msgs/UInt32";
  EXPECT_NE(topics.announce(other, true).find("not one that the host uses"), std::string::npos);
  EXPECT_NE(topics.announce(good, false).find("must publish"), std::string::npos);
  other = good;
  other.id = 7;
  EXPECT_NE(topics.announce(other, true).find("reserved"), std::string::npos);
  EXPECT_EQ(topics.announce(good, true), "");
  EXPECT_EQ(topics.announce(good, true), "") << "announced again";
  other = good;
  other.id = 126;
  EXPECT_NE(topics.announce(other, true).find("already in use"), std::string::npos);
}

TEST(RosserialHost, DetectsADeviceThatWasConnectedToAnEarlierHost)
{
  Bench bench;
  bench.run(50);
  RosserialHost restarted(test::hostOptions());
  restarted.lineOpened(0.0);
  test::BufferSink sink;
  restarted.output().flush(sink, 0.0);
  sink.take();  // lost
  const Bytes sample = encodeFrame(RosserialDevice::kSampleId, encode(HapticSample()));
  restarted.receive(sample.data(), sample.size(), 0.6, {});
  restarted.output().flush(sink, 0.6);
  EXPECT_EQ(sink.take(), encodeTopicRequest());
  EXPECT_EQ(restarted.counters().unknown_ids, 1U);
}

TEST(RosserialHost, ForwardsTheDevicesLog)
{
  Bench bench;
  bench.device.sendLog(LogLine::kWarn, "motor is warm");
  bench.run(1);
  const auto log = bench.host.takeLog();
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].text, "motor is warm");
  EXPECT_EQ(log[0].level, LogLine::kWarn);
}

TEST(RosserialHost, SendsZeroForceAndStopAtShutdown)
{
  Bench bench;
  bench.run(100);
  bench.host.shutDown(bench.now, bench.wall);
  bench.host.output().flush(bench.sink, bench.now);
  const Bytes bytes = bench.sink.take();
  const auto forces = bench.device.receive(bytes.data(), bytes.size(), bench.now);
  ASSERT_EQ(forces.size(), 1U);
  EXPECT_EQ(forces[0].force, 0.0F);
  EXPECT_EQ(forces[0].state, DeviceState::kDisabled);
  EXPECT_EQ(bench.device.stops(), 1U);
}

TEST(RosserialHost, SendsTheLatestForceAfterABlockedPortIsFree)
{
  Bench bench;
  bench.run(100);
  bench.sink.blocked = true;
  bench.simulated.force = 0.5;
  bench.run(20);
  bench.simulated.force = 0.25;
  bench.run(20);
  const std::size_t before = bench.forces.size();
  bench.sink.blocked = false;
  bench.simulation_active = false;
  bench.run(1);
  ASSERT_EQ(bench.forces.size(), before + 2) << "the partially written frame and the latest one";
  EXPECT_EQ(bench.forces.back().force, 0.25F);
  EXPECT_GT(bench.host.output().superseded(), 30U);
}

TEST(RosserialHost, AcceptsJointStatesAndSendsWrenches)
{
  DeviceOptions options;
  options.sample = {PayloadFormat::kJointState, "sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd"};
  options.force = {PayloadFormat::kWrench, "geometry_msgs/Wrench", "4f539cf138b23283b520fd271b567936"};
  Bench bench(test::hostOptions(), options);
  bench.run(20);
  bench.insertion = 0.003F;
  bench.run(30);
  EXPECT_EQ(bench.host.state(), DeviceState::kEnabled);
  EXPECT_EQ(bench.motions.back().command.insertion, static_cast<double>(0.003F));
  EXPECT_EQ(bench.motions.back().device_time, bench.milliseconds * 1000U);
  EXPECT_EQ(bench.forces.back().force, 1.0F);
  EXPECT_EQ(bench.forces.back().torque, static_cast<float>(0.01));
}

TEST(RosserialHost, WakesInTimeForItsWatchdogs)
{
  Bench bench;
  bench.run(100);
  EXPECT_GT(bench.host.wakeAt(), bench.now);
  EXPECT_LE(bench.host.wakeAt(), bench.now + 30e-3);
  // Called only at wakeAt() and without any input, the host must reach zero force in time.
  double now = bench.now;
  int wakes = 0;
  HapticForce last = bench.forces.back();
  while (bench.host.wakeAt() <= bench.now + 50e-3)
  {
    now = std::max(now, bench.host.wakeAt());
    bench.host.tick(now, bench.wall);
    bench.host.output().flush(bench.sink, now);
    const Bytes bytes = bench.sink.take();
    for (const HapticForce& force : bench.device.receive(bytes.data(), bytes.size(), now))
      last = force;
    ASSERT_LT(++wakes, 30) << "wake-up times must not lie in the past";
  }
  EXPECT_EQ(last.force, 0.0F);
}

TEST(RosserialHost, HandlesRandomBytesAndThenAcceptsADevice)
{
  std::mt19937 random(5);
  RosserialHost host(test::hostOptions());
  host.lineOpened(0.0);
  test::BufferSink sink;
  for (int block = 0; block < 2000; ++block)
  {
    // Half of the data are valid frames with random ids and content, which pass the parser.
    Bytes bytes(random() % 200);
    for (std::uint8_t& byte : bytes)
      byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : 0);
    if (block % 2 == 0)
      bytes = encodeFrame(static_cast<std::uint16_t>(random() % 140), bytes);
    host.receive(bytes.data(), bytes.size(), 1e-3 * block, {});
    host.tick(1e-3 * block, {});
    host.output().flush(sink, 1e-3 * block);
  }
  EXPECT_GT(host.counters().malformed, 0U);
  EXPECT_EQ(host.state(), DeviceState::kDisabled);
}

/** Replays the device's bytes of a recording against a simulated force of 1 N, with a gap from @p silent_from to
 *  @p silent_until. Calls @p check(time, host) every millisecond. */
template <typename Check>
void play(const std::vector<test::Piece>& pieces, double silent_from, double silent_until, Check check)
{
  RosserialHost host(test::hostOptions());
  host.lineOpened(0.0);
  test::BufferSink sink;
  auto next = pieces.begin();
  HandMotion last;
  for (int step = 0; next != pieces.end(); ++step)
  {
    const double now = 1e-3 * step;
    for (; next != pieces.end() && next->time <= now; ++next)
      if (next->from_device && (next->time < silent_from || next->time >= silent_until))
        host.receive(next->bytes.data(), next->bytes.size(), now, {});
    for (const MotionSample& motion : host.takeMotion())
    {
      EXPECT_LE(std::abs(motion.command.insertion - last.insertion), 2e-3) << "no jump at " << now;
      last = motion.command;
    }
    host.commandForce({1.0, 0.0}, last, now);
    host.tick(now, {});
    host.output().flush(sink, now);
    check(now, host);
  }
}

TEST(RosserialHost, ReleasesTheForceWithin100MillisecondsOfTheStallInTheRecording)
{
  const auto pieces = test::readRecording("stall_3_to_10s.tap");
  if (pieces.empty())
    GTEST_SKIP() << test::kNoRecordings;
  bool held_before = false;
  bool held_after = false;
  play(pieces, 3.0, 10.0,
       [&](double now, const RosserialHost& host)
       {
         held_before = held_before || (now < 3.0 && host.renderedForce().force == 1.0);
         held_after = held_after || (now > 10.0 && host.renderedForce().force == 1.0);
         if (now >= 3.1 && now < 10.0)
         {
           EXPECT_EQ(host.renderedForce().force, 0.0) << now;
           EXPECT_EQ(host.state(), DeviceState::kDisabled) << now;
         }
       });
  EXPECT_TRUE(held_before);
  EXPECT_TRUE(held_after);
}

TEST(RosserialHost, AcceptsTheRecordedOriginalClient)
{
  for (const char* name : {"handshake_100hz.tap", "force_1khz_to_device.tap"})
  {
    const auto pieces = test::readRecording(name);
    if (pieces.empty())
      GTEST_SKIP() << test::kNoRecordings;
    HostCounters counters;
    double enabled = 0.0;
    play(pieces, 1e9, 1e9,
         [&](double now, const RosserialHost& host)
         {
           counters = host.counters();
           enabled += host.state() == DeviceState::kEnabled ? 1e-3 : 0.0;
           EXPECT_TRUE(now < 0.5 || host.topics().force()) << "the Wrench subscriber is accepted";
         });
    EXPECT_GT(counters.samples, 900U) << name;
    EXPECT_EQ(counters.malformed, 0U) << name;
    EXPECT_EQ(counters.unknown_ids, 0U) << name;
    EXPECT_GT(enabled, 5.0) << name;
  }
}

}  // namespace
}  // namespace endovascular_sim::haptics
