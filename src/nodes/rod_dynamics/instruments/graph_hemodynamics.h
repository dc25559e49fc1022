#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "endovascular_sim/HemodynamicControls.h"
#include "endovascular_sim/SetHemodynamics.h"
#include "flow/coupling/flow_source.h"
#include "nodes/runtime/priority_inheritance_mutex.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{

/** Heart rate, mean pressure and hyperaemia in the graph: service hemodynamics/set, topic hemodynamics/controls. A
 *  recording holds the topic, so that its replay has the same values in the same steps. */
class GraphHemodynamics
{
public:
  /** @param controls at the beginning of the scene */
  GraphHemodynamics(ros::NodeHandle& node, const flow::FlowControls& controls);
  ~GraphHemodynamics() { spinner_.stop(); }
  GraphHemodynamics(const GraphHemodynamics&) = delete;
  GraphHemodynamics& operator=(const GraphHemodynamics&) = delete;

  /** Publishes the controls of a session at the beginning of a run, and forgets changes that have waited.
   *  @param run number of the run */
  void beginRun(const session::Session& session, std::uint32_t run, ros::Time stamp);

  /** Changes the controls as the service has asked for, before the next step. */
  void applyChanges(session::Session& session, ros::Time stamp);

private:
  void set(const SetHemodynamics::Request& request, SetHemodynamics::Response& response);
  void publish(const session::Session& session, ros::Time stamp);

  ros::Publisher publisher_;
  HemodynamicControls message_;
  PriorityInheritanceMutex mutex_;  ///< guards the next one
  flow::FlowControls wanted_;       ///< in force, or for the next step
  std::atomic<bool> has_changes_{false};
  ros::CallbackQueue queue_;  ///< of the service
  ros::AsyncSpinner spinner_{1, &queue_};
  ros::ServiceServer service_;  ///< last, so that it ends first
};

}  // namespace endovascular_sim::nodes
