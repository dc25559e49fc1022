#include "nodes/contact/contact_node.h"

#include <algorithm>
#include <utility>

#include <boost/make_shared.hpp>

#include "common/error.h"
#include "common/time/processor_time.h"
#include "endovascular_sim/GetVessel.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/line/message_frame.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/ros_names.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 4;
constexpr int kDisplacementQueue = 1000;  ///< none may be lost
constexpr double kLargestMargin = 10.0;   ///< of a query, in contact margins of the scene; the solver asks for up to 3
constexpr int kVesselPatience = 5;        ///< wait for the vessel of a connected vessel server [s]

}  // namespace

ContactNode::ContactNode(const ros::NodeHandle& node, const scene::Scene& scene,
                         std::function<SchedulingGrant()> request)
  : node_(node), request_(std::move(request))
{
  if (!scene.vessel)
  {
    ROS_INFO("no vessel in the scene %s: nothing to do", scene.name.c_str());
    return;
  }
  law_ = scene::wallLaw(*scene.vessel);
  largest_margin_ = kLargestMargin * scene.solver.stepper.contact_margin;
  subscribe();
  diagnostics_.setHardwareID("none");
  diagnostics_.add("contact", this, &ContactNode::diagnose);
  timer_ = node_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { onTimer(); });
}

void ContactNode::onTimer()
{
  // By the steady clock: simulated time may stand still.
  publishDiagnostics(diagnostics_);
  // roscpp can lose a latched message to a subscriber that connects while it is published.
  const bool is_missing = !detector_ && vessel_subscriber_.getNumPublishers() > 0;
  seconds_without_vessel_ = is_missing ? seconds_without_vessel_ + 1 : 0;
  GetVessel vessel;
  if (seconds_without_vessel_ <= kVesselPatience || !ros::service::call(node_.resolveName(names::kGetVessel), vessel))
    return;
  ROS_WARN("the vessel has not arrived as a message; using that of the service");
  try
  {
    receiveVessel(boost::make_shared<VesselMesh>(vessel.response.mesh));
  }
  catch (const InputError& error)
  {
    IgnoredMessages::ofProcess().add(names::kGetVessel, error.what());
  }
}

void ContactNode::subscribe()
{
  publisher_ = node_.advertise<StampedContactSet>(names::kContactSet, kQueue);
  vessel_subscriber_ = subscribeGuarded<VesselMesh>(node_, names::kVesselMesh, 1,
                                                    [this](const VesselMeshConstPtr& mesh) { receiveVessel(mesh); });
  displacement_subscriber_ = subscribeGuarded<WallDisplacement>(
      node_, names::kWallDisplacement, kDisplacementQueue,
      [this](const ros::MessageEvent<WallDisplacement const>& event)
      {
        displacement_source_.require(event.getPublisherName());
        receiveDisplacement(event.getConstMessage());
      },
      &queue_);
  wall_service_ = node_.advertiseService(names::kTakeWall, &ContactNode::takeWall, this);
  if (ros::param::param("~local_line", true))
    line_ = std::make_unique<LineServer>(lineName(ros::master::getURI(), node_.resolveName(names::kContactSet)),
                                         [this](const std::uint8_t* frame, std::uint32_t size)
                                         { receiveFrame(frame, size); });
  state_subscriber_ = subscribeGuarded<RodState>(
      node_, names::kRodState, kQueue,
      [this](const ros::MessageEvent<RodState const>& event)
      {
        if (line_ && line_->isConnected())
          return;  // for further subscribers, or of another node
        state_source_.require(event.getPublisherName());
        receiveState(event.getConstMessage());
      },
      &queue_);
}

/** Adopts the first mesh, and the first mesh of a restarted vessel server; displacements keep it up to date. */
void ContactNode::receiveVessel(const VesselMeshConstPtr& message)
{
  if (detector_ && (message->version != 1 || follows_rod_))
    return;
  GetVessel vessel;
  // The latched mesh may be newer than the wall that the rod requests: the service also returns the versions between.
  const bool moved = message->version != 1 && ros::service::call(node_.resolveName(names::kGetVessel), vessel);
  const VesselMesh& mesh = moved ? vessel.response.mesh : *message;
  ROS_INFO("preparing contact detection in %zu triangles", mesh.mesh.triangles.size());
  auto detector = std::make_unique<contact::Detector>(fromMessage(mesh), law_, mesh.version);
  triangles_ = mesh.mesh.triangles.size();
  ROS_INFO("vessel version %lu, %zu triangles", static_cast<unsigned long>(mesh.version), mesh.mesh.triangles.size());
  if (request_)
    grant_ = std::exchange(request_, nullptr)();
  const std::lock_guard<std::mutex> lock(mutex_);
  detector_ = std::move(detector);
  version_ = mesh.version;
  received_ = std::max<std::uint64_t>(received_, mesh.version + vessel.response.moved.size());
  for (auto displacement = vessel.response.moved.rbegin(); displacement != vessel.response.moved.rend(); ++displacement)
    pending_.push_front(boost::make_shared<WallDisplacement>(*displacement));
}

/** Takes the present wall of vessel_server in place of the one that is searched. No rod state may be on its way. */
bool ContactNode::takeWall(TakeWall::Request& request, TakeWall::Response& response)
{
  GetVessel vessel;
  try
  {
    if (!waitForVersion(request.newest))
      throw InputError(names::kWallDisplacement, "", "version " + std::to_string(request.newest) + " has not arrived");
    if (!ros::service::call(node_.resolveName(names::kGetVessel), vessel))
      throw InputError(names::kGetVessel, "", "does not respond");
    adoptWall(vessel.response);
    response.success = 1;
  }
  catch (const std::exception& error)
  {
    response.message = error.what();
  }
  return true;
}

/** Waits for the vessel, and for the displacement that leads to a version. @return false when they do not arrive */
bool ContactNode::waitForVersion(std::uint64_t version)
{
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kVesselPatience);
  while (ros::WallTime::now() < end)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (detector_ && received_ >= version)
        return true;
    }
    ros::WallDuration(1e-3).sleep();
  }
  return false;
}

/** @throws InputError for an invalid wall, or one with other triangles: the wall that is searched then stays */
void ContactNode::adoptWall(const GetVessel::Response& vessel)
{
  const geometry::TriangleMesh mesh = fromMessage(vessel.mesh);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (mesh.triangles != detector_->wall().triangles || mesh.vertices.size() != detector_->wall().vertices.size())
    throw InputError(names::kVesselMesh, "", "is another vessel than the one that is searched; restart the session");
  const intervention::WallDisplacement moved =
      intervention::displacementBetween(detector_->wall().vertices, mesh.vertices);
  detector_->moveVertices(moved.indices, moved.positions, vessel.mesh.version);
  version_ = vessel.mesh.version;
  received_ = vessel.mesh.version + vessel.moved.size();
  follows_rod_ = true;
  deferred_.reset();
  pending_.clear();
  for (const WallDisplacement& displacement : vessel.moved)
    pending_.push_back(boost::make_shared<WallDisplacement>(displacement));
}

void ContactNode::receiveDisplacement(const WallDisplacementConstPtr& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (detector_)
    fromMessage(*message, detector_->wall().vertices.size());  // throws for an invalid one
  if (pending_.size() >= kDisplacementQueue)
    throw InputError(names::kWallDisplacement, "", "more wait than any simulation leaves; is another node publishing?");
  pending_.push_back(message);
  received_ = std::max(received_, message->version);
  if (!deferred_)
    return;
  const RodStateConstPtr state = std::move(deferred_);
  deferred_.reset();
  respond(state);
}

void ContactNode::receiveState(const RodStateConstPtr& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  requireUsable(*message, largest_margin_);
  deferred_.reset();
  if (detector_)
    respond(message);
}

/** Receives a rod state from the line. Invalid ones are ignored, as those of the topic. */
void ContactNode::receiveFrame(const std::uint8_t* frame, std::uint32_t size)
{
  try
  {
    if (!line_state_ || !line_state_.unique())  // a deferred state is still in use
      line_state_ = boost::make_shared<RodState>();
    fromFrame(frame, size, *line_state_);
    receiveState(line_state_);
  }
  catch (const std::exception& error)
  {
    IgnoredMessages::ofProcess().add(names::kRodState, error.what());
  }
}

/** Applies displacements up to the requested version. @return true when the wall has this version */
bool ContactNode::advanceWallTo(std::uint64_t version)
{
  for (; !pending_.empty() && pending_.front()->version <= version; pending_.pop_front())
  {
    if (pending_.front()->version != version_ + 1)
      continue;  // already part of the mesh
    const intervention::WallDisplacement displacement =
        fromMessage(*pending_.front(), detector_->wall().vertices.size());
    detector_->moveVertices(displacement.indices, displacement.positions, ++version_);
  }
  return version == 0 || version_ == version;
}

/** Advances the wall; an invalid displacement leaves it unchanged, and later states get no response. */
bool ContactNode::prepareWall(std::uint64_t version)
{
  try
  {
    return advanceWallTo(version);
  }
  catch (const InputError& error)
  {
    ROS_ERROR("%s; the simulation pauses until a new vessel is published", error.what());
    pending_.pop_front();
    return false;
  }
}

/** Publishes the contact set of a rod state, or defers it until its version of the wall is complete. */
void ContactNode::respond(const RodStateConstPtr& message)
{
  if (!prepareWall(message->vessel_version))
  {
    deferred_ = message;
    deferrals_ = deferrals_ + 1;
    return;
  }
  fromMessage(*message, query_);
  const double begin = processorSeconds();
  if (message->wanted_free_distance > 0.0)
    detector_->freeDistances(query_, message->wanted_free_distance, response_.set);
  else
    detector_->detect(query_, response_.set);
  detection_time_ = detection_time_ + processorSeconds() - begin;
  response_.header.stamp = ros::Time::now();
  response_.header.frame_id = names::kPatientFrame;
  publishResponse();
  response_time_ = processorSeconds();
  ++responses_;
  countProgress();
  features_ = response_.set.features.size();
}

/** Sends the response to the rod: over the line, where it is connected. */
void ContactNode::publishResponse()
{
  bool is_sent = false;
  if (line_ && line_->isConnected())
  {
    toFrame(response_, frame_);
    is_sent = line_->send(frame_);
  }
  if (!is_sent || publisher_.getNumSubscribers() > 1)  // the rod subscribes too
    publisher_.publish(response_);
}

void ContactNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  if (triangles_ == 0)
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "waiting for the vessel");
  else if (!grant_.isInForce())
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "scheduling: " + grant_.describe());
  else
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
  status.add("scheduling", grant_.describe());
  status.add("contact sets published", responses_.load());
  const double responses = std::max(1.0, static_cast<double>(responses_));
  status.add("processor time, detection [us]", 1e6 * detection_time_ / responses);
  status.add("processor time, conversion and transport [us]", 1e6 * (response_time_ - detection_time_) / responses);
  status.add("features in the last set", features_.load());
  status.add("triangles", triangles_.load());
  status.add("vessel version", version_.load());
  status.add("responses deferred until a wall displacement", deferrals_.load());
  IgnoredMessages::ofProcess().diagnose(status);
}

}  // namespace endovascular_sim::nodes
