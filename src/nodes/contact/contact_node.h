#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <boost/shared_ptr.hpp>

#include "contact/detector.h"
#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/RodState.h"
#include "endovascular_sim/TakeWall.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "nodes/conversions/contact_set_serializer.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/line/local_line.h"
#include "nodes/runtime/one_source.h"
#include "nodes/runtime/real_time.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** ROS node of contact detection: responds to every rod state with the wall features near the rod. A rod of the same
 *  machine connects to a local line. From then on its states arrive there, and those of the topic are ignored.
 *
 *  Lock-step with a moving wall: a rod state requests a version of the vessel. The node applies the displacements up to
 *  this version, never beyond it, and defers the response until they have arrived. After a reset and a loaded state
 *  rod_dynamics makes it take the wall of vessel_server anew. */
class ContactNode
{
public:
  /** Without a vessel in the scene the node does nothing.
   *  @param request requests the scheduling of the process; called once, after the set-up of the first vessel */
  ContactNode(
      const ros::NodeHandle& node, const scene::Scene& scene,
      std::function<SchedulingGrant()> request = [] { return SchedulingGrant(); });

private:
  void onTimer();
  void subscribe();
  void receiveVessel(const VesselMeshConstPtr& message);
  bool takeWall(TakeWall::Request& request, TakeWall::Response& response);
  bool waitForVersion(std::uint64_t version);
  void adoptWall(const GetVessel::Response& vessel);
  void receiveDisplacement(const WallDisplacementConstPtr& message);
  void receiveState(const RodStateConstPtr& message);
  void receiveFrame(const std::uint8_t* frame, std::uint32_t size);
  bool advanceWallTo(std::uint64_t version);
  bool prepareWall(std::uint64_t version);
  void respond(const RodStateConstPtr& message);
  void publishResponse();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle node_;
  std::function<SchedulingGrant()> request_;  ///< empty once it was called
  SchedulingGrant grant_;                     ///< used by the thread of vessels and diagnostics only
  contact::WallLaw law_;
  double largest_margin_ = 0.0;                   ///< of a query [m]
  std::mutex mutex_;                              ///< guards the next four: vessels arrive in another thread
  std::unique_ptr<contact::Detector> detector_;   ///< null before the first vessel
  std::deque<WallDisplacementConstPtr> pending_;  ///< displacements that no rod state has requested yet
  RodStateConstPtr deferred_;                     ///< rod state that waits for its version of the wall
  std::uint64_t received_ = 0;                    ///< newest version of the wall that has arrived
  bool follows_rod_ = false;                      ///< true: rod_dynamics names the wall to search, not vessel/mesh
  int seconds_without_vessel_ = 0;                ///< with a connected vessel server [s]
  OneSource state_source_, displacement_source_;  ///< used by the thread of states and displacements only
  contact::Query query_;
  StampedContactSet response_;
  std::vector<std::uint8_t> frame_;         ///< response as sent over the line
  boost::shared_ptr<RodState> line_state_;  ///< buffer of the line's thread
  // Counters for /diagnostics, which another thread publishes.
  std::atomic<std::uint64_t> responses_{0};
  std::atomic<std::size_t> features_{0};
  std::atomic<std::size_t> triangles_{0};
  std::atomic<std::uint64_t> version_{0};
  std::atomic<std::uint64_t> deferrals_{0};
  std::atomic<double> detection_time_{0.0};  ///< processor time of the detection, sum of all responses [s]
  std::atomic<double> response_time_{0.0};   ///< processor time of the responding thread since its start [s]
  ros::Publisher publisher_;
  DirectCallbackQueue queue_;
  diagnostic_updater::Updater diagnostics_;
  std::unique_ptr<LineServer> line_;  ///< null with topics only
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber vessel_subscriber_, displacement_subscriber_, state_subscriber_;
  ros::WallTimer timer_;
  ros::ServiceServer wall_service_;
};

}  // namespace endovascular_sim::nodes
