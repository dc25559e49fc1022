#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "endovascular_sim/DriveApplied.h"
#include "nodes/runtime/ros_names.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{
namespace
{

using Command = sensor_msgs::JointState;

constexpr std::size_t kInstruments = 2;  ///< wire and stent system of test/data/robot_instruments.yaml
constexpr std::array<const char*, kInstruments> kNames = {"wire", "stent_system"};
constexpr double kForceLimit = 3.0;  ///< of both drives in this scene [N]
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Command commandOf(std::vector<std::string> joints, std::vector<double> positions)
{
  Command command;
  command.header.stamp = ros::Time::now();
  command.name = std::move(joints);
  command.position = std::move(positions);
  return command;
}

Command commandOf(double insertion, double rotation)
{
  return commandOf({"insertion", "rotation"}, {insertion, rotation});
}

/** Robot that holds both instruments with correct commands, and observes the simulation. */
class Robot
{
public:
  Robot()
  {
    for (std::size_t k = 0; k < kInstruments; ++k)
    {
      topics_[k] = node_.resolveName(nodes::names::kInstruments + std::string(kNames[k]));
      publishers_[k] = node_.advertise<Command>(topics_[k] + nodes::names::kServoJp, 20000);
    }
    observer_.subscribe<DriveApplied>(nodes::names::kDriveApplied, [this](const DriveApplied& step) { receive(step); });
    observer_.subscribe<diagnostic_msgs::DiagnosticArray>(
        nodes::names::kDiagnostics, [this](const diagnostic_msgs::DiagnosticArray& message) { receive(message); });
  }

  /** True when the simulation receives the commands of both instruments. */
  bool isConnected() const
  {
    return std::all_of(publishers_.begin(), publishers_.end(),
                       [](const ros::Publisher& publisher) { return publisher.getNumSubscribers() > 0; });
  }

  void send(std::size_t instrument, const Command& command) { publishers_[instrument].publish(command); }

  /** Sends the correct commands of both instruments once. */
  void hold()
  {
    for (std::size_t k = 0; k < kInstruments; ++k)
      send(k, commandOf(kHeld[k], kTurned));
  }

  /** Holds until a condition is true. @return false when it was not within 30 s */
  bool holdUntil(const std::function<bool()>& condition)
  {
    return waitUntil(30.0,
                     [&]
                     {
                       hold();
                       return condition();
                     });
  }

  /** True when the last step has the correct commands of both instruments. */
  bool isHeld() const { return deviation() == 0.0; }

  /** Largest difference of the last step from the correct commands [m], [rad], [Pa]. */
  double deviation() const { return observer_.copy(deviation_); }

  /** Begins a new record of the largest deviation and the largest force. */
  void beginRecord()
  {
    const std::lock_guard<std::mutex> lock(observer_.mutex());
    largest_deviation_ = largest_force_ = 0.0;
  }

  double largestDeviation() const { return observer_.copy(largest_deviation_); }
  double largestForce() const { return observer_.copy(largest_force_); }
  double largestSpeed() const { return observer_.copy(largest_speed_); }
  std::uint64_t steps() const { return observer_.copy(steps_); }

  /** Holds for a number of steps. @return false when they did not happen within 30 s */
  bool holdFor(std::uint64_t steps)
  {
    const std::uint64_t end = this->steps() + steps;
    return holdUntil([&] { return this->steps() >= end; });
  }

  /** Waits without a command for a number of steps. */
  bool pauseFor(std::uint64_t steps) const
  {
    const std::uint64_t end = this->steps() + steps;
    return waitUntil(30.0, [&] { return this->steps() >= end; });
  }

  /** Number in the diagnostics, e.g. "rejected, jumps", of an instrument. */
  std::uint64_t count(std::size_t instrument, const std::string& key) const
  {
    const std::lock_guard<std::mutex> lock(observer_.mutex());
    const auto value = values_.find(topics_[instrument] + ": " + key);
    return value == values_.end() ? 0 : std::strtoull(value->second.c_str(), nullptr, 10);
  }

  static constexpr std::array<double, kInstruments> kHeld = {0.04, 0.01};  ///< correct insertions [m]
  static constexpr double kTurned = 0.1;                                   ///< correct rotation of both [rad]

private:
  void receive(const DriveApplied& step)
  {
    deviation_ = 0.0;
    for (std::size_t k = 0; k < kInstruments; ++k)
    {
      deviation_ = std::max({deviation_, std::abs(step.insertion.at(k) - kHeld[k]),
                             std::abs(step.rotation.at(k) - kTurned), std::abs(step.pressure.at(k))});
      largest_force_ = std::max(largest_force_, std::abs(step.hand_force.at(k)));
    }
    largest_deviation_ = std::max(largest_deviation_, deviation_);
    if (steps_ > 0 && step.step == steps_)
      largest_speed_ = std::max(largest_speed_, std::abs(step.insertion[0] - insertion_) / 1e-3);
    insertion_ = step.insertion[0];
    steps_ = step.step + 1;
  }

  void receive(const diagnostic_msgs::DiagnosticArray& message)
  {
    for (const diagnostic_msgs::DiagnosticStatus& status : message.status)
      for (const diagnostic_msgs::KeyValue& value : status.values)
        values_[value.key] = value.value;
  }

  ros::NodeHandle node_;
  std::uint64_t steps_ = 0;
  double deviation_ = kInfinity;
  double largest_deviation_ = 0.0;
  double largest_force_ = 0.0;
  double largest_speed_ = 0.0;  ///< of the wire's command [m/s]
  double insertion_ = 0.0;
  std::map<std::string, std::string> values_;
  std::array<std::string, kInstruments> topics_;
  std::array<ros::Publisher, kInstruments> publishers_;
  TopicObserver observer_;  ///< last, so that it ends before the data that it takes over
};

constexpr std::array<double, kInstruments> Robot::kHeld;

/** Kind of command, sent between correct ones. */
struct Kind
{
  std::string name;
  std::size_t instrument;
  Command command;
  std::string counter;  ///< key of /diagnostics that counts it
};

std::vector<Kind> kindsOfTheWire()
{
  const double x = Robot::kHeld[0];
  const double r = Robot::kTurned;
  const std::string not_finite = "rejected, not finite";
  const std::string range = "rejected, out of range";
  const std::string jump = "rejected, jumps";
  const std::string malformed = "rejected, malformed";
  const std::vector<std::string> joints = {"insertion", "rotation"};
  return {{"insertion NaN", 0, commandOf(kNan, r), not_finite},
          {"rotation NaN", 0, commandOf(x, kNan), not_finite},
          {"insertion infinite", 0, commandOf(kInfinity, r), not_finite},
          {"rotation -infinite", 0, commandOf(x, -kInfinity), not_finite},
          {"insertion 1e300", 0, commandOf(1e300, r), range},
          {"insertion -1e300", 0, commandOf(-1e300, r), range},
          {"millimetres instead of metres", 0, commandOf(1e3 * x, r), range},
          {"rotation 1e300", 0, commandOf(x, 1e300), range},
          {"jump of 100 mm", 0, commandOf(x + 0.1, r), jump},
          {"jump of 4 rad", 0, commandOf(x, r + 4.0), jump},
          {"wrong joint names", 0, commandOf({"joint_1", "joint_2"}, {x, r}), malformed},
          {"one joint missing", 0, commandOf({"insertion"}, {x}), malformed},
          {"joint repeated", 0, commandOf({"insertion", "insertion"}, {x, x}), malformed},
          {"joint repeated beside both", 0, commandOf({"insertion", "rotation", "rotation"}, {x, r, r}), malformed},
          {"empty", 0, commandOf(std::vector<std::string>(), {}), malformed},
          {"names without positions", 0, commandOf(joints, {}), malformed},
          {"four positions without names", 0, commandOf({}, {x, r, 0.0, 0.0}), malformed},
          {"fewer positions than names", 0, commandOf(joints, {x}), malformed}};
}

std::vector<Kind> kindsOfTheBalloon()
{
  const double x = Robot::kHeld[1];
  const double r = Robot::kTurned;
  const std::string malformed = "rejected, malformed";
  const std::vector<std::string> joints = {"insertion", "rotation", "pressure"};
  return {{"pressure NaN", 1, commandOf(joints, {x, r, kNan}), malformed},
          {"pressure infinite", 1, commandOf(joints, {x, r, kInfinity}), malformed},
          {"pressure below a vacuum", 1, commandOf(joints, {x, r, -2e5}), malformed},
          {"pressure 1e300", 1, commandOf(joints, {x, r, 1e300}), malformed},
          {"pressure repeated", 1, commandOf({"insertion", "rotation", "pressure", "pressure"}, {x, r, 1e5, 1e5}),
           malformed},
          {"jump of the other instrument's position", 1, commandOf(Robot::kHeld[0], r), "rejected, jumps"}};
}

/** Correct commands in unusual form. */
std::vector<Kind> harmlessKinds()
{
  const double x = Robot::kHeld[0];
  const double r = Robot::kTurned;
  const std::string accepted = "accepted commands";
  Command old = commandOf(x, r);
  old.header.stamp = ros::Time(1.0);
  Command future = commandOf(x, r);
  future.header.stamp += ros::Duration(3600.0);
  Command unstamped = commandOf(x, r);
  unstamped.header.stamp = ros::Time();
  Command derivatives = commandOf(x, r);
  derivatives.velocity = {kNan, 1e300};
  derivatives.effort = {kInfinity};
  return {
      {"old stamp", 0, old, accepted},
      {"future stamp", 0, future, accepted},
      {"no stamp", 0, unstamped, accepted},
      {"velocities and efforts that are not finite", 0, derivatives, accepted},
      {"positions without names", 0, commandOf({}, {x, r}), accepted},
      {"insertion alone without names", 0, commandOf({}, {x}), accepted},
      {"more positions than names", 0, commandOf({"insertion", "rotation"}, {x, r, 9.0}), accepted},
      {"joints in other order", 0, commandOf({"rotation", "insertion"}, {r, x}), accepted},
      {"pressure without a balloon", 0, commandOf({"insertion", "rotation", "pressure"}, {x, r, 1e6}), accepted},
      {"joints of another robot beside both", 0, commandOf({"elbow", "insertion", "rotation"}, {7.0, x, r}), accepted}};
}

class WrongCommands : public testing::Test
{
protected:
  void SetUp() override
  {
    ASSERT_TRUE(waitUntil(60.0, [&] { return robot_.steps() > 0; })) << "the simulation runs";
    ASSERT_TRUE(waitUntil(60.0, [&] { return robot_.isConnected(); })) << "the simulation takes commands";
    ASSERT_TRUE(robot_.holdUntil([&] { return robot_.isHeld(); }));
    ASSERT_TRUE(robot_.holdFor(50));
  }

  /** Sends each kind several times between correct commands. No step deviates from these. */
  void expectNoEffect(const std::vector<Kind>& kinds)
  {
    constexpr std::uint64_t repetitions = 5;
    for (const Kind& kind : kinds)
    {
      SCOPED_TRACE(kind.name);
      const std::uint64_t before = robot_.count(kind.instrument, kind.counter);
      const std::uint64_t step = robot_.steps();
      robot_.beginRecord();
      for (std::uint64_t k = 0; k < repetitions; ++k)
      {
        robot_.send(kind.instrument, kind.command);
        ASSERT_TRUE(robot_.holdFor(5)) << "the simulation continues";
      }
      EXPECT_TRUE(robot_.holdUntil([&] { return robot_.count(kind.instrument, kind.counter) >= before + repetitions; }))
          << "/diagnostics counts " << kind.counter;
      EXPECT_GT(robot_.steps(), step);
      EXPECT_EQ(robot_.largestDeviation(), 0.0);
      EXPECT_LE(robot_.largestForce(), kForceLimit);
    }
  }

  Robot robot_;
};

TEST_F(WrongCommands, OfAWireHaveNoEffectAndAreCounted)
{
  expectNoEffect(kindsOfTheWire());
}

TEST_F(WrongCommands, OfABalloonHaveNoEffectAndAreCounted)
{
  expectNoEffect(kindsOfTheBalloon());
}

TEST_F(WrongCommands, InFormOnlyAreAccepted)
{
  expectNoEffect(harmlessKinds());
}

TEST_F(WrongCommands, AsAFloodDoNotDelayTheSimulation)
{
  robot_.beginRecord();
  const std::uint64_t before = robot_.count(0, "rejected, not finite");
  const std::uint64_t step = robot_.steps();
  constexpr std::uint64_t flood = 10000;
  ros::WallRate rate(1000.0);
  for (std::uint64_t k = 0; k < flood; k += 10, rate.sleep())  // 10 kHz
  {
    for (int repetition = 0; repetition < 9; ++repetition)
      robot_.send(0, commandOf(kNan, 0.0));
    robot_.hold();
  }
  EXPECT_TRUE(robot_.holdUntil([&] { return robot_.count(0, "rejected, not finite") > before; }));
  EXPECT_GT(robot_.steps(), step);
  EXPECT_TRUE(robot_.holdUntil([&] { return robot_.isHeld(); }));
  EXPECT_LE(robot_.largestForce(), kForceLimit);
}

TEST_F(WrongCommands, OfASecondPublisherLeaveNothingBehind)
{
  ros::NodeHandle node;
  ros::Publisher second = node.advertise<Command>("instruments/wire/servo_jp", 1000);
  ASSERT_TRUE(waitUntil(10.0, [&] { return second.getNumSubscribers() > 0; }));
  robot_.beginRecord();
  const std::uint64_t rejected = robot_.count(0, "rejected, jumps");
  for (int k = 0; k < 100; ++k)
  {
    second.publish(commandOf(Robot::kHeld[0] + 0.15, 0.0));
    ASSERT_TRUE(robot_.holdFor(3));
  }
  EXPECT_EQ(robot_.largestDeviation(), 0.0) << "a distant second publisher has no effect";
  EXPECT_TRUE(robot_.holdUntil([&] { return robot_.count(0, "rejected, jumps") >= rejected + 100; }));
  for (int k = 0; k < 100; ++k)
  {
    second.publish(commandOf(Robot::kHeld[0] + 0.002, 0.0));
    ASSERT_TRUE(robot_.holdFor(3));
  }
  second.shutdown();
  EXPECT_TRUE(robot_.holdUntil([&] { return robot_.isHeld(); })) << "deviation " << robot_.deviation();
  EXPECT_LE(robot_.largestForce(), kForceLimit);
}

TEST_F(WrongCommands, AfterSilenceAreApproachedSlowlyAndCorrectedByTheNextOne)
{
  robot_.beginRecord();
  ASSERT_TRUE(robot_.pauseFor(400));
  robot_.send(0, commandOf(Robot::kHeld[0] + 0.2, Robot::kTurned));
  ASSERT_TRUE(robot_.pauseFor(50));
  ASSERT_GT(robot_.deviation(), 0.0) << "the first command after silence is approached";
  EXPECT_TRUE(robot_.holdUntil([&] { return robot_.isHeld(); })) << "deviation " << robot_.deviation();
  EXPECT_LE(robot_.largestSpeed(), 0.1 * (1.0 + 1e-6)) << "speed of an approach [m/s]";
  EXPECT_LE(robot_.largestForce(), kForceLimit);
}

}  // namespace
}  // namespace endovascular_sim
