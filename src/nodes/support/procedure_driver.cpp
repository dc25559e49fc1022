#include "nodes/support/procedure_driver.h"

#include "nodes/support/names.h"

namespace endovascular_sim::nodes
{

ProcedureDriver::ProcedureDriver(ros::NodeHandle& node, const session::Scene& scene, const vessel::CentrelineTree& tree,
                                 const Eigen::Vector3d& entry)
  : operator_(scene, tree, entry), publisher_(node.advertise<ProcedureStep>(names::kProcedureStep, 100, true))
{
}

const std::vector<session::HandCommand>& ProcedureDriver::next(const session::Simulation& simulation)
{
  const std::vector<session::HandCommand>& commands = operator_.next(simulation);
  tell(simulation);
  return commands;
}

void ProcedureDriver::tell(const session::Simulation& simulation)
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

procedure::StepRecord fromMessage(const ProcedureStep& message)
{
  procedure::StepRecord record;
  record.name = message.name;
  record.phase = message.phase;
  record.begin = message.begin;
  record.end = message.time;
  record.retries = static_cast<int>(message.new_tries);
  record.wrong_branches = static_cast<int>(message.wrong_branches);
  record.outcome = static_cast<procedure::Progress>(message.outcome);
  return record;
}

}  // namespace endovascular_sim::nodes
