#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "fluoroscopy/projection/x_ray_geometry.h"
#include "session/session.h"
#include "simulation/hardware/robot_hardware.h"
#include "simulation/instrument_tip.h"

// Sensors and faults of a session.

namespace endovascular_sim::session
{
namespace
{

const std::string kSensors =
    "sensors=[{name: tracker, kind: em_tracker, rate: 40, delay: 0.02, drop_out: 0.1, noise: {position: 1.0e-3, angle: "
    "0.02}}, {name: encoder, kind: encoder, noise: {insertion: 1.0e-5}}, {name: force, kind: force_sensor, rate: 333, "
    "delay: 0.005, noise: {force: 0.01}}, {name: screen, kind: detector, rate: 15, delay: 0.1, noise: {pixels: 1}}]";
const std::string kPerfect =
    "sensors=[{name: tracker, kind: em_tracker}, {name: encoder, kind: encoder}, {name: force, kind: force_sensor}, "
    "{name: screen, kind: detector}]";
const std::string kCArm = "fluoroscopy={isocentre: [0, 0, 0.05], pixels: 64}";

std::shared_ptr<const World> tubeWith(const std::vector<std::string>& overrides)
{
  return World::open("tube", overrides);
}

/** All readings of a session after each of the next steps. */
std::vector<std::vector<double>> readingsOf(Session& session, int steps)
{
  std::vector<std::vector<double>> rows;
  const simulation::Sensors& sensors = session.observe().sensors();
  for (int step = 0; step < steps; ++step)
  {
    session.step(1);
    std::vector<double> row;
    for (std::size_t k = 0; k < sensors.size(); ++k)
    {
      const sensor::Reading& reading = sensors.reading(k);
      row.insert(row.end(), reading.values.begin(), reading.values.end());
      row.push_back(static_cast<double>(reading.sequence));
      row.push_back(reading.valid ? 1.0 : 0.0);
    }
    rows.push_back(row);
  }
  return rows;
}

TEST(RobotHardware, PerfectSensorsMeasureTheTruth)
{
  Session session(tubeWith({kPerfect, kCArm}));
  session.step(500);
  const Observation& seen = session.observe();
  const simulation::Sensors& sensors = seen.sensors();
  ASSERT_EQ(sensors.size(), 4U);
  const std::vector<double>& pose = sensors.reading(0).values;
  EXPECT_EQ(Eigen::Vector3d(pose[0], pose[1], pose[2]), seen.tip(0).position);
  const Eigen::Quaterniond rotation(pose[6], pose[3], pose[4], pose[5]);
  EXPECT_LT((rotation.toRotationMatrix() - seen.tip(0).frame).norm(), 1e-12);
  EXPECT_EQ(sensors.reading(1).values, (std::vector<double>{seen.hand(0).insertion, seen.hand(0).rotation}));
  EXPECT_EQ(sensors.reading(2).values, (std::vector<double>{seen.hand(0).force, seen.hand(0).torque}));
  const Eigen::Vector2d pixel =
      fluoroscopy::XRayGeometry(session.scene().fluoroscopy->pose()).project(seen.tip(0).position);
  EXPECT_EQ(sensors.reading(3).values, (std::vector<double>{pixel.x(), pixel.y()}));
  for (std::size_t k = 0; k < sensors.size(); ++k)
  {
    EXPECT_TRUE(sensors.reading(k).valid);
    EXPECT_EQ(sensors.reading(k).step, 500U);
  }
}

TEST(RobotHardware, SensorsDoNotChangeTheTrajectory)
{
  Session without(tubeWith({}));
  Session with(tubeWith({kSensors, kCArm}));
  without.step(400);
  with.step(400);
  EXPECT_EQ(with.simulation().trajectoryHash(), without.simulation().trajectoryHash());
}

TEST(RobotHardware, ReadingsDependOnSeedAndStepOnly)
{
  const auto world = tubeWith({kSensors, kCArm});
  Session first(world);
  Session same(world);
  Session other(tubeWith({kSensors, kCArm, "seed=1"}));
  const auto readings = readingsOf(first, 300);
  EXPECT_EQ(readingsOf(same, 300), readings);
  EXPECT_NE(readingsOf(other, 300), readings);
  first.reset();
  EXPECT_EQ(readingsOf(first, 300), readings) << "after a reset";
  same.reset();
  same.setNoiseSeed(4);
  EXPECT_NE(readingsOf(same, 300), readings);
  EXPECT_EQ(same.simulation().trajectoryHash(), first.simulation().trajectoryHash());
}

TEST(RobotHardware, SavedSensorsContinueBitForBit)
{
  const auto world = tubeWith({kSensors, kCArm});
  for (const std::uint64_t seed : {0U, 3U})
  {
    Session session(world);
    session.reset(seed);
    session.setNoiseSeed(9);
    session.step(137);  // samples wait for their delivery
    const std::string state = session.save();
    Session loaded(world);
    loaded.load(state);
    EXPECT_EQ(loaded.save(), state);
    EXPECT_EQ(loaded.noiseSeed(), 9U);
    EXPECT_EQ(loaded.seed(), seed);
    EXPECT_EQ(readingsOf(loaded, 300), readingsOf(session, 300));
  }
}

TEST(RobotHardware, AStateWithoutSensorsHasTheBytesOfBefore)
{
  const auto world = tubeWith({});
  Session session(world);
  session.step(20);
  const std::string state = session.save();
  session.addFault({0, robot::FaultAxis::kInsertion, robot::FaultKind::kStuck});
  const std::string with_fault = session.save();
  EXPECT_GT(with_fault.size(), state.size());
  EXPECT_EQ(session.removeFaults(0, robot::FaultAxis::kInsertion), 1U);
  EXPECT_EQ(session.save(), state);
}

TEST(RobotHardware, AFaultActsBetweenCommandAndHandle)
{
  const auto world = tubeWith({"faults=[{axis: insertion, kind: stuck, start: 0.1, end: 0.2}]"});
  Session session(world);
  session.step(100);
  const double before = session.observe().hand(0).insertion;
  session.step(99);
  EXPECT_NEAR(session.observe().hand(0).insertion, before, 1e-9);
  const double slip = session.simulation().slipped(0).insertion;
  session.step(200);
  Session sound(tubeWith({}));
  sound.step(399);
  EXPECT_NEAR(session.observe().hand(0).insertion + session.simulation().slipped(0).insertion,
              sound.observe().hand(0).insertion + sound.simulation().slipped(0).insertion, 1e-6)
      << slip;
}

TEST(RobotHardware, AddedFaultsAreSavedAndLoaded)
{
  const auto world = tubeWith({});
  Session session(world);
  session.step(50);
  robot::FaultSettings slipping{0, robot::FaultAxis::kInsertion, robot::FaultKind::kSlipping, 0.5};
  slipping.probability = 0.5;
  slipping.interval = 0.01;
  session.addFault(slipping);
  session.addFault({0, robot::FaultAxis::kInsertion, robot::FaultKind::kDelayed, 0.03});
  session.step(75);
  Session loaded(world);
  loaded.load(session.save());
  EXPECT_EQ(loaded.faults().settings().size(), 2U);
  session.step(200);
  loaded.step(200);
  EXPECT_EQ(loaded.simulation().trajectoryHash(), session.simulation().trajectoryHash());
  Session sound(world);
  sound.step(325);
  EXPECT_NE(sound.simulation().trajectoryHash(), session.simulation().trajectoryHash());
  session.reset();
  EXPECT_TRUE(session.faults().empty());
}

TEST(RobotHardware, AVelocityGoesOnThroughSlipping)
{
  Session session(tubeWith({"drive={source: topic, initial_insertion: 0.02}"}),
                  {false, 0.0, true, {}, nullptr, nullptr, nullptr});
  session.addFault({0, robot::FaultAxis::kInsertion, robot::FaultKind::kSlipping, 0.5});
  const double before = session.observe().hand(0).insertion;
  for (int k = 0; k < 10; ++k)
  {
    ASSERT_EQ(
        session.control(0).command("test", drive::jointCommand(drive::CommandKind::kServoVelocity, {}, {0.02, 0.0})),
        drive::CommandVerdict::kAccepted);
    session.step(100);
  }
  EXPECT_NEAR(session.observe().hand(0).insertion - before, 0.5 * 0.02, 0.5e-3) << "half of 20 mm/s in 1 s";
}

TEST(RobotHardware, AnAdoptedStateBeginsWithoutSamples)
{
  Session session(tubeWith({kPerfect, kCArm}));
  session.step(50);
  Session other(tubeWith({kPerfect, kCArm, "vessel.friction=0.3"}));
  const std::vector<std::string> dropped = other.adopt(session.save());
  EXPECT_NE(dropped.back().find("sensors"), std::string::npos);
  EXPECT_EQ(other.observe().sensors().reading(1).sequence, 0U);
  other.step(1);
  EXPECT_EQ(other.observe().sensors().reading(1).sequence, 51U);
}

TEST(RobotHardware, ATipOutsideIsNotMeasured)
{
  Session session(World::parse(
      "vessel: {friction: 0.1, tube: {radius: 0.004, pieces: [{length: 0.2}]}}\n"
      "entry: {position: [0, 0, 0], direction: [0, 0, 1]}\n"
      "instruments:\n"
      "  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: script, initial_insertion: 0.03}}\n"
      "  - {instrument: {use: catheter_6f_multipurpose, name: tube}, drive: {source: script, initial_insertion: "
      "-0.03}}\n"
      "sensors: [{name: a, kind: em_tracker, instrument: wire}, {name: b, kind: em_tracker, instrument: tube}]\n"));
  session.step(5);
  EXPECT_TRUE(session.observe().sensors().reading(0).valid);
  EXPECT_FALSE(session.observe().sensors().reading(1).valid);
}

TEST(RobotHardware, ImpossibleFaultsOfCallersAreRefused)
{
  Session session(tubeWith({}));
  EXPECT_THROW(session.addFault({1, robot::FaultAxis::kInsertion, robot::FaultKind::kStuck}), std::invalid_argument);
  EXPECT_THROW(session.addFault({0, robot::FaultAxis::kInsertion, robot::FaultKind::kSlipping, 2.0}),
               std::invalid_argument);
  EXPECT_THROW(session.removeFaults(-1, robot::FaultAxis::kInsertion), std::invalid_argument);
  EXPECT_TRUE(session.faults().empty());
}

}  // namespace
}  // namespace endovascular_sim::session
