#include "fluoroscopy/gantry/gantry_limits.h"

#include <cmath>

#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kDegree;
constexpr double kTolerance = 1e-9;  // of rounded limits, e.g. 2.0943951 for 120° [m, rad]

bool isWithin(double value, double min, double max)
{
  return value >= min - kTolerance && value <= max + kTolerance;  // false for NaN
}

std::string angleText(double value, double limit)
{
  return formatted("is %.4g rad (%.4g°), beyond the gantry; must lie between %.4g and %.4g rad (%.4g° and %.4g°)",
                   value, value / kDegree, -limit, limit, -limit / kDegree, limit / kDegree);
}

std::string lengthText(double value, const LengthRange& range)
{
  return formatted("is %.4g m, beyond the gantry; must lie between %.4g and %.4g m", value, range.min, range.max);
}

}  // namespace

bool operator==(const GantryLimits& a, const GantryLimits& b)
{
  const auto equal = [](const LengthRange& x, const LengthRange& y) { return x.min == y.min && x.max == y.max; };
  return a.primary == b.primary && a.secondary == b.secondary && a.angular_speed == b.angular_speed &&
         equal(a.source_to_detector, b.source_to_detector) && equal(a.source_to_patient, b.source_to_patient) &&
         a.detector_speed == b.detector_speed && a.clearance == b.clearance && a.table_stroke == b.table_stroke &&
         a.table_speed == b.table_speed;
}

std::optional<LimitViolation> limitViolation(const CArmPose& pose, const Eigen::Vector3d& home,
                                             const GantryLimits& limits)
{
  if (!isWithin(pose.primary_angle, -limits.primary, limits.primary))
    return LimitViolation{"positioner_primary_angle", "primary_angle", angleText(pose.primary_angle, limits.primary)};
  if (!isWithin(pose.secondary_angle, -limits.secondary, limits.secondary))
    return LimitViolation{"positioner_secondary_angle", "secondary_angle",
                          angleText(pose.secondary_angle, limits.secondary)};
  const double sid = pose.source_to_detector, sod = pose.source_to_patient;
  if (!isWithin(sid, limits.source_to_detector.min, limits.source_to_detector.max))
    return LimitViolation{"distance_source_to_detector", "source_to_detector",
                          lengthText(sid, limits.source_to_detector)};
  if (!isWithin(sod, limits.source_to_patient.min, limits.source_to_patient.max))
    return LimitViolation{"distance_source_to_patient", "source_to_patient", lengthText(sod, limits.source_to_patient)};
  if (sod > sid - limits.clearance + kTolerance)
    return LimitViolation{"distance_source_to_patient", "source_to_patient",
                          formatted("is %.4g m, so that the detector at %.4g m touches the patient; must be at most "
                                    "%.4g m, %.4g m less than the distance of the detector",
                                    sod, sid, sid - limits.clearance, limits.clearance)};
  for (int axis = 0; axis < 3; ++axis)
  {
    const double middle = home[axis], half = 0.5 * limits.table_stroke[axis];
    if (!isWithin(pose.isocentre[axis], middle - half, middle + half))
      return LimitViolation{"isocentre", "isocentre",
                            formatted("%c is %.4g m, beyond the stroke of the table; must lie between %.4g and %.4g m",
                                      "xyz"[axis], pose.isocentre[axis], middle - half, middle + half)};
  }
  return std::nullopt;
}

}  // namespace endovascular_sim::fluoroscopy
