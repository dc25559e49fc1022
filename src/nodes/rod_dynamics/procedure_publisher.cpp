#include "nodes/rod_dynamics/procedure_publisher.h"

#include <algorithm>
#include <cmath>

#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

ProcedurePublisher::ProcedurePublisher(ros::NodeHandle& node, const scene::Scene& scene)
  : last_step_(static_cast<std::uint64_t>(std::llround(scene.duration / scene.solver.time_step))),
    publisher_(node.advertise<ProcedureStep>(names::kProcedureStep, 100, true))
{
  const std::vector<scene::StepScene>& steps = scene.procedure->steps;
  if (scene.fluoroscopy && std::any_of(steps.begin(), steps.end(), [](const auto& step) { return !step.view.empty(); }))
    c_arm_ = node.advertise<CArm>(names::kCArmCommand, 1, true);
}

void ProcedurePublisher::reset()
{
  published_ = ProcedureStep();
  is_complete_ = false;
  view_.clear();
}

/** Publishes the records that have changed: the newest, and the previous one when it has ended. At the scene's last
 * step the newest record is published in any case, with the time of its last observation. */
void ProcedurePublisher::publishChanges(const procedure::Operator& scripted, std::uint64_t steps, ros::Time now)
{
  const std::vector<procedure::StepRecord>& records = scripted.records();
  const std::size_t newest = published_.begun == 0 ? 0 : published_.begun - 1;
  for (std::size_t k = newest; k < records.size(); ++k)
  {
    const bool is_new = k + 1 != published_.begun;
    const bool is_changed = static_cast<std::uint8_t>(records[k].outcome) != published_.outcome ||
                            static_cast<std::uint32_t>(records[k].retries) != published_.retries ||
                            static_cast<std::uint32_t>(records[k].wrong_branches) != published_.wrong_branches;
    if (is_new || is_changed || steps + 1 == last_step_)
      publish(scripted, k, steps, now);
    if (is_new)
      ROS_INFO("procedure step %zu: %s", k + 1, records[k].name.c_str());
  }
  publishView(scripted, now);
}

/** Commands the view of the present step if it is another one than before. */
void ProcedurePublisher::publishView(const procedure::Operator& scripted, ros::Time now)
{
  if (!c_arm_ || scripted.records().empty() || scripted.records().back().view == view_)
    return;
  view_ = scripted.records().back().view;
  if (view_.empty())
    return;
  CArm command;
  command.header.stamp = now;
  command.view = view_;
  c_arm_.publish(command);
}

void ProcedurePublisher::publish(const procedure::Operator& scripted, std::size_t record, std::uint64_t steps,
                                 ros::Time now)
{
  const bool was_over = !published_.failure.empty() || is_complete_;
  const procedure::StepRecord& step = scripted.records()[record];
  published_.header.stamp = now;
  published_.step = steps;
  published_.time = step.end;
  published_.begun = static_cast<std::uint32_t>(record + 1);
  published_.phase = step.phase;
  published_.name = step.name;
  published_.begin = step.begin;
  published_.retries = static_cast<std::uint32_t>(step.retries);
  published_.wrong_branches = static_cast<std::uint32_t>(step.wrong_branches);
  published_.outcome = static_cast<std::uint8_t>(step.outcome);
  published_.failure = scripted.failure();
  published_.hint = step.hint;
  published_.step_of_procedure = static_cast<std::uint32_t>(step.step + 1);
  published_.steps_of_procedure = static_cast<std::uint32_t>(scripted.steps());
  is_complete_ = scripted.progress() == procedure::Progress::kDone;
  publisher_.publish(published_);
  if (was_over)
    return;
  if (!published_.failure.empty())
    ROS_ERROR("the procedure failed: %s", published_.failure.c_str());
  else if (is_complete_)
    ROS_INFO("the procedure is complete after %.1f s", published_.time);
}

}  // namespace endovascular_sim::nodes
