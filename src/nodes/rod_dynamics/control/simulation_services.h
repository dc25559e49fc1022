#pragma once

#include <functional>
#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include "endovascular_sim/StateFile.h"
#include "endovascular_sim/StepSimulation.h"

namespace endovascular_sim::nodes
{

/** Services below simulation/, executed in the thread of the simulation, between two steps. */
class SimulationServices
{
public:
  /** Operations that the services call. They return a message for the client, and throw InputError to refuse. */
  struct Operations
  {
    std::function<std::string()> pause, resume, reset;
    std::function<std::string(const std::string&file)> save_state, load_state;
    /** Fills the response, also for a refusal. */
    std::function<void(const StepSimulation::Request&, StepSimulation::Response&)> step;
  };

  SimulationServices(const ros::NodeHandle& node, Operations operations);

  /** Executes all calls that wait, the first of which may arrive within a time [s]. */
  void serve(double seconds);

private:
  void addTrigger(const char* name, const std::function<std::string()>& operation);
  void addFile(const char* name, const std::function<std::string(const std::string&)>& operation);

  ros::NodeHandle node_;
  ros::CallbackQueue queue_;
  Operations operations_;
  std::vector<ros::ServiceServer> servers_;  ///< last, so that they end before the members that their callbacks use
};

}  // namespace endovascular_sim::nodes
