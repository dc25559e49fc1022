#include "nodes/support/remote_contact_source.h"

#include <algorithm>
#include <cmath>

#include "nodes/support/contact_conversions.h"
#include "nodes/support/names.h"

namespace endovascular_sim::nodes
{
namespace
{

using Clock = std::chrono::steady_clock;
constexpr double kSilentPatience = 0.1;  // of the patience, while the node has not answered
constexpr int kQueue = 4;

bool isFinite(const ContactFeature& f)
{
  return std::isfinite(f.parameter) && std::isfinite(f.gap) && std::isfinite(f.friction) && std::isfinite(f.point.x) &&
         std::isfinite(f.point.y) && std::isfinite(f.point.z) && !std::isnan(f.stiffness) &&
         std::abs(f.normal.x * f.normal.x + f.normal.y * f.normal.y + f.normal.z * f.normal.z - 1.0) < 1e-6;
}

}  // namespace

RemoteContactSource::RemoteContactSource(ros::NodeHandle node, double patience) : node_(node), patience_(patience)
{
  node_.setCallbackQueue(&queue_);
  publisher_ = node_.advertise<RodState>(names::kRodState, kQueue);
  subscriber_ = node_.subscribe(names::kContactSet, kQueue, &RemoteContactSource::receive, this,
                                ros::TransportHints().tcpNoDelay());
  query_.header.frame_id = names::kPatientFrame;
}

void RemoteContactSource::publish()
{
  // Only this thread writes the query, so it may read it without the lock.
  query_.header.stamp = ros::Time::now();
  publisher_.publish(query_);
}

/** An answer counts only when it is of the asked state and makes sense; anything else is dropped and counted. */
bool RemoteContactSource::fits(const ContactSet& message) const
{
  if (message.step != query_.step || message.substep != query_.substep || message.pass != query_.pass)
    return false;
  const std::size_t edges = query_.nodes.empty() ? 0 : query_.nodes.size() - 1;
  if (message.first_edge != query_.first_node || message.free_distance.size() != edges)
    return false;
  return std::all_of(message.features.begin(), message.features.end(),
                     [&](const ContactFeature& feature)
                     {
                       return feature.edge >= static_cast<int>(query_.first_node) &&
                              feature.edge < static_cast<int>(query_.first_node + edges) && feature.parameter >= 0.0 &&
                              feature.parameter <= 1.0 && isFinite(feature);
                     });
}

void RemoteContactSource::receive(const ContactSetConstPtr& message)
{
  heard_ = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!fits(*message))
    {
      ++odd_sets_;
      return;
    }
    answer_ = message;
  }
  answered_.notify_one();
}

void RemoteContactSource::ask(const contact::Query& query)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    toMessage(query, query_);
    answer_.reset();
  }
  publish();
}

bool RemoteContactSource::waitForAnswer(double seconds)
{
  std::unique_lock<std::mutex> lock(mutex_);
  return answered_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return answer_ != nullptr; });
}

void RemoteContactSource::detect(const contact::Query& query, contact::ContactSet& set)
{
  ask(query);
  if (waitForAnswer(silent_ ? kSilentPatience * patience_ : patience_))
  {
    silent_ = false;
    const std::lock_guard<std::mutex> lock(mutex_);
    fromMessage(*answer_, set);
    return;
  }
  if (!silent_)
    silent_since_ = Clock::now();
  silent_ = true;
  ++stale_sets_;
  set.stale = true;
}

bool RemoteContactSource::probe()
{
  if (heard_.exchange(false))
  {
    silent_ = false;
    return true;
  }
  publish();
  return false;
}

bool RemoteContactSource::waitForNode(const contact::Query& query)
{
  while (ros::ok())
  {
    if (publisher_.getNumSubscribers() > 0)
      ask(query);
    if (waitForAnswer(0.2))
      return true;
  }
  return false;
}

}  // namespace endovascular_sim::nodes
