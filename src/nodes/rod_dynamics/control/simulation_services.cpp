#include "nodes/rod_dynamics/control/simulation_services.h"

#include <utility>

#include "common/error.h"
#include "endovascular_sim/GoToStep.h"
#include "nodes/rod_dynamics/control/state_file.h"
#include "nodes/runtime/real_time.h"
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

SimulationServices::SimulationServices(const ros::NodeHandle& node, Operations operations, std::string state_folder)
  : node_(node), operations_(std::move(operations)), state_folder_(std::move(state_folder))
{
  node_.setCallbackQueue(&queue_);
  addTrigger(names::kSimulationPause, operations_.pause);
  addTrigger(names::kSimulationResume, operations_.resume);
  addTrigger(names::kSimulationReset, operations_.reset);
  addFile(names::kSimulationSave,
          [this](const std::string& file)
          {
            const std::string state = inSimulation(std::packaged_task<std::string()>(operations_.state));
            return writeStateFile(file, state, state_folder_);
          });
  addFile(
      names::kSimulationLoad,
      [this](const std::string& file)
      {
        const std::string state = readStateFile(file, state_folder_);
        return inSimulation(std::packaged_task<std::string()>([&] { return operations_.continue_from(state, file); }));
      });
  const boost::function<bool(StepSimulation::Request&, StepSimulation::Response&)> step =
      [this](StepSimulation::Request& request, StepSimulation::Response& response)
  {
    operations_.step(request, response);
    return true;
  };
  servers_.push_back(node_.advertiseService(names::kSimulationStep, step));
  const boost::function<bool(ContinueRecording::Request&, ContinueRecording::Response&)> continue_recording =
      [this](ContinueRecording::Request& /*request*/, ContinueRecording::Response& response)
  {
    operations_.continue_recording(response);
    return true;
  };
  servers_.push_back(node_.advertiseService(names::kContinueRecording, continue_recording));
  const boost::function<bool(GoToStep::Request&, GoToStep::Response&)> go_to_step =
      [this](GoToStep::Request& request, GoToStep::Response& response)
  { return answer(names::kGoToStep, response, [&] { return operations_.go_to_step(request.step); }); };
  servers_.push_back(node_.advertiseService(names::kGoToStep, go_to_step));
  if (operations_.inject)
    addInjections();
  file_spinner_.start();
}

SimulationServices::~SimulationServices()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_ended_ = true;
    tasks_.clear();
  }
  file_spinner_.stop();
}

void SimulationServices::addInjections()
{
  const boost::function<bool(InjectContrast::Request&, InjectContrast::Response&)> call =
      [this](InjectContrast::Request& request, InjectContrast::Response& response)
  { return answer(names::kInjectContrast, response, [&] { return operations_.inject(request); }); };
  servers_.push_back(node_.advertiseService(names::kInjectContrast, call));
}

void SimulationServices::addTrigger(const char* name, const std::function<std::string()>& operation)
{
  using Trigger = std_srvs::Trigger;
  const boost::function<bool(Trigger::Request&, Trigger::Response&)> call =
      [name, &operation](Trigger::Request& /*request*/, Trigger::Response& response)
  { return answer(name, response, operation); };
  servers_.push_back(node_.advertiseService(name, call));
}

/** @param operation executed in the thread of files, with ordinary scheduling */
void SimulationServices::addFile(const char* name, const std::function<std::string(const std::string&)>& operation)
{
  const boost::function<bool(StateFile::Request&, StateFile::Response&)> call =
      [name, operation](StateFile::Request& request, StateFile::Response& response)
  {
    leaveRealTime();
    return answer(name, response, [&] { return operation(request.file); });
  };
  ros::AdvertiseServiceOptions options;
  options.init<StateFile::Request, StateFile::Response>(name, call);
  options.callback_queue = &file_queue_;
  servers_.push_back(node_.advertiseService(options));
}

/** Executes work between two steps, and waits for it. @throws InputError as the work, and when the simulation ends */
std::string SimulationServices::inSimulation(std::packaged_task<std::string()> work)
{
  std::future<std::string> result = work.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!has_ended_)
      tasks_.push_back(std::move(work));
    else
      work = {};  // breaks its promise
  }
  try
  {
    return result.get();
  }
  catch (const std::future_error&)
  {
    throw InputError("rod_dynamics", "", "the simulation ends");
  }
}

/** Executes the work of the thread of files. */
void SimulationServices::work()
{
  std::unique_lock<std::mutex> lock(mutex_);
  while (!tasks_.empty())
  {
    std::packaged_task<std::string()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

void SimulationServices::serve(double seconds)
{
  work();
  queue_.callAvailable(ros::WallDuration(seconds));
}

}  // namespace endovascular_sim::nodes
