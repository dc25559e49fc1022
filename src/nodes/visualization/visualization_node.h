#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <visualization_msgs/Marker.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/PlayerState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselMesh.h"
#include "geometry/triangle_mesh.h"
#include "nodes/visualization/motion_history.h"
#include "visualization/colour_legend.h"
#include "visualization/force_colour.h"
#include "visualization/wall_heat_map.h"

namespace endovascular_sim::nodes
{

/** ROS node of visualization: publishes markers of the wire, the path of its tip, balloons, stents, the forces on the
 *  wall with their legend and, in a replay or a patient that moves, the vessel. */
class VisualizationNode
{
public:
  /** @param parameters handle of the private parameters */
  VisualizationNode(ros::NodeHandle node, const ros::NodeHandle& parameters);

private:
  static constexpr double kSmallestScale = 0.05;  ///< smallest value that is drawn red [N], [N·s] or [s]

  void drawWire(const RodStateVisual& state);
  std::vector<visualization::Colour> nodeColours(const RodStateVisual& state);
  /** @param tip in the resting patient [m] */
  void followTip(const std_msgs::Header& header, const Eigen::Vector3d& tip);
  void drawTipPath(const std_msgs::Header& header);
  void receiveVessel(const VesselMesh& vessel);
  void drawVessel(const std_msgs::Header& header);
  /** Moves vessel, forces and path of the tip with the patient. */
  void receiveMotion(const MotionState& message);
  void receiveTreatment(const TreatmentVisual& message);
  void drawBalloons(const TreatmentVisual& message);
  void drawStents(const TreatmentVisual& message);
  void receiveForceMap(const ContactForceMapConstPtr& map);
  void drawHeatMap(const ContactForceMap& map);
  void publishHeatMap();

  /** Forgets what follows from messages before a jump of a recording. */
  void receivePlayer(const PlayerState& player);
  void drawLegend(const std_msgs::Header& header);
  double forceScale() const { return full_scale_ > 0.0 ? full_scale_ : force_scale_.full(); }
  double heatScale() const { return heat_full_scale_ > 0.0 ? heat_full_scale_ : heat_scale_.full(); }

  ros::NodeHandle node_;
  double full_scale_;       ///< contact force at a node that is drawn red [N]; 0: follows
  double radius_scale_;     ///< drawn radius of the wire relative to its radius [1]
  std::string heat_of_;     ///< quantity of the heat map
  double heat_full_scale_;  ///< value of it that is drawn red [N], [N·s] or [s]; 0: follows
  visualization::FollowingScale force_scale_{kSmallestScale}, heat_scale_{kSmallestScale};
  std::string legend_;                                ///< published text
  geometry_msgs::Point legend_place_;                 ///< above the vessel, or at the first node without one [m]
  std::unique_ptr<visualization::WallHeatMap> heat_;  ///< null before the vessel
  std::uint64_t vessel_hash_ = 0;                     ///< content hash of the initial wall
  ContactForceMapConstPtr newest_map_;
  double last_time_ = -1.0;           ///< simulated time of the drawn wire [s]
  double last_treatment_ = -1.0;      ///< simulated time of the drawn treatment [s]
  std::deque<Eigen::Vector3d> path_;  ///< of the tip, in the resting patient [m]
  MotionHistory motions_;             ///< empty in a patient at rest
  motion::MotionMap map_ = restingMap();
  double last_moved_ = -1.0;  ///< simulated time of the drawn motion [s]
  geometry::TriangleMesh wall_;
  visualization::HeatPatch heat_patch_;     ///< in the resting patient
  visualization_msgs::Marker heat_marker_;  ///< without its points
  std::uint32_t jumps_ = 0;                 ///< of the player of a recording
  double largest_before_ = 0.0;             ///< largest force on a node up to the shown time of a recording [N]
  ros::Publisher wire_publisher_, tip_path_publisher_, balloon_publisher_, stent_publisher_, heat_publisher_,
      legend_publisher_;
  ros::Publisher vessel_publisher_;  ///< valid in a replay, and in a patient that moves
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber rod_subscriber_, vessel_subscriber_, force_map_subscriber_, treatment_subscriber_, player_subscriber_,
      motion_subscriber_;
};

}  // namespace endovascular_sim::nodes
