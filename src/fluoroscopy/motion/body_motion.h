#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fluoroscopy/motion/diaphragm_field.h"
#include "motion/map/motion_map.h"

namespace endovascular_sim::fluoroscopy
{

/** Motion of a patient in one X-ray frame: the map of the heart, and the displacement of the diaphragm.
 *
 *  A point x of the moved body was at X = y + d g(y) ẑ with y = φ⁻¹(x): φ is the map, d the displacement of the
 * diaphragm towards the feet, g the weight of DiaphragmField. Vessel and instruments know φ alone; g is 0 where the
 * coronary arteries are. */
class BodyMotion
{
public:
  /** Patient at rest. */
  BodyMotion();

  /** @param diaphragm displacement towards the feet [m] */
  BodyMotion(const motion::MotionMap& map, double diaphragm);

  const motion::MotionMap& map() const { return map_; }
  double diaphragm() const { return diaphragm_; }
  const DiaphragmField& field() const { return field_; }

  /** True if nothing is moved. */
  bool resting() const { return map_.resting() && diaphragm_ == 0.0; }

  /** Place at rest of a point of the moved body [m]. */
  Eigen::Vector3d pullBack(const Eigen::Vector3d& moved) const;

  /** Places at rest of many points, with the bits of the single ones. */
  void pullBack(const std::vector<Eigen::Vector3d>& moved, std::vector<Eigen::Vector3d>& rest) const;

  /** Box beyond which nothing ever moves, whatever the phase [m]. */
  Eigen::AlignedBox3d box() const;

  /** Part of a line beyond which nothing ever moves, whatever the phase.
   *  @param begin, end receive the parameters of both ends: origin + t · direction
   *  @return false if the line meets nothing that moves */
  bool clip(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double& begin, double& end) const;

private:
  motion::MotionMap map_;
  double diaphragm_;
  DiaphragmField field_;
};

/** True for equal motions of the same heart. */
bool operator==(const BodyMotion& a, const BodyMotion& b);
inline bool operator!=(const BodyMotion& a, const BodyMotion& b)
{
  return !(a == b);
}

/** True if both motions are of the same heart: equal places in which the patient moves. */
bool sameRegion(const motion::HeartFrame& a, const motion::HeartFrame& b);

}  // namespace endovascular_sim::fluoroscopy
