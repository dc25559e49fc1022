#include "nodes/rod_dynamics/procedure_driver.h"

#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

ProcedureDriver::ProcedureDriver(ros::NodeHandle& node, const scene::Scene& scene, const vessel::CentrelineTree& tree,
                                 const Eigen::Vector3d& entry)
  : operator_(scene, tree, entry), publisher_(node.advertise<ProcedureStep>(names::kProcedureStep, 100, true))
{
}

const std::vector<simulation::HandCommand>& ProcedureDriver::next(const simulation::Simulation& simulation)
{
  const std::vector<simulation::HandCommand>& commands = operator_.next(simulation);
  publishProgress(simulation);
  return commands;
}

void ProcedureDriver::publishProgress(const simulation::Simulation& simulation)
{
  const procedure::StepRecord& record = operator_.records().back();
  const auto begun = static_cast<std::uint32_t>(operator_.records().size());
  const auto outcome = static_cast<std::uint8_t>(record.outcome);
  const bool is_new = begun != published_.begun;
  if (!is_new && outcome == published_.outcome && static_cast<std::uint32_t>(record.retries) == published_.new_tries)
    return;
  published_.header.stamp = ros::Time::now();
  published_.step = simulation.steps();
  published_.time = simulation.time();
  published_.begun = begun;
  published_.phase = record.phase;
  published_.name = record.name;
  published_.begin = record.begin;
  published_.new_tries = static_cast<std::uint32_t>(record.retries);
  published_.wrong_branches = static_cast<std::uint32_t>(record.wrong_branches);
  published_.outcome = outcome;
  published_.failure = operator_.failure();
  publisher_.publish(published_);
  if (is_new)
    ROS_INFO("procedure step %u: %s", begun, record.name.c_str());
  if (!published_.failure.empty())
    ROS_ERROR("the procedure failed: %s", published_.failure.c_str());
  else if (operator_.progress() == procedure::Progress::kDone)
    ROS_INFO("the procedure is complete after %.1f s", published_.time);
}

}  // namespace endovascular_sim::nodes
