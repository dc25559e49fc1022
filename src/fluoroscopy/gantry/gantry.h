#pragma once

#include <Eigen/Core>

#include "fluoroscopy/gantry/gantry_limits.h"
#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** C-arm and table that move towards a target pose with limited speeds.
 *
 *  Angles, distances and the three axes of the table move independently, each at its largest speed, and stop at the
 *  target. Detector width and image size change at once. The table carries the patient: in the patient frame its motion
 *  is one of the isocentre. SID and SOD move at equal speeds, so that the detector keeps its clearance on the way. The
 *  motion depends on the durations passed to advance() only; no clock is read. */
class Gantry
{
public:
  /** @param start pose; its isocentre is the home position of the table
   *  @throws InputError for a pose beyond the limits */
  Gantry(const GantryLimits& limits, const CArmPose& start);

  const CArmPose& pose() const { return pose_; }
  const CArmPose& target() const { return target_; }
  bool isMoving() const { return pose_ != target_; }

  /** Sets the target.
   *  @throws InputError with field and allowed range for an invalid target or one beyond the limits; the present target
   *          is retained */
  void moveTo(const CArmPose& target);

  /** Moves the target of the table to an isocentre [m], as far as the stroke allows. */
  void panTo(const Eigen::Vector3d& isocentre);

  /** Moves towards the target.
   *  @param duration [s]; nothing moves for a negative or invalid one
   *  @return true if the pose has changed */
  bool advance(double duration);

  /** Places the patient with a point [m] at the isocentre: without motion, with the table at home. */
  void placePatient(const Eigen::Vector3d& isocentre);

  /** Stops at a pose, e.g. the last one before a collision. */
  void stopAt(const CArmPose& pose);

private:
  GantryLimits limits_;
  Eigen::Vector3d home_;  ///< isocentre at the home position of the table [m]
  CArmPose pose_, target_;
};

}  // namespace endovascular_sim::fluoroscopy
