#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "endovascular_sim/SensorReading.h"
#include "endovascular_sim/SetFault.h"
#include "nodes/session/bag_records.h"
#include "session/session.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"

namespace endovascular_sim
{
namespace
{

constexpr std::uint32_t kSteps = 150;  ///< of one call; velocities are valid for drive.limits.time_out

const std::string kScene = TEST_DATA_DIR "/sensors_of_a_robot.yaml";
const std::vector<std::string> kSensors = {"tracker", "encoder", "force", "screen"};

/** Samples of all sensors as text with all bits, one line per delivery. */
using Lines = std::map<std::string, std::vector<std::string>>;

std::string lineOf(std::uint64_t delivered, std::uint64_t sequence, std::uint64_t step, bool valid,
                   const std::vector<double>& values)
{
  std::string line = std::to_string(delivered) + " " + std::to_string(sequence) + " " + std::to_string(step) +
                     (valid ? " valid" : " invalid");
  for (const double value : values)
  {
    char text[40];
    std::snprintf(text, sizeof text, " %a", value);
    line += text;
  }
  return line;
}

class SensorsOfTheGraph : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<SimulationClient>();
    ASSERT_TRUE(SimulationClient::waitForServices());
    for (const std::string& name : kSensors)
      subscribers_.push_back(ros::NodeHandle().subscribe<SensorReading>(
          nodes::names::kSensors + name, 10000,
          [name](const SensorReadingConstPtr& reading)
          {
            const std::lock_guard<std::mutex> lock(mutex_);
            lines_[name].push_back(lineOf(reading->delivered_step, reading->sequence, reading->step,
                                          reading->valid != 0, reading->values));
          }));
    ASSERT_TRUE(waitUntil(20.0,
                          []
                          {
                            for (const ros::Subscriber& subscriber : subscribers_)
                              if (subscriber.getNumPublishers() == 0)
                                return false;
                            return true;
                          }));
    ros::WallDuration(0.5).sleep();  // until the publisher knows of the subscribers
  }
  static void TearDownTestSuite()
  {
    subscribers_.clear();
    client_.reset();
  }

  static SetFault::Response setFault(const SetFault::Request& request)
  {
    SetFault call;
    call.request = request;
    EXPECT_TRUE(ros::service::call("instruments/wire/fault", call));
    return call.response;
  }

  static InstrumentCommand velocity() { return commandOf({0.0, "wire", "servo_jv", {0.03, 2.0}, 0}); }

  static std::size_t received()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::size_t count = 0;
    for (const auto& [name, lines] : lines_)
      count += lines.size();
    return count;
  }

  static Lines takeLines()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(lines_, Lines());
  }

  static std::unique_ptr<SimulationClient> client_;
  static std::vector<ros::Subscriber> subscribers_;
  static std::mutex mutex_;
  static Lines lines_;
  static Lines first_run_, second_run_;  ///< samples of the runs before and after the state was loaded
};

std::unique_ptr<SimulationClient> SensorsOfTheGraph::client_;
std::vector<ros::Subscriber> SensorsOfTheGraph::subscribers_;
std::mutex SensorsOfTheGraph::mutex_;
Lines SensorsOfTheGraph::lines_;
Lines SensorsOfTheGraph::first_run_;
Lines SensorsOfTheGraph::second_run_;

SetFault::Request slipping()
{
  SetFault::Request request;
  request.axis = "insertion";
  request.kind = "slipping";
  request.amount = 0.4;
  request.probability = 0.5;
  request.interval = 0.02;
  request.duration = 0.2;
  request.seed = 5;
  return request;
}

/** The same run in this process. */
class Reference
{
public:
  Reference() : session_(kScene, {}, settings()) {}

  void push()
  {
    EXPECT_TRUE(drive::give(session_.control(0), "test", "servo_jv", {}, {0.03, 2.0}));
    const simulation::Sensors& sensors = session_.observe().sensors();
    for (std::uint32_t k = 0; k < kSteps; ++k)
    {
      session_.step(1);
      for (std::size_t n = 0; n < sensors.size(); ++n)
        if (sensors.isNew(n))
          lines_[sensors.settings(n).name].push_back(lineOf(session_.observe().step(), sensors.reading(n).sequence,
                                                            sensors.reading(n).step, sensors.reading(n).valid,
                                                            sensors.reading(n).values));
    }
  }

  session::Session& session() { return session_; }
  const Lines& lines() const { return lines_; }

private:
  static session::SessionSettings settings()
  {
    session::SessionSettings settings;
    settings.clients = true;
    return settings;
  }

  session::Session session_;
  Lines lines_;
};

std::size_t countOf(const Lines& lines)
{
  std::size_t count = 0;
  for (const auto& [name, of_name] : lines)
    count += of_name.size();
  return count;
}

/** Folder of the Python package of this build; it may not exist. */
std::filesystem::path pythonPath()
{
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "python3" / "dist-packages";
}

/** Samples of the same run in Python. */
Lines linesOfPython()
{
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("sensors_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "run.py") << R"(
import sys
import endovascular_sim as evs
session = evs.World(sys.argv[1]).session(clients=True)
for call in range(4):
    if call == 2:
        session.add_fault("wire", "insertion", "slipping", 0.4, duration=0.2, probability=0.5, interval=0.02, seed=5)
    session.command("wire", "servo_jv", [0.03, 2.0])
    for _ in range(150):
        session.step()
        for name, reading in session.sensors.items():
            print(name, session.steps, reading.sequence, reading.step, "valid" if reading.valid else "invalid",
                  *(value.hex() for value in reading.values.tolist()))
)";
  const std::string command = "PYTHONPATH=" + pythonPath().string() + ":$PYTHONPATH /usr/bin/python3 " +
                              (folder / "run.py").string() + " " + kScene + " > " + (folder / "out").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  Lines lines;
  std::map<std::string, std::uint64_t> last;
  std::ifstream out(folder / "out");
  for (std::string line; std::getline(out, line);)
  {
    std::istringstream words(line);
    std::string name, valid;
    std::uint64_t delivered = 0, sequence = 0, step = 0;
    words >> name >> delivered >> sequence >> step >> valid;
    std::vector<double> values;
    for (std::string word; words >> word;)
      values.push_back(std::strtod(word.c_str(), nullptr));
    if (sequence != std::exchange(last[name], sequence))
      lines[name].push_back(lineOf(delivered, sequence, step, valid == "valid", values));
  }
  std::filesystem::remove_all(folder);
  return lines;
}

/** Samples of a recording. */
Lines linesOfBag(const std::string& file)
{
  Lines lines;
  const std::string damage = nodes::readBagMessages(
      file,
      [&lines](const nodes::BagMessage& message)
      {
        if (!message.is<SensorReading>())
          return;
        const auto reading = message.read<SensorReading>();
        lines[message.topic.substr(message.topic.rfind('/') + 1)].push_back(
            lineOf(reading->delivered_step, reading->sequence, reading->step, reading->valid != 0, reading->values));
      });
  EXPECT_EQ(damage, "");
  return lines;
}

// Must run first.
TEST_F(SensorsOfTheGraph, A_RefusedFaultsNameTheReasonAndChangeNothing)
{
  const auto refusal =
      [](const char* axis, const char* kind, double amount, double duration = 0.0, double probability = 0.0)
  {
    SetFault::Request request;
    request.axis = axis;
    request.kind = kind;
    request.amount = amount;
    request.duration = duration;
    request.probability = probability;
    const SetFault::Response response = setFault(request);
    EXPECT_FALSE(response.success);
    return response.message;
  };
  EXPECT_EQ(refusal("pressure", "stuck", 0.0), "axis is 'pressure'; must be insertion or rotation");
  EXPECT_NE(refusal("insertion", "sticky", 0.0).find("stuck, slipping, delayed, backlash or none"), std::string::npos);
  EXPECT_NE(refusal("insertion", "slipping", 2.0).find("share"), std::string::npos);
  EXPECT_NE(refusal("insertion", "delayed", std::nan("")).find("amount"), std::string::npos);
  EXPECT_NE(refusal("insertion", "stuck", 0.0, -1.0).find("duration"), std::string::npos);
  EXPECT_NE(refusal("insertion", "stuck", 0.0, 0.0, 3.0).find("probability"), std::string::npos);
}

TEST_F(SensorsOfTheGraph, B_ReadingsAndTrajectoryAreThoseOfASessionAndOfPython)
{
  Reference reference;
  Lines graph;
  for (int call = 0; call < 4; ++call)
  {
    if (call == 2)
    {
      const SetFault::Response answer = setFault(slipping());
      EXPECT_TRUE(answer.success) << answer.message;
      robot::FaultSettings fault;
      fault.kind = robot::FaultKind::kSlipping;
      fault.amount = 0.4;
      fault.start = reference.session().observe().time();
      fault.end = fault.start + 0.2;
      fault.probability = 0.5;
      fault.interval = 0.02;
      fault.seed = 5;
      reference.session().addFault(fault);
    }
    const StepSimulation::Response response = client_->step(kSteps, {velocity()});
    ASSERT_TRUE(response.success) << response.message;
    reference.push();
    EXPECT_EQ(response.trajectory_hash, reference.session().simulation().trajectoryHash()) << "call " << call;
  }
  EXPECT_GT(reference.session().faults().lag(0).insertion, 1e-4) << "slipped";
  ASSERT_TRUE(waitUntil(20.0, [&] { return received() >= countOf(reference.lines()); }));
  graph = takeLines();
  EXPECT_EQ(graph, reference.lines());
  first_run_ = graph;
#ifndef ENDOVASCULAR_SANITIZED  // an interpreter does not load a sanitised module
  if (std::filesystem::exists(pythonPath() / "endovascular_sim" / "env.py"))
  {
    EXPECT_EQ(linesOfPython(), reference.lines());
  }
#endif
}

TEST_F(SensorsOfTheGraph, C_ASavedStateContinuesWithTheSameReadings)
{
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("sensors_" + std::to_string(getpid()) + ".state");
  const StateFile::Response saved = client_->file("simulation/save_state", file);
  ASSERT_TRUE(saved.success) << saved.message;
  const auto push = []
  {
    takeLines();
    EXPECT_TRUE(client_->step(kSteps, {velocity()}).success);
    EXPECT_TRUE(waitUntil(20.0, [] { return received() >= kSteps; }));
    for (auto before = received() - 1; received() != before;)  // until no further ones come
    {
      before = received();
      ros::WallDuration(1.0).sleep();
    }
    return takeLines();
  };
  const Lines first = push();
  for (const auto& [name, lines] : first)
    first_run_[name].insert(first_run_[name].end(), lines.begin(), lines.end());
  const StateFile::Response loaded = client_->file("simulation/load_state", file);
  ASSERT_TRUE(loaded.success) << loaded.message;
  second_run_ = push();
  EXPECT_EQ(second_run_, first);
  std::filesystem::remove(file);
}

// Must run last.
TEST_F(SensorsOfTheGraph, D_TheRecordingReplaysWithoutItsFaultsAndHoldsTheReadings)
{
  const std_srvs::Trigger::Response stopped = client_->trigger("session/stop");
  ASSERT_TRUE(stopped.success) << stopped.message;
  const std::filesystem::path folder = std::filesystem::path(stopped.message).parent_path();
  const std::filesystem::path first = folder.filename().string().rfind("run_", 0) == 0 ? folder.parent_path() : folder;
  replayedHash(first / "session.bag");
  replayedHash(first / "run_2" / "session.bag");
  EXPECT_EQ(linesOfBag(first / "session.bag"), first_run_);
  EXPECT_EQ(linesOfBag(first / "run_2" / "session.bag"), second_run_);
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim
