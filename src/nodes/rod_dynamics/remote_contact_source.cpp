#include "nodes/rod_dynamics/remote_contact_source.h"

#include <algorithm>
#include <utility>

#include <boost/make_shared.hpp>

#include "contact/contract/contact_set_validation.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ignored_messages.h"
#include "nodes/runtime/line/message_frame.h"
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
  : node_(node),
    costs_(costs),
    line_(lineName(ros::master::getURI(), node_.resolveName(names::kContactSet))),
    timeout_(timeout)
{
  publisher_ = node_.advertise<RodState>(names::kRodState, kQueue);
  subscriber_ = subscribeGuardedAs<const boost::shared_ptr<StampedContactSet>&>(
      node_, names::kContactSet, kQueue,
      [this](const boost::shared_ptr<StampedContactSet>& message)
      {
        if (!line_.isConnected())
          receive(*message);
      },
      &queue_, [this] { return emptyMessage(); });
  query_.header.frame_id = names::kPatientFrame;
}

void RemoteContactSource::publish()
{
  // Only this thread writes the query, so it may read it without the lock.
  query_.header.stamp = ros::Time::now();
  toFrame(query_, frame_);
  const LoopCosts::Scope transport(costs_, LoopPhase::kTransport);
  const bool is_sent = line_.send(frame_);
  // The contact node of the line subscribes too. Its queries over both ways would be answered twice.
  if (!is_sent || publisher_.getNumSubscribers() > 1)
    publisher_.publish(query_);
}

/** Message for the next set; reuses the memory of the last one, since a thousand features are slow to allocate. */
boost::shared_ptr<StampedContactSet> RemoteContactSource::emptyMessage()
{
  if (!message_ || !message_.unique())
    message_ = boost::make_shared<StampedContactSet>();
  return message_;
}

/** Accepts the first valid response to the last query; counts and discards any other set. */
void RemoteContactSource::receive(StampedContactSet& message)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!has_answer_)
    {
      std::swap(answer_, message.set);
      has_answer_ = contact::isValidAnswer(asked_, answer_);
      heard_ = heard_ || has_answer_;
      rejected_sets_ += !has_answer_;
      if (!has_answer_)
        timeout_.receivedLate();
    }
    else
      ++rejected_sets_;
    if (!has_answer_)
      return;
  }
  answered_.notify_one();
}

/** @param wanted_free_distance 0 in a query for features [m] */
void RemoteContactSource::ask(const contact::Query& query, double wanted_free_distance)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    toMessage(query, wanted_free_distance, query_);
    asked_ = query;
    has_answer_ = false;
  }
  publish();
}

/** Waits for the response to the last query. A long wait repeats the query. */
bool RemoteContactSource::waitForResponse(double seconds)
{
  for (; seconds > kRepeat && ros::ok() && !isStopRequested(); seconds -= kRepeat)
  {
    if (waitForAnswer(kRepeat))
      return true;
    publish();
  }
  return waitForAnswer(std::min(seconds, kRepeat));
}

bool RemoteContactSource::hasAnswer() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return has_answer_;
}

/** Receives the sets that arrive over the line. @return true when one of them is the answer */
bool RemoteContactSource::receiveFromLine(Clock::time_point deadline)
{
  const LoopCosts::Scope transport(costs_, LoopPhase::kTransport);
  while (const FrameStream* const stream = line_.receive(deadline))
  {
    const LoopCosts::Scope conversion(costs_, LoopPhase::kConversion);
    try
    {
      fromFrame(stream->frame(), stream->frameSize(), line_message_);
      receive(line_message_);
    }
    catch (const std::exception& error)
    {
      IgnoredMessages::ofProcess().add(names::kContactSet, error.what());
    }
    if (hasAnswer())
      return true;
  }
  return false;
}

bool RemoteContactSource::waitForAnswer(double seconds)
{
  const Clock::time_point deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  if (receiveFromLine(deadline))
    return true;
  if (line_.isConnected())
    return false;
  const LoopCosts::Scope transport(costs_, LoopPhase::kTransport);
  std::unique_lock<std::mutex> lock(mutex_);
  return answered_.wait_until(lock, deadline, [this] { return has_answer_; });
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
    const std::lock_guard<std::mutex> lock(mutex_);
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
  receiveFromLine(Clock::now());
  if (heard_.exchange(false))
  {
    timeout_.received();
    return true;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_answer_ = false;
  }
  publish();
  return false;
}

bool RemoteContactSource::waitForNode(const contact::Query& query)
{
  while (ros::ok())
  {
    if (publisher_.getNumSubscribers() > 0)
      ask(query, 0.0);
    if (waitForAnswer(0.2))
      return true;
  }
  return false;
}

}  // namespace endovascular_sim::nodes
