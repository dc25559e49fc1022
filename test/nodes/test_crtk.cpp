#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <crtk_msgs/OperatingState.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "contact/detector.h"
#include "endovascular_sim/SessionSample.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"
#include "scene/scene_vessel.h"
#include "simulation/replay_source.h"
#include "simulation/simulation.h"
#include "test/nodes/crtk_client.h"

namespace endovascular_sim
{
namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Joints efforts(std::vector<double> values)
{
  Joints message;
  message.effort = std::move(values);
  return message;
}

/** Client of the wire. */
class Client : public CrtkClient
{
public:
  Client() : CrtkClient("instruments/wire/", "rod_dynamics")
  {
    recorder_.subscribe<SessionSample>(nodes::names::kSessionSample, [](const auto&) {});
  }

  /** Brings the instrument to 30 mm, enabled, homed and without a driver. The fingers may have slipped before. */
  bool reset()
  {
    if (!enable())
      return false;
    const Joints commanded = setpoint();
    if (commanded.position.empty() || !std::isfinite(insertion()))
      return false;
    send("move_jp", positions({commanded.position[0] - insertion() + kReset, 0.0}));
    return waitUntil(60.0, [this] { return std::abs(insertion() - kReset) < 1e-3 && !state().is_busy; }) && run(0.25);
  }

  std::map<std::uint64_t, Joints> measurements() const { return all("instruments/wire/measured_js"); }
  Joints measured() const { return newest("instruments/wire/measured_js"); }
  Joints setpoint() const { return newest("instruments/wire/setpoint_js"); }
  Joints goal() const { return newest("instruments/wire/goal_js"); }
  double insertion() const { return position("instruments/wire/measured_js", 0); }

private:
  static constexpr double kReset = 0.03;  ///< insertion after reset() [m]

  TopicObserver recorder_;
};

/** Process that publishes to a topic of the wire at 50 Hz, as another client. */
class OtherClient
{
public:
  OtherClient(const std::string& input, const std::string& joints) : process_(fork())
  {
    const std::string topic = "/instruments/wire/" + input;
    if (process_ != 0)
      return;
    execlp("rostopic", "rostopic", "pub", "-r", "50", topic.c_str(), "sensor_msgs/JointState", joints.c_str(), nullptr);
    _exit(1);
  }
  ~OtherClient() { kill(); }

  /** Ends the process without a chance to say so. */
  void kill()
  {
    if (process_ <= 0)
      return;
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }

private:
  pid_t process_;
};

class Crtk : public testing::Test
{
protected:
  static void SetUpTestSuite() { client_ = std::make_unique<Client>(); }
  static void TearDownTestSuite() { client_.reset(); }
  void SetUp() override { ASSERT_TRUE(client_->reset()) << client_->state().state << " " << client_->reason(); }

  static std::unique_ptr<Client> client_;
};

std::unique_ptr<Client> Crtk::client_;

TEST_F(Crtk, AStockClientDrivesAnInstrument)
{
  client_->command("enable");
  ASSERT_TRUE(waitUntil(10.0, [] { return client_->state().state == "ENABLED"; }));
  const double start = client_->insertion();
  double goal = start;
  EXPECT_TRUE(client_->run(0.5,
                           [&]
                           {
                             goal = std::min(goal + 2e-4, start + 0.01);
                             client_->send("servo_jp", positions({goal, 0.3}));
                           }));
  EXPECT_FALSE(client_->state().is_busy) << "a stream is no move";
  EXPECT_NEAR(client_->insertion(), goal, 1e-4);

  const std::uint64_t busy = client_->busyStates();
  client_->send("move_jp", positions({0.05, 1.0}));
  ASSERT_TRUE(waitUntil(10.0, [&] { return client_->busyStates() > busy; })) << "busy";
  ASSERT_TRUE(waitUntil(30.0, [&] { return !client_->state().is_busy; })) << "not busy";
  ASSERT_TRUE(client_->run(0.05));
  EXPECT_NEAR(client_->insertion(), 0.05, 1e-4);
  EXPECT_NEAR(client_->measured().position.at(1), 1.0, 1e-6);
  EXPECT_EQ(client_->measured().header.frame_id, "introducer");
  EXPECT_NEAR(client_->setpoint().position.at(0), 0.05, 1e-12);
  EXPECT_NEAR(client_->goal().position.at(0), 0.05, 1e-12);
  EXPECT_NEAR(client_->tip().pose.position.z, 0.05, 2e-3) << "in the straight piece";
  EXPECT_EQ(client_->tip().header.frame_id, "patient");
}

TEST_F(Crtk, EveryModeMovesTheInstrument)
{
  double before = client_->insertion();
  ASSERT_TRUE(client_->run(0.5, [] { client_->send("servo_jr", positions({1e-4})); }));
  EXPECT_GT(client_->insertion(), before + 2e-4);
  before = client_->insertion();
  ASSERT_TRUE(client_->run(0.5, [] { client_->send("servo_jv", velocities({0.02, 0.5})); }));
  EXPECT_NEAR(client_->insertion() - before, 0.01, 3e-3);
  EXPECT_NEAR(client_->measured().velocity.at(0), 0.02, 5e-3);
  before = client_->insertion();
  ASSERT_TRUE(client_->run(0.5, [] { client_->send("servo_jf", efforts({0.3})); }));
  EXPECT_GT(client_->insertion(), before + 1e-3);
  before = client_->insertion();
  client_->send("move_jr", positions({-0.005}));
  ASSERT_TRUE(client_->run(0.5));
  EXPECT_NEAR(client_->insertion() - before, -0.005, 1e-3);
}

TEST_F(Crtk, AnOldVelocityEnds)
{
  ASSERT_TRUE(client_->run(0.3, [] { client_->send("servo_jv", velocities({0.02})); }));
  ASSERT_TRUE(client_->run(0.4));
  const double rest = client_->insertion();
  ASSERT_TRUE(client_->run(0.3));
  EXPECT_EQ(client_->insertion(), rest);
}

TEST_F(Crtk, MeasuredIsTheInstrumentAtAStopAndAtTheEndOfTheWire)
{
  const double commanded = client_->setpoint().position.at(0) - 0.08;
  client_->send("move_jp", positions({commanded}));
  ASSERT_TRUE(client_->run(1.5));
  EXPECT_NEAR(client_->insertion(), 0.0, 1e-6) << "at the introducer";
  EXPECT_NEAR(client_->setpoint().position.at(0), 0.0, 1e-6) << "the setpoint waits there";
  client_->send("move_jp", positions({0.3}));
  ASSERT_TRUE(client_->run(4.5));
  EXPECT_LT(client_->insertion(), 0.29) << "the end of the wire, or the fingers slip";
  EXPECT_LE(client_->setpoint().position.at(0), 0.3);
  EXPECT_GE(client_->setpoint().position.at(0), client_->insertion() - 1e-6);
  EXPECT_GT(std::abs(client_->wallForce().wrench.force.x) + std::abs(client_->wallForce().wrench.force.y), 0.0);
}

TEST_F(Crtk, HoldEndsAMove)
{
  client_->send("move_jp", positions({0.2}));
  ASSERT_TRUE(client_->run(0.5));
  client_->word("hold");
  ASSERT_TRUE(waitUntil(10.0, [] { return !client_->state().is_busy; }));
  ASSERT_TRUE(client_->run(0.5));
  const double held = client_->setpoint().position.at(0);
  EXPECT_LT(held, 0.15);
  ASSERT_TRUE(client_->run(0.5));
  EXPECT_EQ(client_->setpoint().position.at(0), held);
  EXPECT_EQ(client_->state().state, "ENABLED");
}

TEST_F(Crtk, FreeLetsTheWireRelax)
{
  client_->send("move_jp", positions({client_->setpoint().position.at(0) + 0.12}));
  ASSERT_TRUE(client_->run(2.5));
  const double force = client_->measured().effort.at(0);
  ASSERT_GT(force, 0.005) << "friction in the bend";
  client_->word("free");
  ASSERT_TRUE(client_->run(2.0));
  EXPECT_LT(std::abs(client_->measured().effort.at(0)), 0.5 * force);
  client_->word("hold");
}

TEST_F(Crtk, AnInstrumentThatWaitsAtAStopForASecondIsAWarningWithItsReason)
{
  EXPECT_EQ(client_->reason(), "");
  ASSERT_TRUE(client_->run(2.0, [] { client_->send("servo_jv", velocities({-0.1})); }))
      << "at the introducer after 0.3 s";
  EXPECT_NE(client_->reason().find("waits at a stop"), std::string::npos) << client_->reason();
  EXPECT_EQ(client_->state().state, "ENABLED");
  EXPECT_TRUE(waitUntil(10.0,
                        []
                        {
                          client_->send("servo_jv", velocities({-0.1}));
                          return client_->diagnostics().find("waits at a stop") != std::string::npos;
                        }));
  ASSERT_TRUE(client_->run(1.8, [] { client_->send("servo_jv", velocities({0.02})); }));
  EXPECT_EQ(client_->reason(), "") << "the instrument moves again";
}

TEST_F(Crtk, ACommandedPauseEndsByResumeOnly)
{
  client_->command("pause");
  ASSERT_TRUE(waitUntil(10.0, [] { return client_->state().state == "PAUSED"; }));
  EXPECT_NE(client_->reason().find("paused by"), std::string::npos);
  const double held = client_->insertion();
  ASSERT_TRUE(client_->run(0.5, [] { client_->send("servo_jv", velocities({0.02})); }));
  EXPECT_EQ(client_->insertion(), held);
  client_->command("enable");
  ASSERT_TRUE(client_->run(0.2));
  EXPECT_EQ(client_->state().state, "PAUSED");
  client_->command("resume");
  ASSERT_TRUE(waitUntil(10.0, [] { return client_->state().state == "ENABLED"; }));
  ASSERT_TRUE(client_->run(0.5, [] { client_->send("servo_jv", velocities({0.02})); }));
  EXPECT_GT(client_->insertion(), held + 5e-3);
}

TEST_F(Crtk, AnotherClientIsRefusedUntilTheDriverIsSilent)
{
  OtherClient other("servo_jv", "{velocity: [0.01, 0.0]}");
  const double start = client_->insertion();
  ASSERT_TRUE(waitUntil(60.0, [&] { return client_->insertion() > start + 2e-3; })) << "the other client drives";
  client_->send("servo_jv", velocities({-0.01}));
  ASSERT_TRUE(waitUntil(10.0,
                        []
                        {
                          const std::string text = client_->diagnostics();
                          return text.find("another client drives: 0") == std::string::npos &&
                                 text.find("drives the instrument") != std::string::npos;
                        }))
      << client_->diagnostics();
  other.kill();
  ASSERT_TRUE(client_->run(0.5));
  const double rest = client_->insertion();
  ASSERT_TRUE(client_->run(0.3));
  EXPECT_EQ(client_->insertion(), rest) << "the velocity of a killed client ends";
  ASSERT_TRUE(client_->run(0.5, [] { client_->send("servo_jv", velocities({-0.01})); }));
  EXPECT_LT(client_->insertion(), rest - 1e-3);
}

TEST_F(Crtk, NoMessageHurts)
{
  std::mt19937 random(11);
  const std::vector<double> values = {kNan, kInfinity, -kInfinity, 1e300, -1e300, 0.0, 0.05, -0.3, 50.0};
  const std::vector<std::string> names = {"insertion", "rotation", "pressure", "elbow", ""};
  const std::vector<std::string> inputs = {"servo_jp", "servo_jr", "servo_jv", "servo_jf", "move_jp", "move_jr"};
  const auto garbage = [&]
  {
    Joints joints;
    for (std::vector<double>* list : {&joints.position, &joints.velocity, &joints.effort})
      for (std::size_t k = random() % 5; k > 0; --k)
        list->push_back(values[random() % values.size()]);
    for (std::size_t k = random() % 4; k > 0; --k)
      joints.name.push_back(names[random() % names.size()]);
    return joints;
  };
  for (int round = 0; round < 5; ++round)
  {
    ASSERT_TRUE(client_->run(1.0,
                             [&]
                             {
                               for (int k = 0; k < 20; ++k)
                                 client_->send(inputs[random() % inputs.size()], garbage());
                               if (random() % 20 == 0)
                                 client_->command(random() % 2 == 0 ? "pause" : "nonsense");
                             }));
    client_->command("disable");
    client_->command("enable");
    ASSERT_TRUE(waitUntil(10.0, [] { return client_->state().state == "ENABLED"; }));
    const double before = client_->insertion();
    ASSERT_TRUE(std::isfinite(before));
    const double velocity = before > 0.05 ? -0.02 : 0.02;
    ASSERT_TRUE(client_->run(1.0, [&] { client_->send("servo_jv", velocities({velocity, 0.0})); }));
    EXPECT_GT((client_->insertion() - before) / velocity, 0.3) << client_->diagnostics();
  }
}

TEST_F(Crtk, ATopicThatNobodyReadsIsNamedWithTheRightOne)
{
  ros::NodeHandle node;
  const ros::Publisher wrong = node.advertise<Joints>("instruments/wyre/servo_jp", 1);
  const ros::Publisher unsupported = node.advertise<Joints>("instruments/wire/interpolate_jp", 1);
  EXPECT_TRUE(waitUntil(20.0,
                        []
                        {
                          const std::string text = client_->diagnostics();
                          return text.find("publish to /instruments/wire/servo_jp") != std::string::npos &&
                                 text.find("no input 'interpolate_jp'") != std::string::npos;
                        }))
      << client_->diagnostics();
}

/** Last: the steps of all tests above are simulated again. */
TEST_F(Crtk, Z_AReplayEqualsEveryStepAndMeasuredIsTheSolversPosition)
{
  const scene::Scene scene = nodes::sceneFromParameters(ros::NodeHandle());
  const std::map<std::uint64_t, Joints> measurements = client_->measurements();
  const std::map<std::uint64_t, DriveApplied> steps = client_->steps();
  const vessel::Vessel vessel =
      scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired);
  contact::Detector detector(vessel.mesh, scene::wallLaw(*scene.vessel));
  simulation::ReplayContactSource source(detector);
  simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &source,
                                    &vessel.centreline);
  std::uint64_t compared = 0;
  for (const auto& [step, applied] : steps)
  {
    ASSERT_EQ(step, simulation.steps()) << "every step is recorded";
    source.setFirstStalePass(applied.first_stale_pass);
    simulation.step({applied.insertion.at(0), applied.rotation.at(0)});
    ASSERT_EQ(applied.state_hash, simulation.stateHash()) << "step " << step;
    const auto measured = measurements.find(applied.header.stamp.toNSec());
    if (measured == measurements.end())
      continue;
    ++compared;
    ASSERT_NEAR(measured->second.position.at(0), simulation.hand(0).insertion, 1e-9) << "step " << step;
    ASSERT_NEAR(measured->second.position.at(1), simulation.hand(0).rotation, 1e-9) << "step " << step;
    ASSERT_NEAR(measured->second.effort.at(0), simulation.hand(0).force, 1e-9) << "step " << step;
  }
  EXPECT_GT(compared, steps.size() / 2);
}

}  // namespace
}  // namespace endovascular_sim
