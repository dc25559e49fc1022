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
  tell(simulation);
  return commands;
}

void ProcedureDriver::tell(const simulation::Simulation& simulation)
{
  const procedure::StepRecord& record = operator_.records().back();
  const auto begun = static_cast<std::uint32_t>(operator_.records().size());
  const auto outcome = static_cast<std::uint8_t>(record.outcome);
  const bool is_new = begun != told_.begun;
  if (!is_new && outcome == told_.outcome && static_cast<std::uint32_t>(record.retries) == told_.new_tries)
    return;
  told_.header.stamp = ros::Time::now();
  told_.step = simulation.steps();
  told_.time = simulation.time();
  told_.begun = begun;
  told_.phase = record.phase;
  told_.name = record.name;
  told_.begin = record.begin;
  told_.new_tries = static_cast<std::uint32_t>(record.retries);
  told_.wrong_branches = static_cast<std::uint32_t>(record.wrong_branches);
  told_.outcome = outcome;
  told_.failure = operator_.failure();
  publisher_.publish(told_);
  if (is_new)
    ROS_INFO("rod_dynamics: step %u: %s", begun, record.name.c_str());
  if (!told_.failure.empty())
    ROS_ERROR("rod_dynamics: the procedure failed: %s", told_.failure.c_str());
  else if (operator_.progress() == procedure::Progress::kDone)
    ROS_INFO("rod_dynamics: the procedure is done after %.1f s", told_.time);
}

}  // namespace endovascular_sim::nodes
