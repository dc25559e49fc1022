#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include "endovascular_sim/ContinueRecording.h"
#include "endovascular_sim/InjectContrast.h"
#include "endovascular_sim/StateFile.h"
#include "endovascular_sim/StepSimulation.h"

namespace endovascular_sim::nodes
{

/** Services below simulation/ and procedure/, and contrast/inject, executed in the thread of the simulation, between
 * two steps. Files are read and written in a thread of their own: steps do not wait for a disk. */
class SimulationServices
{
public:
  /** Operations that the services call. They return a message for the client, and throw InputError to refuse. */
  struct Operations
  {
    std::function<std::string()> pause, resume, reset;
    std::function<std::string()> state;  ///< present state of the simulation
    /** Continues from a state. @param origin its file, for messages */
    std::function<std::string(const std::string& state, const std::string& origin)> continue_from;
    /** Returns to the beginning of a step of the procedure. @param step from 1; 0: the present one */
    std::function<std::string(std::uint32_t step)> go_to_step;
    /** Fills the response, also for a refusal. */
    std::function<void(const StepSimulation::Request&, StepSimulation::Response&)> step;
    /** Fills the response with the present state, from which a recording continues. */
    std::function<void(ContinueRecording::Response&)> continue_recording;
    /** Begins or ends an injection of contrast medium; empty in a scene without: no service. */
    std::function<std::string(const InjectContrast::Request&)> inject;
  };

  /** @param state_folder folder of all states; empty: any */
  SimulationServices(const ros::NodeHandle& node, Operations operations, std::string state_folder = "");
  ~SimulationServices();
  SimulationServices(const SimulationServices&) = delete;
  SimulationServices& operator=(const SimulationServices&) = delete;

  /** Executes all calls that wait, the first of which may arrive within a time [s]. */
  void serve(double seconds);

private:
  void addInjections();
  void addTrigger(const char* name, const std::function<std::string()>& operation);
  void addFile(const char* name, const std::function<std::string(const std::string&)>& operation);
  std::string inSimulation(std::packaged_task<std::string()> work);
  void work();

  ros::NodeHandle node_;
  ros::CallbackQueue queue_, file_queue_;
  Operations operations_;
  std::string state_folder_;
  std::mutex mutex_;                                     ///< guards the next two
  std::deque<std::packaged_task<std::string()>> tasks_;  ///< of the thread of files for that of the simulation
  bool has_ended_ = false;
  ros::AsyncSpinner file_spinner_{1, &file_queue_};
  std::vector<ros::ServiceServer> servers_;  ///< last, so that they end before the members that their callbacks use
};

}  // namespace endovascular_sim::nodes
