#include "nodes/vessel_server/vessel_server_node.h"

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/hash.h"
#include "common/progress.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/real_time.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/vessel_server/clicked_end.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 100;               ///< queue length of loads and displacements: none may be lost
constexpr int kPriority = 50;             ///< below the contact node's, which requests the wall
constexpr double kPatience = 5.0;         ///< longest wait for the loads that are on their way [s]
constexpr double kRepublishPeriod = 0.5;  ///< between two meshes of a wall that moves [s]

visualization_msgs::Marker wallMarker(const geometry::TriangleMesh& mesh)
{
  visualization_msgs::Marker marker;
  marker.header.frame_id = names::kPatientFrame;
  marker.ns = "vessel";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.r = 0.85F;
  marker.color.g = 0.35F;
  marker.color.b = 0.3F;
  marker.color.a = 0.3F;
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner)
      marker.points.push_back(toPoint(mesh.vertices[triangle[corner]]));
  return marker;
}

}  // namespace

VesselServerNode::VesselServerNode(const ros::NodeHandle& node, const scene::Scene& scene) : node_(node)
{
  if (!scene.vessel)
  {
    ROS_INFO("no vessel in the scene %s: nothing to do", scene.name.c_str());
    return;
  }
  ROS_INFO("preparing the vessel of %s", scene.file.c_str());
  const vessel::Vessel vessel =
      scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired,
                         progressLines([](const std::string& line) { ROS_INFO("%s", line.c_str()); }));
  for (const std::string& warning : vessel.warnings)
    ROS_WARN("%s", warning.c_str());
  for (const std::string& note : vessel.notes)
    ROS_INFO("%s: %s", vessel.source.c_str(), note.c_str());
  notes_ = vessel.notes;
  publishFrames(scene::resolveEntry(scene.entry, vessel, scene.file));
  publishVessel(vessel);
  scene_ = *scene.vessel;
  tree_ = vessel.centreline;
  click_subscriber_ = subscribeGuarded<geometry_msgs::PointStamped>(
      node_, names::kClickedPoint, kQueue,
      [this](const geometry_msgs::PointStampedConstPtr& click) { nameEnd(click); });
  if (simulation::hasBalloon(scene))
    serveWall(vessel);
  service_ = node_.advertiseService(names::kGetVessel, &VesselServerNode::get, this);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("vessel", this, &VesselServerNode::diagnose);
  diagnostics_timer_ = node_.createWallTimer(ros::WallDuration(1.0),
                                             [this](const ros::WallTimerEvent&) { publishDiagnostics(diagnostics_); });
  ROS_INFO("%s, %zu triangles, %zu branches", vessel.source.c_str(), vessel.mesh.triangles.size(),
           vessel.centreline.branches.size());
}

void VesselServerNode::publishVessel(const vessel::Vessel& vessel)
{
  mesh_.header.stamp = centreline_.header.stamp = ros::Time::now();
  mesh_.header.frame_id = centreline_.header.frame_id = names::kPatientFrame;
  mesh_.version = centreline_.version = 1;
  mesh_.source = vessel.source;
  toMessage(vessel.mesh, mesh_);
  centreline_.content_hash = mesh_.content_hash;
  toMessage(vessel.centreline, centreline_);
  toMessage(vessel.lesions, centreline_);
  mesh_publisher_ = node_.advertise<VesselMesh>(names::kVesselMesh, 1, true);
  centreline_publisher_ = node_.advertise<VesselCentreline>(names::kVesselCentreline, 1, true);
  marker_publisher_ = node_.advertise<visualization_msgs::Marker>(names::kVesselMarker, 1, true);
  centreline_publisher_.publish(centreline_);
  mesh_publisher_.publish(mesh_);
  marker_publisher_.publish(wallMarker(vessel.mesh));
}

void VesselServerNode::publishFrames(const scene::EntryPose& entry)
{
  // The introducer's x axis points into the vessel, its y axis along the wire's material direction d1 at rotation 0.
  Eigen::Matrix3d axes;
  axes << entry.direction, entry.d1, entry.direction.cross(entry.d1);
  const Eigen::Quaterniond rotation(axes);
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = names::kPatientFrame;
  transform.child_frame_id = names::kIntroducerFrame;
  transform.transform.translation = toVector(entry.position);
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  frames_.sendTransform(transform);
}

/** Prints which end of the vessel lies at a click, and the options that name it. */
void VesselServerNode::nameEnd(const geometry_msgs::PointStampedConstPtr& click)
{
  const std::string& frame = click->header.frame_id;
  if (frame != names::kPatientFrame)
  {
    ROS_WARN("a point was clicked in the frame \"%s\"; set the fixed frame of rviz to %s", frame.c_str(),
             names::kPatientFrame);
    return;
  }
  const Eigen::Vector3d point(click->point.x, click->point.y, click->point.z);
  ROS_INFO("%s", clickedEndText(tree_, scene_, point).c_str());
}

/** Subscribes to balloon loads. Their callback runs in the thread that reads them; meshes for display are published by
 *  another one. */
void VesselServerNode::serveWall(const vessel::Vessel& vessel)
{
  wall_ = std::make_unique<WallDeformationServer>(vessel);
  displacement_.header.frame_id = names::kPatientFrame;
  displacement_publisher_ = node_.advertise<WallDisplacement>(names::kWallDisplacement, kQueue);
  load_subscriber_ = subscribeGuarded<BalloonLoad>(
      node_, names::kBalloonLoad, kQueue,
      [this](const ros::MessageEvent<BalloonLoad const>& event)
      {
        load_source_.require(event.getPublisherName());
        receiveLoad(event.getConstMessage());
      },
      &queue_);
  republish_timer_ = node_.createWallTimer(ros::WallDuration(kRepublishPeriod),
                                           [this](const ros::WallTimerEvent&) { republish(false); });
  state_service_ = node_.advertiseService(names::kWallState, &VesselServerNode::replaceWall, this);
}

/** Real-time scheduling for the thread that reads the sockets: the contact node waits for its displacements. */
void VesselServerNode::requestRealTime()
{
  if (requested_real_time_)
    return;
  requested_real_time_ = true;
  if (!makeThreadRealTime(kPriority))
    ROS_WARN("real-time scheduling was refused: the simulation may wait for the wall under a balloon");
}

void VesselServerNode::receiveLoad(const BalloonLoadConstPtr& message)
{
  requestRealTime();
  out_of_step_ = !wall_->press(*message, displacement_);
  if (out_of_step_)
  {
    ROS_ERROR_THROTTLE(5.0,
                       "the load of rod_dynamics is for version %lu of the wall, this wall has version %lu: one of the "
                       "nodes was restarted; restart the session",
                       static_cast<unsigned long>(message->version - 1), static_cast<unsigned long>(wall_->version()));
    return;
  }
  displacement_.header.stamp = ros::Time::now();
  displacement_publisher_.publish(displacement_);
}

/** Saves, loads or resets the wall, once it has the version that the caller names. */
bool VesselServerNode::replaceWall(WallState::Request& request, WallState::Response& response)
{
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (wall_->version() < request.newest && ros::WallTime::now() < end)
    ros::WallDuration(1e-3).sleep();
  try
  {
    if (wall_->version() != request.newest)
      throw InputError(names::kWallState, "newest",
                       "is " + std::to_string(request.newest) + ", but this wall has version " +
                           std::to_string(wall_->version()) + ": one of the nodes was restarted; restart the session");
    applyTo(request, response);
    response.success = 1;
  }
  catch (const std::exception& error)
  {
    response.message = error.what();
  }
  response.version = wall_->version();
  response.base = wall_->base();
  response.at_risk = wall_->atRisk() ? 1 : 0;
  return true;
}

/** @throws std::exception for a refused request, which changes nothing */
void VesselServerNode::applyTo(WallState::Request& request, WallState::Response& response)
{
  switch (request.operation)
  {
    case WallState::Request::SAVE:
    {
      const std::string state = wall_->save(request.detected);
      response.state.assign(state.begin(), state.end());
      return;
    }
    case WallState::Request::LOAD:
      wall_->load(std::string(request.state.begin(), request.state.end()));
      break;
    case WallState::Request::RESET:
      wall_->reset();
      break;
    default:
      throw InputError(names::kWallState, "operation", "must be SAVE, LOAD or RESET");
  }
  republish(true);
}

/** Publishes the current wall for display and late subscribers.
 *  @param always false: only if it has moved */
void VesselServerNode::republish(bool always)
{
  const bool moved = always || wall_->version() != mesh_.version;
  const bool marker_is_due =
      (always || marker_version_ != wall_->version()) && marker_publisher_.getNumSubscribers() > 0;
  if (!moved && !marker_is_due)
    return;
  WallDeformationServer::Snapshot now = wall_->snapshot();
  for (const WallDisplacement& displacement : now.displacements)
    for (std::size_t k = 0; k < displacement.index.size(); ++k)
      now.mesh.vertices[displacement.index[k]] = fromMessage(displacement.position[k]);
  mesh_.header.stamp = ros::Time::now();
  mesh_.version = now.version + now.displacements.size();
  toMessage(now.mesh, mesh_);
  visualization_msgs::Marker marker;
  if (marker_is_due)
    marker = wallMarker(now.mesh);
  // ROS serialises large messages under a lock that the thread of the loads needs too. At the next lower real-time
  // priority only that thread can interrupt the serialisation.
  const bool granted = makeThreadRealTime(kPriority - 1);
  mesh_publisher_.publish(mesh_);
  if (marker_is_due)
    marker_publisher_.publish(marker);
  if (granted)
    leaveRealTime();
  if (marker_is_due)
    marker_version_ = mesh_.version;
}

bool VesselServerNode::get(GetVessel::Request&, GetVessel::Response& response)
{
  response.mesh = mesh_;
  if (wall_)
  {
    const WallDeformationServer::Snapshot now = wall_->snapshot();
    toMessage(now.mesh, response.mesh);
    response.mesh.version = now.version;
    response.moved = now.displacements;
    response.at_risk = wall_->atRisk() ? 1 : 0;
  }
  response.centreline = centreline_;
  return true;
}

void VesselServerNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  if (out_of_step_)
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "the balloon loads are for another version of the wall");
  else
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "published");
  status.add("source", mesh_.source);
  status.add("version", mesh_.version);
  status.add("content hash", Hash64::toHex(mesh_.content_hash));
  status.add("triangles", mesh_.mesh.triangles.size());
  status.add("branches", centreline_.branches.size());
  for (std::size_t n = 0; n < notes_.size(); ++n)
    status.add("note " + std::to_string(n + 1), notes_[n]);
  IgnoredMessages::ofProcess().diagnose(status);
}

}  // namespace endovascular_sim::nodes
