#include <atomic>
#include <memory>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/Marker.h>

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/hash.h"
#include "endovascular_sim/GetVessel.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/real_time.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"
#include "nodes/vessel_server/wall_deformation_server.h"
#include "scene/scene_vessel.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 100;               // of pressings and answers: none may be lost
constexpr int kPriority = 50;             // below the contact node's, which asks
constexpr double kRepublishPeriod = 0.5;  // s between two meshes of a wall that moves

/** Loads or makes the scene's vessel and hands it out: latched topics, a service, rviz's marker, static frames. Moves
 *  its wall where balloons press. */
class VesselServer
{
public:
  explicit VesselServer(ros::NodeHandle& node) : node_(node)
  {
    const scene::Scene scene = sceneFromParameters(node_);
    if (!scene.vessel)
    {
      ROS_INFO("vessel_server: the scene %s has no vessel, so there is nothing to do", scene.name.c_str());
      return;
    }
    ROS_INFO("vessel_server: preparing the vessel of %s", scene.file.c_str());
    const vessel::Vessel vessel =
        scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired);
    for (const std::string& note : vessel.notes)
      ROS_INFO("vessel_server: %s: %s", vessel.source.c_str(), note.c_str());
    notes_ = vessel.notes;
    fillMessages(vessel);
    publishFrames(scene::resolveEntry(scene.entry, vessel, scene.file));
    mesh_publisher_ = node_.advertise<VesselMesh>(names::kVesselMesh, 1, true);
    centreline_publisher_ = node_.advertise<VesselCentreline>(names::kVesselCentreline, 1, true);
    marker_publisher_ = node_.advertise<visualization_msgs::Marker>(names::kVesselMarker, 1, true);
    centreline_publisher_.publish(centreline_);
    mesh_publisher_.publish(mesh_);
    marker_publisher_.publish(marker(vessel.mesh));
    if (simulation::hasBalloon(scene))
      keepWall(vessel);
    service_ = node_.advertiseService(names::kGetVessel, &VesselServer::get, this);
    diagnostics_.setHardwareID("none");
    diagnostics_.add("vessel", this, &VesselServer::diagnose);
    timer_ =
        node_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.update(); });
    ROS_INFO("vessel_server: %s, %zu triangles, %zu branches", vessel.source.c_str(), vessel.mesh.triangles.size(),
             vessel.centreline.branches.size());
  }

private:
  /** Pressings are answered in the thread that reads them: meshes for pictures are made in another one. */
  void keepWall(const vessel::Vessel& vessel)
  {
    wall_ = std::make_unique<WallDeformationServer>(vessel);
    moved_.header.frame_id = names::kPatientFrame;
    moved_publisher_ = node_.advertise<WallDisplacement>(names::kWallDisplacement, kQueue);
    ros::NodeHandle direct(node_);
    direct.setCallbackQueue(&queue_);
    pressing_subscriber_ = direct.subscribe(names::kBalloonLoad, kQueue, &VesselServer::receivePressing, this,
                                            ros::TransportHints().tcpNoDelay());
    republish_timer_ =
        node_.createWallTimer(ros::WallDuration(kRepublishPeriod), [this](const ros::WallTimerEvent&) { republish(); });
  }

  void receivePressing(const BalloonLoadConstPtr& message)
  {
    // In the thread that reads the sockets: contact waits for its answers, pictures for the rest of this process.
    if (!asked_for_real_time_ && !makeThreadRealTime(kPriority))
      ROS_WARN("vessel_server: real-time scheduling was refused: the simulation may wait for a wall that is pressed");
    asked_for_real_time_ = true;
    try
    {
      lost_ = !wall_->press(*message, moved_);
    }
    catch (const InputError& error)
    {
      ROS_WARN_THROTTLE(1.0, "vessel_server: %s", error.what());
      return;
    }
    if (lost_)
    {
      ROS_ERROR_THROTTLE(
          5.0,
          "vessel_server: rod_dynamics presses on version %lu, this wall is version %lu: one of both was "
          "started anew; start the session again",
          static_cast<unsigned long>(message->version - 1), static_cast<unsigned long>(wall_->version()));
      return;
    }
    moved_.header.stamp = ros::Time::now();
    moved_publisher_.publish(moved_);
  }

  /** For pictures and late joiners: the wall as it is, when it has moved. */
  void republish()
  {
    const bool moved = wall_->version() != mesh_.version;
    const bool unseen = marker_version_ != wall_->version() && marker_publisher_.getNumSubscribers() > 0;
    if (!moved && !unseen)
      return;
    WallDeformationServer::Snapshot now = wall_->snapshot();
    for (const WallDisplacement& moved_then : now.moved)
      for (std::size_t k = 0; k < moved_then.index.size(); ++k)
        now.mesh.vertices[moved_then.index[k]] = fromMessage(moved_then.position[k]);
    mesh_.header.stamp = ros::Time::now();
    mesh_.version = now.version + now.moved.size();
    mesh_.content_hash = now.mesh.hash();
    toMessage(now.mesh, mesh_);
    visualization_msgs::Marker pictured;
    if (unseen)
      pictured = marker(now.mesh);
    // ROS writes out messages of megabytes under a lock that the pressing thread needs for its small ones: nobody but
    // that thread may come between.
    const bool granted = makeThreadRealTime(kPriority - 1);
    mesh_publisher_.publish(mesh_);
    if (unseen)
      marker_publisher_.publish(pictured);
    if (granted)
      leaveRealTime();
    if (unseen)
      marker_version_ = mesh_.version;
  }

  void fillMessages(const vessel::Vessel& vessel)
  {
    mesh_.header.stamp = centreline_.header.stamp = ros::Time::now();
    mesh_.header.frame_id = centreline_.header.frame_id = names::kPatientFrame;
    mesh_.version = centreline_.version = 1;
    mesh_.content_hash = centreline_.content_hash = vessel.mesh.hash();
    mesh_.source = vessel.source;
    toMessage(vessel.mesh, mesh_);
    toMessage(vessel.centreline, centreline_);
    toMessage(vessel.lesions, centreline_);
  }

  static visualization_msgs::Marker marker(const geometry::TriangleMesh& mesh)
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

  void publishFrames(const scene::EntryPose& entry)
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

  bool get(GetVessel::Request&, GetVessel::Response& response)
  {
    response.mesh = mesh_;
    if (wall_)
    {
      const WallDeformationServer::Snapshot now = wall_->snapshot();
      toMessage(now.mesh, response.mesh);
      response.mesh.version = now.version;
      response.mesh.content_hash = now.mesh.hash();
      response.moved = now.moved;
    }
    response.centreline = centreline_;
    return true;
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
  {
    if (lost_)
      status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "does not know the wall that the rod presses on");
    else
      status.summary(diagnostic_msgs::DiagnosticStatus::OK, "published");
    status.add("source", mesh_.source);
    status.add("version", mesh_.version);
    status.add("content hash", Hash64::toHex(mesh_.content_hash));
    status.add("triangles", mesh_.mesh.triangles.size());
    status.add("branches", centreline_.branches.size());
    for (std::size_t n = 0; n < notes_.size(); ++n)
      status.add("note " + std::to_string(n + 1), notes_[n]);
  }

  ros::NodeHandle node_;
  VesselMesh mesh_;
  std::uint64_t marker_version_ = 1;  ///< of the wall in the last marker
  VesselCentreline centreline_;
  std::vector<std::string> notes_;
  tf2_ros::StaticTransformBroadcaster frames_;
  ros::Publisher mesh_publisher_, centreline_publisher_, marker_publisher_;
  std::unique_ptr<WallDeformationServer> wall_;  ///< null without a balloon
  WallDisplacement moved_;
  bool asked_for_real_time_ = false;  ///< the pressing thread's
  std::atomic<bool> lost_{false};
  ros::Publisher moved_publisher_;
  DirectCallbackQueue queue_;
  ros::Subscriber pressing_subscriber_;
  ros::WallTimer republish_timer_;
  ros::ServiceServer service_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer timer_;
};

}  // namespace
}  // namespace endovascular_sim::nodes

int main(int argc, char** argv)
{
  endovascular_sim::nodes::keepOffLockStepCpu();
  ros::init(argc, argv, "vessel_server");
  ros::NodeHandle node;
  try
  {
    endovascular_sim::nodes::VesselServer server(node);
    ros::spin();
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("vessel_server: %s", error.what());
    return 1;
  }
  return 0;
}
