#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/Marker.h>

#include "endovascular_sim/BalloonLoad.h"
#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "endovascular_sim/WallState.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/one_source.h"
#include "nodes/vessel_server/wall_deformation_server.h"
#include "scene/model/scene.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::nodes
{

/** ROS node of the vessel: loads or generates the vessel of a scene and publishes it as latched topics, as a service,
 * as a marker for rviz and as static frames. Names the end at which a point is clicked in rviz. Displaces the wall
 * under balloon loads. */
class VesselServerNode
{
public:
  /** Builds and publishes the vessel. Without a vessel in the scene the node does nothing.
   *  @throws InputError when the vessel is invalid */
  VesselServerNode(const ros::NodeHandle& node, const scene::Scene& scene);

private:
  void publishVessel(const vessel::Vessel& vessel);
  void publishFrames(const scene::EntryPose& entry);
  void nameEnd(const geometry_msgs::PointStampedConstPtr& click);
  void serveWall(const vessel::Vessel& vessel);
  void receiveLoad(const BalloonLoadConstPtr& message);
  void requestRealTime();
  void republish(bool always);
  bool replaceWall(WallState::Request& request, WallState::Response& response);
  void applyTo(WallState::Request& request, WallState::Response& response);
  bool get(GetVessel::Request&, GetVessel::Response& response);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle node_;
  scene::VesselScene scene_;
  vessel::CentrelineTree tree_;
  VesselMesh mesh_;
  std::uint64_t marker_version_ = 1;  ///< version of the wall in the last marker
  VesselCentreline centreline_;
  std::vector<std::string> notes_;
  tf2_ros::StaticTransformBroadcaster frames_;
  ros::Publisher mesh_publisher_, centreline_publisher_, marker_publisher_;
  std::unique_ptr<WallDeformationServer> wall_;  ///< null without a balloon
  WallDisplacement displacement_;
  bool requested_real_time_ = false;  ///< used by the thread of receiveLoad() only
  std::atomic<bool> out_of_step_{false};
  ros::Publisher displacement_publisher_;
  OneSource load_source_;  ///< used by the thread of the loads only
  DirectCallbackQueue queue_;
  diagnostic_updater::Updater diagnostics_;
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber load_subscriber_, click_subscriber_;
  ros::WallTimer republish_timer_, diagnostics_timer_;
  ros::ServiceServer service_, state_service_;
};

}  // namespace endovascular_sim::nodes
