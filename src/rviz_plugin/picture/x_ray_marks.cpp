#include "rviz_plugin/picture/x_ray_marks.h"

#include <algorithm>
#include <cmath>

#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kLongestBar = 0.25;               // relative to the width of the image
constexpr double kLongestGap = 2.0;                // between two images of one run [s]
constexpr double kBars[] = {50, 20, 10, 5, 2, 1};  // [mm]

/** Side of the patient in a direction. */
std::string sideOf(const Eigen::Vector3d& direction)
{
  if (std::abs(direction.x()) >= std::abs(direction.y()))
    return direction.x() > 0.0 ? "L" : "R";
  return direction.y() > 0.0 ? "P" : "A";
}

void appendAngle(double angle, const char* positive, const char* negative, std::string& text)
{
  const long degrees = std::lround(angle / units::kDegree);
  if (degrees == 0)
    return;
  text += (text.empty() ? "" : " ") + formatted("%s %ld", degrees > 0 ? positive : negative, std::labs(degrees));
}

}  // namespace

std::string angleText(const Eigen::Vector3d& forward)
{
  std::string text;
  appendAngle(std::atan2(forward.x(), -forward.y()), "LAO", "RAO", text);
  appendAngle(std::asin(std::clamp(forward.z(), -1.0, 1.0)), "CRA", "CAU", text);
  return text.empty() ? "AP" : text;
}

XRayMarks xRayMarks(const std::optional<XRayPose>& pose, double focal, double width, const Eigen::Vector3d& tip,
                    double seconds)
{
  XRayMarks marks;
  const long whole = std::lround(std::floor(seconds));
  marks.time = formatted("%ld:%02ld", whole / 60, whole % 60);
  if (!pose)
    return marks;
  marks.angle = angleText(pose->forward);
  marks.right = sideOf(pose->right);
  marks.left = sideOf(-pose->right);
  const double depth = pose->forward.dot(tip - pose->source);
  if (!(depth > 0.0) || !(focal > 0.0))
    return marks;
  const double pixels = 1e-3 * focal / depth;  // of a millimetre
  const auto* bar = std::find_if(std::begin(kBars), std::end(kBars) - 1,
                                 [&](double length) { return length * pixels <= kLongestBar * width; });
  marks.bar = *bar * pixels;
  marks.scale = formatted("%g mm", *bar);
  return marks;
}

void FluoroscopyTime::addImage(double stamp)
{
  if (stamp < last_)
    seconds_ = 0.0;
  else if (last_ >= 0.0 && stamp - last_ <= kLongestGap)
    seconds_ += stamp - last_;
  last_ = stamp;
}

void FluoroscopyTime::addState(double time)
{
  if (time < last_state_)
    seconds_ = 0.0;
  last_state_ = time;
}

}  // namespace endovascular_sim::rviz_plugin
