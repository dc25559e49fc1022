#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "nodes/runtime/priority_inheritance_mutex.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{

/** Controls of the patient in the graph: a service that changes them between two steps, and a latched topic with those
 *  in force. A recording holds the topic, so that its replay has the same values in the same steps.
 *  @tparam Part of the patient: types Controls, Message (with header, run and step) and Service; names kTopic, kService
 *          and kNoun; functions of(session), set(session, controls), changed(controls, request, refusal),
 *          describe(controls) and toMessage(controls, message) */
template <typename Part>
class GraphControls
{
public:
  using Controls = typename Part::Controls;
  using Request = typename Part::Service::Request;
  using Response = typename Part::Service::Response;

  /** @param session at the beginning of the scene */
  GraphControls(ros::NodeHandle& node, const session::Session& session, Part part = {})
    : part_(std::move(part)),
      publisher_(node.advertise<typename Part::Message>(Part::kTopic, kQueue, true)),
      wanted_(part_.of(session))
  {
    const boost::function<bool(Request&, Response&)> call = [this](Request& request, Response& response)
    {
      change(request, response);
      return true;
    };
    ros::AdvertiseServiceOptions options;
    options.init<Request, Response>(Part::kService, call);
    options.callback_queue = &queue_;  // of a thread of its own: also between two steps and in a pause
    service_ = node.advertiseService(options);
    spinner_.start();
  }
  ~GraphControls() { spinner_.stop(); }
  GraphControls(const GraphControls&) = delete;
  GraphControls& operator=(const GraphControls&) = delete;

  /** Publishes the controls of a session at the beginning of a run, and forgets changes that have waited.
   *  @param run number of the run */
  void beginRun(const session::Session& session, std::uint32_t run, ros::Time stamp)
  {
    has_changes_ = false;
    message_.run = run;
    publish(session, stamp);
  }

  /** Changes the controls as the service has asked for, before the next step, and publishes every change. */
  void applyChanges(session::Session& session, ros::Time stamp)
  {
    if (has_changes_)
    {
      const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
      has_changes_ = false;
      part_.set(session, wanted_);
    }
    if (part_.of(session) != published_)
      publish(session, stamp);
  }

private:
  static constexpr std::uint32_t kQueue = 100;  ///< changes that wait for a slow recorder

  /** Called in a thread of ROS. */
  void change(const Request& request, Response& response)
  {
    const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
    std::string refusal;
    const Controls controls = part_.changed(wanted_, request, refusal);
    response.success = refusal.empty() ? 1 : 0;
    response.message = refusal.empty() ? part_.describe(controls) : refusal;
    if (!refusal.empty())
    {
      ROS_WARN("refused a change of %s: %s", Part::kNoun, refusal.c_str());
      return;
    }
    wanted_ = controls;
    has_changes_ = true;
  }

  void publish(const session::Session& session, ros::Time stamp)
  {
    published_ = part_.of(session);
    {
      const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
      if (!has_changes_)
        wanted_ = published_;
    }
    message_.header.stamp = stamp;
    message_.step = session.simulation().steps();
    part_.toMessage(published_, message_);
    publisher_.publish(message_);
  }

  Part part_;
  ros::Publisher publisher_;
  typename Part::Message message_;
  Controls published_;              ///< newest ones on the topic
  PriorityInheritanceMutex mutex_;  ///< guards the next one
  Controls wanted_;                 ///< in force, or for the next step
  std::atomic<bool> has_changes_{false};
  ros::CallbackQueue queue_;  ///< of the service
  ros::AsyncSpinner spinner_{1, &queue_};
  ros::ServiceServer service_;  ///< last, so that it ends first
};

}  // namespace endovascular_sim::nodes
