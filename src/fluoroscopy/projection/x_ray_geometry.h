#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::fluoroscopy
{

/** Pose of the C-arm in DICOM's terms and sign conventions. */
struct CArmPose
{
  double primary_angle = 0.0;                           ///< Positioner Primary Angle, LAO positive [rad]
  double secondary_angle = 0.0;                         ///< Positioner Secondary Angle, cranial positive [rad]
  double source_to_detector = 1.2;                      ///< SID [m]
  double source_to_patient = 0.75;                      ///< SOD, source to isocentre [m]
  Eigen::Vector3d isocentre = Eigen::Vector3d::Zero();  ///< patient frame: x left, y posterior, z superior [m]
  double detector_width = 0.3;                          ///< width of the square detector [m]
  int pixels = 512;                                     ///< pixels per side of the image
  double field_width = 0.0;                             ///< of the collimated field at the detector [m]; 0: open
  double field_height = 0.0;                            ///< of the collimated field at the detector [m]; 0: open
};

bool operator==(const CArmPose& a, const CArmPose& b);
inline bool operator!=(const CArmPose& a, const CArmPose& b)
{
  return !(a == b);
}

/** Pinhole camera model of one C-arm pose.
 *
 *  With primary angle α and secondary angle β, the axes in the patient frame (x left, y posterior, z superior) are
 *
 *      right    = ( cos α,        sin α,        0     )   direction of increasing image columns
 *      up       = (−sin α sin β,  cos α sin β,  cos β )   direction of decreasing image rows
 *      forward  = ( sin α cos β, −cos α cos β,  sin β )   from the source to the detector's centre
 *
 *  (DICOM PS3.3 C.8.7.5: the detector is anterior of the chest at α = β = 0, at the patient's left at α = +90°, and
 *  towards the head at β > 0.) The source is at isocentre − SOD·forward. These axes, in this order, are the optical
 *  frame `x_ray_source_optical`: right-handed, with z from the source to the detector. Visible points have z > 0.
 *
 *  The displayed image has radiological orientation: in AP the patient's left is on the right of the image, and the
 *  head is up. It is the view from the detector towards the source, the mirror image of the view of a camera at the
 *  source. The camera matrix K contains the reflection:
 *
 *          ⎡ f  0   c ⎤    f = SID / pixel size,  c = (pixels − 1) / 2
 *      K = ⎢ 0 −f   c ⎥    column = K₀₀·x/z + c,  row = K₁₁·y/z + c  (pixel centres at integers)
 *          ⎣ 0  0   1 ⎦
 *
 *  Therefore f_x is positive, f_y is negative, and K maps a point of the optical frame to the pixel of the displayed
 *  image without a further flip.
 *
 *  The source view is the image of a camera at the source, for programs that require positive focal lengths: the
 *  displayed image with its columns in reverse order. Its optical frame `x_ray_source_view_optical` has the axes
 *  (−right, −up, forward): x along increasing columns, y along increasing rows. */
class XRayGeometry
{
public:
  /** @throws InputError for invalid distances, widths or angles */
  explicit XRayGeometry(const CArmPose& pose);

  const CArmPose& pose() const { return pose_; }
  int pixels() const { return pose_.pixels; }

  /** Position of the source in the patient frame [m]. */
  const Eigen::Vector3d& source() const { return source_; }

  /** Rotation from the optical to the patient frame, with the columns right, up, forward. */
  const Eigen::Matrix3d& axes() const { return axes_; }

  /** Transform from the optical to the patient frame. */
  Eigen::Isometry3d patientFromOptical() const;

  /** Focal length SID / pixel size [pixel]. */
  double focalLength() const { return focal_length_; }

  /** Row and column of the principal point [pixel]. */
  double centre() const { return 0.5 * (pose_.pixels - 1); }

  /** Camera matrix K of the class comment. */
  Eigen::Matrix3d cameraMatrix() const;

  /** Transform from the optical frame of the source view to the patient frame. */
  Eigen::Isometry3d patientFromSourceView() const;

  /** Camera matrix of the source view, with the focal lengths f_x = f_y = f > 0. */
  Eigen::Matrix3d sourceViewMatrix() const;

  /** Transforms a point from the patient frame to the optical frame [m]. */
  Eigen::Vector3d toOptical(const Eigen::Vector3d& point) const { return axes_.transpose() * (point - source_); }

  /** Projects a point of the patient frame [m] to column and row [pixel].
   *  @pre the point lies in front of the source */
  Eigen::Vector2d project(const Eigen::Vector3d& point) const;

  /** Direction of the ray through a pixel in the optical frame, with z = 1. */
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

/** Pose after table panning: moves the isocentre to @p tip [m] if the tip is outside of the central half of the field
 *  of view. A single large shift keeps the number of background renderings small. */
CArmPose panToTip(const CArmPose& pose, const Eigen::Vector3d& tip);

}  // namespace endovascular_sim::fluoroscopy
