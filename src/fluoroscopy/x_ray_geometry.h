#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::fluoroscopy
{

/** Where the C-arm stands: DICOM's names and signs. */
struct CArmPose
{
  double primary_angle = 0.0;                           ///< Positioner Primary Angle, LAO positive [rad]
  double secondary_angle = 0.0;                         ///< Positioner Secondary Angle, cranial positive [rad]
  double source_to_detector = 1.2;                      ///< SID [m]
  double source_to_patient = 0.75;                      ///< SOD, source to isocentre [m]
  Eigen::Vector3d isocentre = Eigen::Vector3d::Zero();  ///< patient frame: x left, y posterior, z head [m]
  double detector_width = 0.3;                          ///< of the square detector [m]
  int pixels = 512;                                     ///< along a side of the image
};

bool operator==(const CArmPose& a, const CArmPose& b);
inline bool operator!=(const CArmPose& a, const CArmPose& b)
{
  return !(a == b);
}

/** The pinhole geometry of one C-arm pose.
 *
 *  With primary angle α and secondary angle β the axes in the patient frame (x left, y posterior, z head) are
 *
 *      right    = ( cos α,        sin α,        0     )   image columns grow along it
 *      up       = (−sin α sin β,  cos α sin β,  cos β )   image rows grow against it
 *      forward  = ( sin α cos β, −cos α cos β,  sin β )   from the source to the detector's centre
 *
 *  (DICOM PS3.3 C.8.7.5: the detector stands before the chest at α = β = 0, at the patient's left at α = +90°,
 *  towards the head at β > 0.) The source is at isocentre − SOD·forward. These axes, in this order, are the optical
 *  frame `x_ray_source_optical`: right-handed, z looks from the source to the detector, all that is seen has z > 0.
 *
 *  The displayed image has radiological orientation: the viewer faces the patient, so the patient's left is on the
 *  image's right in AP and the head is up. That is the view from the detector towards the source, the mirror image
 *  of what a camera at the source would see, and no rotation turns the one into the other. The mirror is in K:
 *
 *          ⎡ f  0   c ⎤    f = SID / pixel size,  c = (pixels − 1) / 2
 *      K = ⎢ 0 −f   c ⎥    column = K₀₀·x/z + c,  row = K₁₁·y/z + c  (centres of pixels at whole numbers)
 *          ⎣ 0  0   1 ⎦
 *
 *  so f_x is positive, f_y negative, and K times a point in the optical frame gives the pixel of the displayed
 *  image with no further flip. */
class XRayGeometry
{
public:
  /** @throws InputError for distances, widths or angles that no C-arm has */
  explicit XRayGeometry(const CArmPose& pose);

  const CArmPose& pose() const { return pose_; }
  int pixels() const { return pose_.pixels; }

  /** Position of the source in the patient frame [m]. */
  const Eigen::Vector3d& source() const { return source_; }

  /** Columns right, up, forward: from the optical to the patient frame. */
  const Eigen::Matrix3d& axes() const { return axes_; }

  /** From the optical frame of the source to the patient frame. */
  Eigen::Isometry3d patientFromOptical() const;

  /** Focal length SID / pixel size [pixel]. */
  double focalLength() const { return focal_length_; }

  /** Coordinate of the principal point, for rows and columns [pixel]. */
  double centre() const { return 0.5 * (pose_.pixels - 1); }

  /** Camera matrix K of the class comment. */
  Eigen::Matrix3d cameraMatrix() const;

  /** A point of the patient frame in the optical frame [m]. */
  Eigen::Vector3d toOptical(const Eigen::Vector3d& point) const { return axes_.transpose() * (point - source_); }

  /** Column and row [pixel] at which a point of the patient frame [m] appears; it must lie before the source. */
  Eigen::Vector2d project(const Eigen::Vector3d& point) const;

  /** Direction in the optical frame, z = 1, of the ray through column and row [pixel]. */
  Eigen::Vector3d ray(double column, double row) const
  {
    return {(column - centre()) / focal_length_, (centre() - row) / focal_length_, 1.0};
  }

private:
  CArmPose pose_;
  Eigen::Vector3d source_;
  Eigen::Matrix3d axes_;
  double focal_length_;
};

/** The pose after a table shift that brings @p tip [m] to the isocentre when it has left the central half of the
 *  field; otherwise the pose as it is. In one jump, so that the vessel is projected anew seldom. */
CArmPose followTip(const CArmPose& pose, const Eigen::Vector3d& tip);

}  // namespace endovascular_sim::fluoroscopy
