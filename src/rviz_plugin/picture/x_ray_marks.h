#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

namespace endovascular_sim::rviz_plugin
{

/** Pose of the X-ray source in the patient frame; the axes are those of the image (docs/FLUOROSCOPY.md). */
struct XRayPose
{
  Eigen::Vector3d source = Eigen::Vector3d::Zero();                                       ///< [m]
  Eigen::Vector3d right = Eigen::Vector3d::UnitX(), forward = -Eigen::Vector3d::UnitY();  ///< unit
};

/** Marks on an X-ray image. */
struct XRayMarks
{
  std::string angle;        ///< in clinical notation, e.g. LAO 40 CRA 20
  std::string left, right;  ///< sides of the patient at the edges of the image: R, L, A or P
  std::string scale;        ///< length of the bar at the depth of the tip, e.g. 20 mm; empty: no bar
  double bar = 0.0;         ///< length of the bar [image pixels]
  std::string time;         ///< fluoroscopy time, minutes and seconds
};

/** Angulation in clinical notation, to the degree: AP, LAO 40, RAO 30 CAU 20. @param forward from source to detector */
std::string angleText(const Eigen::Vector3d& forward);

/** @param pose nothing before it is known
 *  @param focal distance of the detector [image pixels]
 *  @param width of the image [pixels]
 *  @param tip point at whose depth the scale holds [m]
 *  @param seconds fluoroscopy time [s] */
XRayMarks xRayMarks(const std::optional<XRayPose>& pose, double focal, double width, const Eigen::Vector3d& tip,
                    double seconds);

/** Fluoroscopy time: the sum of the intervals of consecutive images. */
class FluoroscopyTime
{
public:
  /** Takes over an image. @param stamp simulated or wall time [s]; an earlier one begins anew */
  void addImage(double stamp);
  /** Takes over the state of the simulation. @param time simulated time [s]; an earlier one, of a new run, begins anew
   */
  void addState(double time);
  double seconds() const { return seconds_; }

private:
  double last_ = -1.0;        ///< negative: no image yet
  double last_state_ = -1.0;  ///< negative: no state yet
  double seconds_ = 0.0;
};

}  // namespace endovascular_sim::rviz_plugin
