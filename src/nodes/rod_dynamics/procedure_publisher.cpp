#include "nodes/rod_dynamics/procedure_publisher.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
  messages_ = ProcedureMessages();
  begun_ = 0;
  is_over_ = false;
  view_.clear();
}

/** Publishes the records that have changed. At the scene's last step the newest record is published in any case, with
 * the time of its last observation. */
void ProcedurePublisher::publishChanges(const procedure::Operator& scripted, std::uint64_t steps, ros::Time now)
{
  for (ProcedureStep& message : messages_.changes(scripted, steps, steps + 1 == last_step_))
  {
    message.header.stamp = now;
    publish(scripted, message);
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

void ProcedurePublisher::publish(const procedure::Operator& scripted, const ProcedureStep& message)
{
  if (message.begun != begun_)
    ROS_INFO("procedure step %u: %s", message.begun, message.name.c_str());
  begun_ = message.begun;
  publisher_.publish(message);
  const bool was_over =
      std::exchange(is_over_, !message.failure.empty() || scripted.progress() == procedure::Progress::kDone);
  if (was_over || !is_over_)
    return;
  if (!message.failure.empty())
    ROS_ERROR("the procedure failed: %s", message.failure.c_str());
  else
    ROS_INFO("the procedure is complete after %.1f s", message.time);
}

}  // namespace endovascular_sim::nodes
