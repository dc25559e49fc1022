#include "nodes/rod_dynamics/remote_flow_source.h"

#include <algorithm>
#include <thread>

#include "common/error.h"
#include "nodes/conversions/flow_conversions.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 4;
constexpr double kRepeat = 0.2;     ///< interval of a request without an answer [s]
constexpr double kPatience = 10.0;  ///< longest wait for an answer [s]

double secondsSince(std::chrono::steady_clock::time_point time)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - time).count();
}

}  // namespace

RemoteFlowSource::RemoteFlowSource(const ros::NodeHandle& node, LoopCosts& costs)
  : costs_(costs),
    channel_(node, names::kFlowRequest, names::kFlowAnswer, kQueue, costs,
             [this](FlowAnswer& message, bool is_answered) { return accept(message, is_answered); })
{
}

/** Accepts the first answer to the last request; counts and discards any other one. */
bool RemoteFlowSource::accept(FlowAnswer& message, bool is_answered)
{
  if (is_answered || asked_ == 0 || message.sequence != asked_)
  {
    ++rejected_;
    return is_answered;
  }
  const bool fits = message.step == asked_step_ && message.probes.size() == asked_probes_ && !message.state.empty() &&
                    message.pressure.size() == sizes_.nodes && message.flow.size() == sizes_.cells &&
                    message.area.size() == sizes_.cells && message.readings.size() == sizes_.lines &&
                    message.mean_readings.size() == sizes_.lines &&
                    message.mean_lesion_pressures.size() == sizes_.lesions &&
                    (message.iodine.empty() || message.iodine.size() == sizes_.contrast_cells);
  if (!fits)
    throw InputError(names::kFlowAnswer, "", "has other numbers of values than the network of the vessel");
  fromMessage(message, answer_);
  return true;
}

void RemoteFlowSource::request(const flow::FlowRequest& request)
{
  const LoopCosts::Scope conversion(costs_, LoopPhase::kConversion);
  sent_ = Clock::now();
  asked_stamp_ = stamp_;
  channel_.ask(
      [this, &request](FlowRequest& message)
      {
        toMessage(request, message);
        message.header.stamp = stamp_;
        message.header.frame_id = names::kPatientFrame;
        message.sequence = ++asked_;
        asked_step_ = request.step;
        asked_probes_ = request.probes.size();
      });
}

bool RemoteFlowSource::isReady()
{
  return asked_ == 0 || channel_.hasAnswer() || channel_.receiveArrived();
}

void RemoteFlowSource::repeatWhenDue()
{
  if (secondsSince(sent_) < kRepeat)
    return;
  sent_ = Clock::now();
  channel_.repeat(asked_stamp_);
}

bool RemoteFlowSource::waitForAnswer(double seconds)
{
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  while (!isReady())
  {
    const double left = -secondsSince(end);
    repeatWhenDue();
    if (left <= 0.0 || !ros::ok() || isStopRequested())
      return false;
    channel_.waitForAnswer(std::min(left, kRepeat));
  }
  return true;
}

flow::FlowAnswer RemoteFlowSource::answer()
{
  const LoopCosts::Scope conversion(costs_, LoopPhase::kConversion);
  if (asked_ == 0 || !waitForAnswer(kPatience))
    throw InputError(names::kFlowAnswer, "", "hemodynamics does not respond");
  const auto lock = channel_.access();
  return answer_;
}

bool RemoteFlowSource::waitForNode() const
{
  while (ros::ok() && channel_.subscribers() == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return ros::ok();
}

}  // namespace endovascular_sim::nodes
