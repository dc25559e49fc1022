#include "nodes/rod_dynamics/remote_contact_source.h"

#include <algorithm>
#include <utility>

#include "contact/contract/contact_set_validation.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

using Clock = std::chrono::steady_clock;
constexpr int kQueue = 4;
constexpr double kRepeat = 0.2;  ///< interval of a query without a response, which a restarted node may have missed [s]

}  // namespace

RemoteContactSource::RemoteContactSource(const ros::NodeHandle& node, double timeout, LoopCosts& costs)
  : costs_(costs),
    timeout_(timeout),
    channel_(node, names::kRodState, names::kContactSet, kQueue, costs,
             [this](StampedContactSet& message, bool is_answered) { return accept(message, is_answered); })
{
}

/** Accepts the first valid response to the last query; counts and discards any other set. */
bool RemoteContactSource::accept(StampedContactSet& message, bool is_answered)
{
  if (is_answered)
  {
    ++rejected_sets_;
    return true;
  }
  std::swap(answer_, message.set);
  const bool is_answer = contact::isValidAnswer(asked_, answer_);
  heard_ = heard_ || is_answer;
  rejected_sets_ += !is_answer;
  if (!is_answer)
    timeout_.receivedLate();
  return is_answer;
}

/** @param wanted_free_distance 0 in a query for features [m] */
void RemoteContactSource::ask(const contact::Query& query, double wanted_free_distance)
{
  channel_.ask(
      [this, &query, wanted_free_distance](RodState& message)
      {
        toMessage(query, wanted_free_distance, message);
        message.header.frame_id = names::kPatientFrame;
        message.header.stamp = ros::Time::now();
        asked_ = query;
      });
}

/** Waits for the response to the last query. A long wait repeats the query. */
bool RemoteContactSource::waitForResponse(double seconds)
{
  for (; seconds > kRepeat && ros::ok() && !isStopRequested(); seconds -= kRepeat)
  {
    if (channel_.waitForAnswer(kRepeat))
      return true;
    channel_.repeat(ros::Time::now());
  }
  return channel_.waitForAnswer(std::min(seconds, kRepeat));
}

void RemoteContactSource::detect(const contact::Query& query, contact::ContactSet& set)
{
  request(query, 0.0, set);
}

void RemoteContactSource::freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set)
{
  request(query, wanted, set);
}

void RemoteContactSource::request(const contact::Query& query, double wanted_free_distance, contact::ContactSet& set)
{
  const LoopCosts::Scope conversion(costs_, LoopPhase::kConversion);
  ask(query, wanted_free_distance);
  if (waitForResponse(timeout_.next()))
  {
    timeout_.received();
    const auto lock = channel_.access();
    std::swap(set, answer_);  // the old set becomes the buffer of the next response
    set.stale = false;
    return;
  }
  if (!timeout_.silent())
    silent_since_ = Clock::now();
  timeout_.missed();
  ++stale_sets_;
  set.stale = true;
}

bool RemoteContactSource::probe()
{
  channel_.receiveArrived();
  if (heard_.exchange(false))
  {
    timeout_.received();
    return true;
  }
  channel_.forgetAnswer();
  channel_.repeat(ros::Time::now());
  return false;
}

bool RemoteContactSource::waitForNode(const contact::Query& query)
{
  while (ros::ok())
  {
    if (channel_.subscribers() > 0)
      ask(query, 0.0);
    if (channel_.waitForAnswer(0.2))
      return true;
  }
  return false;
}

}  // namespace endovascular_sim::nodes
