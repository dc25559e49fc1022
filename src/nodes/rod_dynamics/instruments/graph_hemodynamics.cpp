#include "nodes/rod_dynamics/instruments/graph_hemodynamics.h"

#include <cmath>
#include <mutex>

#include "common/text/format.h"
#include "nodes/conversions/flow_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint32_t kQueue = 100;  ///< changes that wait for a slow recorder

std::string describe(const flow::FlowControls& controls)
{
  return formatted("heart rate %g Hz, mean pressure %g Pa, %s", controls.heart_rate, controls.mean_pressure,
                   controls.hyperaemia ? "hyperaemia" : "no hyperaemia");
}

/** Controls with the changes of a request.
 *  @param refusal set to the reason of a refusal */
flow::FlowControls changed(flow::FlowControls controls, const SetHemodynamics::Request& request, std::string& refusal)
{
  if (!std::isnan(request.heart_rate))
    controls.heart_rate = request.heart_rate;
  if (!std::isnan(request.mean_pressure))
    controls.mean_pressure = request.mean_pressure;
  if (request.hyperaemia >= 0)
    controls.hyperaemia = request.hyperaemia == 1;
  refusal = flow::refusalOf(controls);
  if (request.hyperaemia < -1 || request.hyperaemia > 1)
    refusal = formatted("hyperaemia is %d; must be 1, 0 or -1", static_cast<int>(request.hyperaemia));
  return controls;
}

}  // namespace

GraphHemodynamics::GraphHemodynamics(ros::NodeHandle& node, const flow::FlowControls& controls)
  : publisher_(node.advertise<HemodynamicControls>(names::kHemodynamicControls, kQueue, true)), wanted_(controls)
{
  const boost::function<bool(SetHemodynamics::Request&, SetHemodynamics::Response&)> call =
      [this](SetHemodynamics::Request& request, SetHemodynamics::Response& response)
  {
    set(request, response);
    return true;
  };
  ros::AdvertiseServiceOptions options;
  options.init<SetHemodynamics::Request, SetHemodynamics::Response>(names::kSetHemodynamics, call);
  options.callback_queue = &queue_;  // of a thread of its own: also between two steps and in a pause
  service_ = node.advertiseService(options);
  spinner_.start();
}

/** Called in a thread of ROS. */
void GraphHemodynamics::set(const SetHemodynamics::Request& request, SetHemodynamics::Response& response)
{
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  std::string refusal;
  const flow::FlowControls controls = changed(wanted_, request, refusal);
  response.success = refusal.empty() ? 1 : 0;
  response.message = refusal.empty() ? describe(controls) + ", from the next step on" : refusal;
  if (!refusal.empty())
  {
    ROS_WARN("refused a change of the circulation: %s", refusal.c_str());
    return;
  }
  wanted_ = controls;
  has_changes_ = true;
}

void GraphHemodynamics::beginRun(const session::Session& session, std::uint32_t run, ros::Time stamp)
{
  {
    const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
    wanted_ = session.flowControls();
    has_changes_ = false;
  }
  message_.run = run;
  publish(session, stamp);
}

void GraphHemodynamics::applyChanges(session::Session& session, ros::Time stamp)
{
  if (!has_changes_)
    return;
  {
    const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
    has_changes_ = false;
    if (wanted_ == session.flowControls())
      return;
    session.setFlowControls(wanted_);
  }
  publish(session, stamp);
}

void GraphHemodynamics::publish(const session::Session& session, ros::Time stamp)
{
  message_.header.stamp = stamp;
  message_.step = session.simulation().steps();
  toMessage(session.flowControls(), message_);
  publisher_.publish(message_);
}

}  // namespace endovascular_sim::nodes
