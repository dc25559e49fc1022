#include "nodes/rod_dynamics/control/simulation_services.h"

#include <utility>

#include "common/error.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Executes an operation, and reports its outcome to the client and in the log. */
template <typename Response, typename Operation>
bool answer(const char* name, Response& response, const Operation& operation)
{
  try
  {
    response.message = operation();
    response.success = 1;
  }
  catch (const InputError& error)
  {
    response.message = error.what();
    response.success = 0;
    ROS_WARN("refused %s: %s", name, response.message.c_str());
  }
  return true;
}

}  // namespace

SimulationServices::SimulationServices(const ros::NodeHandle& node, Operations operations)
  : node_(node), operations_(std::move(operations))
{
  node_.setCallbackQueue(&queue_);
  addTrigger(names::kSimulationPause, operations_.pause);
  addTrigger(names::kSimulationResume, operations_.resume);
  addTrigger(names::kSimulationReset, operations_.reset);
  addFile(names::kSimulationSave, operations_.save_state);
  addFile(names::kSimulationLoad, operations_.load_state);
  const boost::function<bool(StepSimulation::Request&, StepSimulation::Response&)> step =
      [this](StepSimulation::Request& request, StepSimulation::Response& response)
  {
    operations_.step(request, response);
    return true;
  };
  servers_.push_back(node_.advertiseService(names::kSimulationStep, step));
}

void SimulationServices::addTrigger(const char* name, const std::function<std::string()>& operation)
{
  using Trigger = std_srvs::Trigger;
  const boost::function<bool(Trigger::Request&, Trigger::Response&)> call =
      [name, &operation](Trigger::Request& /*request*/, Trigger::Response& response)
  { return answer(name, response, operation); };
  servers_.push_back(node_.advertiseService(name, call));
}

void SimulationServices::addFile(const char* name, const std::function<std::string(const std::string&)>& operation)
{
  const boost::function<bool(StateFile::Request&, StateFile::Response&)> call =
      [name, &operation](StateFile::Request& request, StateFile::Response& response)
  { return answer(name, response, [&] { return operation(request.file); }); };
  servers_.push_back(node_.advertiseService(name, call));
}

void SimulationServices::serve(double seconds)
{
  queue_.callAvailable(ros::WallDuration(seconds));
}

}  // namespace endovascular_sim::nodes
