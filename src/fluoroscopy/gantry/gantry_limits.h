#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Interval of a length [m]. */
struct LengthRange
{
  double min = 0.0, max = 0.0;
};

/** Limits and speeds of a C-arm and its table.
 *
 *  The defaults are chosen. They lie in the range that data sheets of floor- and ceiling-mounted C-arms give, without
 *  being those of one product. */
struct GantryLimits
{
  double primary = 120.0 / 180.0 * M_PI;       ///< largest magnitude of the primary angle [rad]
  double secondary = 55.0 / 180.0 * M_PI;      ///< largest magnitude of the secondary angle [rad]
  double angular_speed = 25.0 / 180.0 * M_PI;  ///< of both angles [rad/s]
  LengthRange source_to_detector{0.9, 1.3};    ///< SID [m]
  LengthRange source_to_patient{0.6, 0.9};     ///< SOD [m]
  double detector_speed = 0.1;                 ///< of SID and SOD [m/s]
  double clearance = 0.15;                     ///< smallest distance from the isocentre to the detector [m]
  /** Stroke of the table along x, y and z of the patient, half of it to either side of its home position [m]. */
  Eigen::Vector3d table_stroke{0.36, 0.28, 1.25};
  double table_speed = 0.15;  ///< along each axis [m/s]
};

bool operator==(const GantryLimits& a, const GantryLimits& b);
inline bool operator!=(const GantryLimits& a, const GantryLimits& b)
{
  return !(a == b);
}

/** Violation of a limit by a pose. */
struct LimitViolation
{
  std::string field;   ///< field of CArm.msg
  std::string key;     ///< key of a scene's `fluoroscopy`
  std::string remedy;  ///< value and allowed range
};

/** First limit that a pose violates; nothing for a pose within the limits. Values that are not finite violate them.
 *  @param home isocentre at the table's home position [m] */
std::optional<LimitViolation> limitViolation(const CArmPose& pose, const Eigen::Vector3d& home,
                                             const GantryLimits& limits);

}  // namespace endovascular_sim::fluoroscopy
