#include "nodes/hemodynamics/hemodynamics_node.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "common/time/processor_time.h"
#include "nodes/conversions/contrast_conversions.h"
#include "nodes/conversions/flow_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/line/message_frame.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/blood_coupling.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 4;

}  // namespace

HemodynamicsNode::HemodynamicsNode(ros::NodeHandle& node, const scene::Scene& scene,
                                   std::function<SchedulingGrant()> request)
  : node_(node), scene_(scene), request_(std::move(request))
{
  if (!scene_.flow)
  {
    ROS_INFO("no flow of blood in the scene %s: nothing to do", scene_.name.c_str());
    return;
  }
  topics_.emplace(node_, scene_);
  publisher_ = node_.advertise<FlowAnswer>(names::kFlowAnswer, kQueue);
  centreline_subscriber_ = subscribeGuarded<VesselCentreline>(
      node_, names::kVesselCentreline, 1, [this](const VesselCentreline& message) { receiveCentreline(message); });
  if (scene_.contrast)
    cells_subscriber_ = subscribeGuarded<ContrastCells>(
        node_, names::kContrastCells, 1, [this](const ContrastCells& message) { receiveCells(message); });
  diagnostics_.setHardwareID("none");
  diagnostics_.add("hemodynamics", this, &HemodynamicsNode::diagnose);
  timer_ = node_.createWallTimer(ros::WallDuration(1.0),
                                 [this](const ros::WallTimerEvent&) { publishDiagnostics(diagnostics_); });
}

/** Takes over a vessel, the first one or that of a restarted vessel server. */
void HemodynamicsNode::receiveCentreline(const VesselCentreline& message)
{
  if (engine_ && message.content_hash == content_hash_)
    return;
  centreline_ = message;
  prepare();
}

/** Takes over the volumes of the cells of contrast medium, those of the undeformed wall, from the simulation. */
void HemodynamicsNode::receiveCells(const ContrastCells& message)
{
  volumes_ = volumesOf(message);
  volumes_hash_ = message.content_hash;
  prepare();
}

/** Prepares the flow in the vessel that has arrived, when all is known of it. */
void HemodynamicsNode::prepare()
{
  if (!centreline_ || (scene_.contrast && volumes_hash_ != centreline_->content_hash))
    return;
  const VesselCentreline message = *std::exchange(centreline_, std::nullopt);
  vessel::Vessel vessel;
  vessel.centreline = fromMessage(message);
  vessel.lesions = lesionsFromMessage(message);
  auto engine = std::make_unique<flow::FlowEngine>(vessel.centreline, vessel.lesions, scene_.flow->circulation,
                                                   scene_.flow->time_step, simulation::pressureLines(scene_),
                                                   scene_.contrast ? volumes_ : std::vector<double>());
  const flow::BodyFlow& body = engine->body();
  for (const std::string& remark : body.remarks())
    ROS_WARN("%s", remark.c_str());
  cells_ = body.vessel().places.size();
  ROS_INFO("flow of blood in %zu cells", body.vessel().places.size());
  topics_->publishNetwork(*engine, vessel.centreline, vessel.lesions, message.content_hash);
  content_hash_ = message.content_hash;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    engine_ = std::move(engine);
    branches_ = vessel.centreline.branches.size();
  }
  if (request_)
    grant_ = std::exchange(request_, nullptr)();
  listen();
}

/** Accepts requests; their senders wait for the subscription. */
void HemodynamicsNode::listen()
{
  if (request_subscriber_)
    return;
  const std::unique_lock<std::mutex> lock(mutex_);  // the line may call back at once
  if (ros::param::param("~local_line", true))
    line_ = std::make_unique<LineServer>(lineName(ros::master::getURI(), node_.resolveName(names::kFlowAnswer)),
                                         [this](const std::uint8_t* frame, std::uint32_t size)
                                         { receiveFrame(frame, size); });
  request_subscriber_ = subscribeGuarded<FlowRequest>(
      node_, names::kFlowRequest, kQueue,
      [this](const ros::MessageEvent<FlowRequest const>& event)
      {
        if (line_ && line_->isConnected())
          return;  // for further subscribers, or of another node
        source_.require(event.getPublisherName());
        receiveRequest(*event.getConstMessage());
      },
      &queue_);
}

/** Receives a request from the line. Invalid ones are ignored, as those of the topic. */
void HemodynamicsNode::receiveFrame(const std::uint8_t* frame, std::uint32_t size)
{
  try
  {
    fromFrame(frame, size, line_request_);
    receiveRequest(line_request_);
  }
  catch (const std::exception& error)
  {
    IgnoredMessages::ofProcess().add(names::kFlowRequest, error.what());
  }
}

/** Answers a request. @throws std::exception for an invalid one */
void HemodynamicsNode::receiveRequest(const FlowRequest& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const double begin = processorSeconds();
  fromMessage(message, branches_, input_);
  const double converted = processorSeconds();
  engine_->step(input_, output_);
  step_time_ = step_time_ + processorSeconds() - converted;
  answer_.header = message.header;
  answer_.sequence = message.sequence;
  toMessage(output_, answer_);
  publishAnswer();
  answer_time_ = answer_time_ + processorSeconds() - begin;
  ++answers_;
  countProgress();
  if (std::exchange(published_, message.sequence) != message.sequence)
    topics_->publishStep(input_, output_.field, message.header.stamp);
}

/** Sends the answer to the simulation: over the line, where it is connected. */
void HemodynamicsNode::publishAnswer()
{
  bool is_sent = false;
  if (line_ && line_->isConnected())
  {
    toFrame(answer_, frame_);
    is_sent = line_->send(frame_);
  }
  if (!is_sent || publisher_.getNumSubscribers() > 1)  // the simulation subscribes too
    publisher_.publish(answer_);
}

void HemodynamicsNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  if (cells_ == 0)
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "waiting for the vessel");
  else if (!grant_.isInForce())
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "scheduling: " + grant_.describe());
  else
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
  status.add("scheduling", grant_.describe());
  status.add("steps answered", answers_.load());
  const double answers = std::max(1.0, static_cast<double>(answers_));
  status.add("processor time, step [us]", 1e6 * step_time_ / answers);
  status.add("processor time, conversion and transport [us]", 1e6 * (answer_time_ - step_time_) / answers);
  status.add("cells", cells_.load());
  IgnoredMessages::ofProcess().diagnose(status);
}

}  // namespace endovascular_sim::nodes
