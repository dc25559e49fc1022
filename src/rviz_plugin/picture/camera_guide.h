#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "motion/map/motion_map.h"
#include "nodes/visualization/motion_history.h"

namespace endovascular_sim::rviz_plugin
{

/** Pose of a camera. */
struct CameraPose
{
  Eigen::Vector3d eye = -Eigen::Vector3d::UnitY();  ///< [m]
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();  ///< point in the middle of the picture [m]
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();    ///< unit, normal to the direction of view
};

enum class ViewMode
{
  kOverview,     ///< the whole vessel
  kFollowTip,    ///< the tip in the middle, from a fixed direction
  kAlongVessel,  ///< in the vessel behind the tip, towards the tip
};

/** Direction and distance that the user sets by the mouse. */
struct ViewSetting
{
  double yaw = 0.0;       ///< of the camera about the patient's axis; 0: in front of the patient [rad]
  double pitch = 0.1;     ///< of the camera above the focus [rad]
  double distance = 0.0;  ///< from the focus [m]; 0: that of the mode. In the overview, that in which the vessel fits
  double covered = 0.0;   ///< part of the picture at its lower edge that legends cover; the overview leaves it free
};

/** Point that follows a target as a critically damped spring: without a jump of its velocity and without overshoot of a
 * step. The motion does not depend on the frame rate while the target is constant. */
class SmoothPoint
{
public:
  void jumpTo(const Eigen::Vector3d& point);
  /** @param rate natural frequency of the spring [rad/s] */
  const Eigen::Vector3d& follow(const Eigen::Vector3d& target, double rate, double seconds);
  const Eigen::Vector3d& point() const { return point_; }

private:
  Eigen::Vector3d point_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
};

/** Smooth motion of a camera after the tip. The picture does not roll: in the overview and behind the tip the patient's
 * axis stays vertical; along the vessel the upper side is transported with the least rotation.
 *
 *  The camera moves in the resting patient: in the overview and behind the tip it stands still while the heart beats.
 *  Along the vessel it then moves with the patient, so that it stays in the lumen. */
class CameraGuide
{
public:
  explicit CameraGuide(ViewMode mode) : mode_(mode) {}

  /** Takes over the centreline; invalid points are ignored. */
  void setVessel(const VesselCentreline& message);
  /** Takes over the tip and its path; a message with an invalid point is ignored.
   *  @param map motion of the patient at the state of the message */
  void setWire(const RodStateVisual& message, const motion::MotionMap& map = nodes::restingMap());

  /** Begins at a pose, from which the camera then moves smoothly. */
  void beginAt(const CameraPose& pose);

  /** Moves the camera.
   *  @param seconds since the last call
   *  @param aspect width of the picture relative to its height
   *  @param field_of_view vertical angle [rad] */
  CameraPose advance(const ViewSetting& setting, double seconds, double aspect, double field_of_view);

  /** Distance of the camera from the focus with a setting, in the end [m]. */
  double distance(const ViewSetting& setting, double aspect, double field_of_view) const
  {
    return targetOf(setting, aspect, field_of_view).offset.norm();
  }

private:
  struct Target
  {
    Eigen::Vector3d focus, offset;
  };
  Target targetOf(const ViewSetting& setting, double aspect, double field_of_view) const;
  double fittingDistance(const ViewSetting& setting, double aspect, double field_of_view) const;
  Target alongTheVessel(double distance) const;
  void moveWithPatient(CameraPose& pose) const;
  Eigen::Vector3d centre() const { return 0.5 * (low_ + high_); }

  ViewMode mode_;
  std::vector<Eigen::Vector3d> centreline_;
  std::vector<double> radii_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Constant(-0.2);   ///< lower corner of the vessel's box [m]
  Eigen::Vector3d high_ = Eigen::Vector3d::Constant(+0.2);  ///< upper corner [m]
  std::vector<Eigen::Vector3d> wire_;                       ///< in the resting patient [m]
  motion::MotionMap map_ = nodes::restingMap();
  SmoothPoint focus_, offset_, up_;
  bool has_begun_ = false;
};

}  // namespace endovascular_sim::rviz_plugin
