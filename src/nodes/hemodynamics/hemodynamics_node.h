#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include "endovascular_sim/ContrastCells.h"
#include "endovascular_sim/FlowAnswer.h"
#include "endovascular_sim/FlowRequest.h"
#include "endovascular_sim/VesselCentreline.h"
#include "flow/coupling/flow_engine.h"
#include "nodes/hemodynamics/hemodynamics_publisher.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/line/local_line.h"
#include "nodes/runtime/one_source.h"
#include "nodes/runtime/real_time.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** ROS node of the flow of blood: responds to every request with one step of the flow. A simulation of the same machine
 *  connects to a local line. From then on its requests arrive there, and those of the topic are ignored.
 *
 *  The node has no state between requests: each request and each answer contains that of the circulation. A restarted
 *  node therefore answers the next request, and equal requests have equal answers. */
class HemodynamicsNode
{
public:
  /** Without flow in the scene the node does nothing.
   *  @param request requests the scheduling of the process; called once, after the set-up of the first vessel */
  HemodynamicsNode(
      ros::NodeHandle& node, const scene::Scene& scene,
      std::function<SchedulingGrant()> request = [] { return SchedulingGrant(); });

private:
  void receiveCentreline(const VesselCentreline& message);
  void receiveCells(const ContrastCells& message);
  void prepare();
  void listen();
  void receiveRequest(const FlowRequest& message);
  void receiveFrame(const std::uint8_t* frame, std::uint32_t size);
  void publishAnswer();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle node_;
  scene::Scene scene_;
  std::function<SchedulingGrant()> request_;  ///< empty once it was called
  SchedulingGrant grant_;                     ///< used by the thread of vessels and diagnostics only
  std::optional<HemodynamicsPublisher> topics_;
  // Used by the thread of vessels only:
  std::uint64_t content_hash_ = 0;              ///< of the vessel of the engine
  std::optional<VesselCentreline> centreline_;  ///< that waits for its cells of contrast medium
  std::vector<double> volumes_;                 ///< of these cells [m³]
  std::uint64_t volumes_hash_ = 0;              ///< of their vessel
  std::mutex mutex_;                            ///< guards the next six: vessels arrive in another thread
  std::unique_ptr<flow::FlowEngine> engine_;    ///< null before the first vessel
  std::size_t branches_ = 0;                    ///< of the vessel
  flow::FlowRequest input_;
  flow::FlowAnswer output_;
  FlowAnswer answer_;
  std::optional<std::uint64_t> published_;  ///< number of the last request whose step was published
  OneSource source_;                        ///< used by the thread of requests only
  FlowRequest line_request_;                ///< buffer of the line's thread
  std::vector<std::uint8_t> frame_;         ///< answer as sent over the line
  // Counters for /diagnostics, which another thread publishes.
  std::atomic<std::uint64_t> answers_{0};
  std::atomic<std::size_t> cells_{0};
  std::atomic<double> step_time_{0.0};    ///< processor time of the steps, sum of all answers [s]
  std::atomic<double> answer_time_{0.0};  ///< the same with the conversion and the transport of the answers [s]
  ros::Publisher publisher_;
  DirectCallbackQueue queue_;
  diagnostic_updater::Updater diagnostics_;
  std::unique_ptr<LineServer> line_;  ///< null with topics only, and before the first vessel
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber centreline_subscriber_, cells_subscriber_, request_subscriber_;
  ros::WallTimer timer_;
};

}  // namespace endovascular_sim::nodes
