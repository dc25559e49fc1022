#include "fluoroscopy/gantry/gantry.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Moves a value towards its target by at most @p step. */
void approach(double& value, double target, double step)
{
  value = std::abs(target - value) <= step ? target : value + std::copysign(step, target - value);
}

void check(const CArmPose& pose, const Eigen::Vector3d& home, const GantryLimits& limits)
{
  if (const std::optional<LimitViolation> violation = limitViolation(pose, home, limits))
    throw InputError("C-arm", violation->field, violation->remedy);
  XRayGeometry{pose};
}

}  // namespace

Gantry::Gantry(const GantryLimits& limits, const CArmPose& start)
  : limits_(limits), home_(start.isocentre), pose_(start), target_(start)
{
  check(start, home_, limits_);
}

void Gantry::moveTo(const CArmPose& target)
{
  check(target, home_, limits_);
  target_ = target;
}

void Gantry::panTo(const Eigen::Vector3d& isocentre)
{
  if (!isocentre.allFinite())
    return;
  const Eigen::Vector3d half = 0.5 * limits_.table_stroke;
  target_.isocentre = isocentre.cwiseMax(home_ - half).cwiseMin(home_ + half);
}

bool Gantry::advance(double duration)
{
  if (!(duration > 0.0) || !isMoving())
    return false;
  CArmPose next = target_;
  next.primary_angle = pose_.primary_angle;
  next.secondary_angle = pose_.secondary_angle;
  next.source_to_detector = pose_.source_to_detector;
  next.source_to_patient = pose_.source_to_patient;
  next.isocentre = pose_.isocentre;
  approach(next.primary_angle, target_.primary_angle, limits_.angular_speed * duration);
  approach(next.secondary_angle, target_.secondary_angle, limits_.angular_speed * duration);
  approach(next.source_to_detector, target_.source_to_detector, limits_.detector_speed * duration);
  approach(next.source_to_patient, target_.source_to_patient, limits_.detector_speed * duration);
  for (int axis = 0; axis < 3; ++axis)
    approach(next.isocentre[axis], target_.isocentre[axis], limits_.table_speed * duration);
  const bool changed = next != pose_;
  pose_ = next;
  return changed;
}

void Gantry::placePatient(const Eigen::Vector3d& isocentre)
{
  home_ = isocentre;
  pose_.isocentre = isocentre;
  target_.isocentre = isocentre;
}

void Gantry::stopAt(const CArmPose& pose)
{
  pose_ = target_ = pose;
}

}  // namespace endovascular_sim::fluoroscopy
