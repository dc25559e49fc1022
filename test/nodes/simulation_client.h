#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "common/hash.h"
#include "drive/command_file.h"
#include "drive/joint_command.h"
#include "endovascular_sim/StateFile.h"
#include "endovascular_sim/StepSimulation.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"

namespace endovascular_sim
{

/** Client of the services below simulation/. */
class SimulationClient
{
public:
  SimulationClient() : step_(node_.serviceClient<StepSimulation>(nodes::names::kSimulationStep, true)) {}

  static bool waitForServices() { return ros::service::waitForService(nodes::names::kSimulationStep, 90000); }

  /** Calls simulation/step over a persistent connection. */
  StepSimulation::Response step(std::uint32_t steps, std::vector<InstrumentCommand> commands = {})
  {
    StepSimulation call;
    call.request.steps = steps;
    call.request.commands = std::move(commands);
    if (!step_.isValid())
      step_ = node_.serviceClient<StepSimulation>(nodes::names::kSimulationStep, true);
    EXPECT_TRUE(step_.call(call));
    return call.response;
  }

  /** Calls pause, resume, reset or session/stop. */
  std_srvs::Trigger::Response trigger(const std::string& name)
  {
    std_srvs::Trigger call;
    EXPECT_TRUE(ros::service::call(node_.resolveName(name), call)) << name;
    return call.response;
  }

  /** Calls save_state or load_state. */
  StateFile::Response file(const std::string& name, const std::string& path)
  {
    StateFile call;
    call.request.file = path;
    EXPECT_TRUE(ros::service::call(node_.resolveName(name), call)) << name;
    return call.response;
  }

private:
  ros::NodeHandle node_;
  ros::ServiceClient step_;
};

/** Command with unnamed joints, as a row of a file of commands. */
inline InstrumentCommand commandOf(const drive::TimedCommand& row)
{
  InstrumentCommand command;
  command.instrument = row.instrument;
  command.command = row.word;
  if (row.word == "servo_jv")
    command.joints.velocity = row.values;
  else if (row.word == "servo_jf")
    command.joints.effort = row.values;
  else
    command.joints.position = row.values;
  return command;
}

/** Trajectory hash of `simulate --commands`, 16 hexadecimal digits. */
inline std::string hashOfSimulate(const std::string& scene, const std::string& commands, double seconds)
{
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("simulate_" + std::to_string(getpid()));
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").parent_path().string() + "/simulate";
  const std::string line = program + " " + scene + " --no-plots --quiet --commands " + commands + " --seconds " +
                           std::to_string(seconds) + " --out " + folder.string();
  EXPECT_EQ(std::system(line.c_str()), 0) << line;
  std::ifstream file(folder / "result.json");
  const std::string hash = nlohmann::json::parse(file).at("trajectory_hash");
  std::filesystem::remove_all(folder);
  return hash;
}

/** Replays the bag of a recording, and expects that every step is there and equal.
 *  @return trajectory hash at its end */
inline std::string replayedHash(const std::string& bag)
{
  try
  {
    const nodes::SessionBag recording = nodes::readSessionBag(bag);
    nodes::RecordedSimulation session(recording, bag);
    const nodes::ReplayOutcome outcome = nodes::replay(recording, session, false);
    EXPECT_GT(outcome.compared, 0U) << bag;
    EXPECT_EQ(outcome.compared, outcome.steps) << bag;
    EXPECT_EQ(outcome.different, 0U) << bag;
    EXPECT_EQ(outcome.incomplete, "") << bag;
    return Hash64::toHex(session.simulation().trajectoryHash());
  }
  catch (const InputError& error)
  {
    ADD_FAILURE() << error.what();
    return "";
  }
}

}  // namespace endovascular_sim
