#include "fluoroscopy/projection/x_ray_geometry.h"

#include <cmath>

#include "common/error.h"
#include "common/units.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kPi;
constexpr int kMaxPixels = 4096;
constexpr double kSmallestField = 0.02;  // [m]

void require(bool condition, const char* key, const char* remedy)
{
  if (!condition)
    throw InputError("C-arm", key, remedy);
}

void check(const CArmPose& pose)
{
  require(std::isfinite(pose.primary_angle) && std::abs(pose.primary_angle) <= kPi, "positioner_primary_angle",
          "must lie between -pi (RAO) and pi (LAO) [rad]");
  require(std::isfinite(pose.secondary_angle) && std::abs(pose.secondary_angle) <= 0.5 * kPi,
          "positioner_secondary_angle", "must lie between -pi/2 (caudal) and pi/2 (cranial) [rad]");
  require(std::isfinite(pose.source_to_patient) && pose.source_to_patient > 0.0, "distance_source_to_patient",
          "must be positive [m]");
  require(std::isfinite(pose.source_to_detector) && pose.source_to_detector > pose.source_to_patient,
          "distance_source_to_detector", "must be greater than distance_source_to_patient [m]");
  require(std::isfinite(pose.detector_width) && pose.detector_width > 0.0 &&
              pose.detector_width <= 2.0 * pose.source_to_detector,
          "detector_width", "must be positive and at most twice distance_source_to_detector [m]");
  const auto is_field = [&pose](double side)
  { return side == 0.0 || (side >= kSmallestField && side <= pose.detector_width); };
  require(is_field(pose.field_width), "field_width",
          "must lie between 0.02 m and detector_width; 0 opens the collimator");
  require(is_field(pose.field_height), "field_height",
          "must lie between 0.02 m and detector_width; 0 opens the collimator");
  require(pose.pixels >= 2 && pose.pixels <= kMaxPixels, "pixels", "must lie between 2 and 4096");
  require(pose.isocentre.allFinite(), "isocentre", "must be finite [m]");
}

}  // namespace

bool operator==(const CArmPose& a, const CArmPose& b)
{
  return a.primary_angle == b.primary_angle && a.secondary_angle == b.secondary_angle &&
         a.source_to_detector == b.source_to_detector && a.source_to_patient == b.source_to_patient &&
         a.isocentre == b.isocentre && a.detector_width == b.detector_width && a.pixels == b.pixels &&
         a.field_width == b.field_width && a.field_height == b.field_height;
}

XRayGeometry::XRayGeometry(const CArmPose& pose) : pose_(pose)
{
  check(pose);
  const double ca = std::cos(pose.primary_angle), sa = std::sin(pose.primary_angle);
  const double cb = std::cos(pose.secondary_angle), sb = std::sin(pose.secondary_angle);
  axes_.col(0) = Eigen::Vector3d(ca, sa, 0.0);
  axes_.col(1) = Eigen::Vector3d(-sa * sb, ca * sb, cb);
  axes_.col(2) = Eigen::Vector3d(sa * cb, -ca * cb, sb);
  source_ = pose.isocentre - pose.source_to_patient * axes_.col(2);
  focal_length_ = pose.source_to_detector / (pose.detector_width / pose.pixels);
}

Eigen::Isometry3d XRayGeometry::patientFromOptical() const
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = axes_;
  transform.translation() = source_;
  return transform;
}

Eigen::Matrix3d XRayGeometry::cameraMatrix() const
{
  Eigen::Matrix3d k;
  k << focal_length_, 0.0, centre(), 0.0, -focal_length_, centre(), 0.0, 0.0, 1.0;
  return k;
}

Eigen::Isometry3d XRayGeometry::patientFromSourceView() const
{
  Eigen::Isometry3d transform = patientFromOptical();
  transform.linear().leftCols<2>() *= -1.0;
  return transform;
}

Eigen::Matrix3d XRayGeometry::sourceViewMatrix() const
{
  Eigen::Matrix3d k = cameraMatrix();
  k(1, 1) = focal_length_;
  return k;
}

Eigen::Vector2d XRayGeometry::project(const Eigen::Vector3d& point) const
{
  const Eigen::Vector3d p = toOptical(point);
  return {centre() + focal_length_ * p.x() / p.z(), centre() - focal_length_ * p.y() / p.z()};
}

CArmPose panToTip(const CArmPose& pose, const Eigen::Vector3d& tip)
{
  const XRayGeometry geometry(pose);
  const Eigen::Vector3d p = geometry.toOptical(tip);
  const double quarter = 0.25 * pose.detector_width / pose.source_to_detector * p.z();
  if (p.z() > 0.0 && std::abs(p.x()) <= quarter && std::abs(p.y()) <= quarter)
    return pose;
  CArmPose moved = pose;
  moved.isocentre = tip;
  return moved;
}

}  // namespace endovascular_sim::fluoroscopy
