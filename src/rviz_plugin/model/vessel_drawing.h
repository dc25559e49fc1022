#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/VesselMesh.h"
#include "motion/map/motion_map.h"
#include "nodes/visualization/motion_history.h"
#include "visualization/colour_legend.h"
#include "visualization/wall_heat_map.h"
#include "visualization/wall_surface.h"

namespace endovascular_sim::rviz_plugin
{

/** Quantity of the heat map. */
enum class HeatQuantity
{
  kPeak,
  kIntegral,
  kTimeOverThreshold,
};

/** Surfaces of the wall and of its heat map in the moving patient. Independent of Ogre. */
class VesselDrawing
{
public:
  /** Replaces the wall.
   *  @return reason why nothing is drawn; empty for a valid message */
  std::string setVessel(const VesselMesh& message, const visualization::TranslucentColour& colour);

  /** Draws the heat map. The scale follows the largest value if @p full_scale is not positive. Maps of another vessel
   * are not drawn.
   *  @return reason why nothing is drawn; empty for a valid message */
  std::string setForces(const ContactForceMap& message, HeatQuantity quantity, double full_scale);

  /** Moves wall and heat map. Normals remain those at rest. The next wall and the next heat map have the same motion.
   *  @return false if nothing has moved */
  bool move(const motion::MotionMap& map);

  /** Opens the near wall around a point of the moved patient; see visualization::cutAway(). */
  void cutAway(const Eigen::Vector3d& point, double radius, float opacity);

  const visualization::Surface& wall() const { return wall_; }
  const visualization::Surface& heat() const { return heat_; }
  /** Vertices of the wall within the fade of the motion; only these ever move. */
  const std::vector<std::uint32_t>& movingVertices() const { return moving_; }
  double fullScale() const { return full_scale_; }  ///< of the heat map, in the unit of its quantity

private:
  void findMoving();
  void moveWall();
  void moveHeat();

  visualization::Surface wall_, heat_;
  std::vector<Eigen::Vector3d> rest_;         ///< vertices of the wall at rest [m]
  std::vector<Eigen::Vector3d> heat_rest_;    ///< the same of the heat map [m]
  std::vector<std::uint32_t> moving_;         ///< vertices within the fade
  std::vector<Eigen::Vector3d> moving_rest_;  ///< these vertices at rest [m]
  std::vector<Eigen::Vector3d> moved_;        ///< of the last motion; keeps its capacity [m]
  motion::MotionMap map_ = nodes::restingMap();
  std::unique_ptr<visualization::WallHeatMap> heat_map_;  ///< null before a valid vessel
  std::uint64_t hash_ = 0;                                ///< content hash of the initial wall
  double last_time_ = 0.0;                                ///< simulated time of the last map [s]
  HeatQuantity last_quantity_ = HeatQuantity::kPeak;
  visualization::FollowingScale scale_{0.05};
  double full_scale_ = 0.05;
};

}  // namespace endovascular_sim::rviz_plugin
