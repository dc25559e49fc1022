#include "rviz_plugin/picture/x_ray_marks.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/units.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

using units::kDegree;

/** Pose as docs/FLUOROSCOPY.md defines it, with the isocentre in the origin. */
XRayPose poseAt(double primary, double secondary)
{
  XRayPose pose;
  pose.right = {std::cos(primary), std::sin(primary), 0.0};
  pose.forward = {std::sin(primary) * std::cos(secondary), -std::cos(primary) * std::cos(secondary),
                  std::sin(secondary)};
  pose.source = -0.75 * pose.forward;
  return pose;
}

std::string angle(double primary, double secondary)
{
  return angleText(poseAt(primary * kDegree, secondary * kDegree).forward);
}

TEST(XRayMarks, NameTheAngleInClinicalNotation)
{
  EXPECT_EQ(angle(0, 0), "AP");
  EXPECT_EQ(angle(40, 0), "LAO 40");
  EXPECT_EQ(angle(-30, -20), "RAO 30 CAU 20");
  EXPECT_EQ(angle(0, 30), "CRA 30");
  EXPECT_EQ(angle(90, 0), "LAO 90");
  EXPECT_EQ(angle(45, -30), "LAO 45 CAU 30");
}

TEST(XRayMarks, NameTheSidesOfThePatient)
{
  const XRayMarks ap = xRayMarks(poseAt(0, 0), 1000.0, 512.0, Eigen::Vector3d::Zero(), 0.0);
  EXPECT_EQ(ap.right, "L") << "the patient's left is on the right of the image";
  EXPECT_EQ(ap.left, "R");
  const XRayMarks lateral = xRayMarks(poseAt(90 * kDegree, 0), 1000.0, 512.0, Eigen::Vector3d::Zero(), 0.0);
  EXPECT_EQ(lateral.right, "P") << "the spine is on the right";
  EXPECT_EQ(lateral.left, "A");
}

TEST(XRayMarks, TheBarHasItsLengthAtTheDepthOfTheTip)
{
  const XRayPose pose = poseAt(0.3, 0.2);
  for (const double depth : {0.6, 0.75, 0.9})
  {
    const Eigen::Vector3d tip = pose.source + depth * pose.forward + 0.02 * pose.right;
    const XRayMarks marks = xRayMarks(pose, 3000.0, 512.0, tip, 0.0);
    const double length = 1e-3 * std::stod(marks.scale);
    const auto column = [&](const Eigen::Vector3d& point)
    { return 3000.0 * pose.right.dot(point - pose.source) / pose.forward.dot(point - pose.source); };
    EXPECT_NEAR(marks.bar, column(tip + length * pose.right) - column(tip), 1e-9);
    EXPECT_LE(marks.bar, 0.25 * 512.0);
    EXPECT_GT(marks.bar, 0.05 * 512.0);
  }
}

TEST(XRayMarks, AreMissingBeforeThePoseIsKnown)
{
  const XRayMarks marks = xRayMarks(std::nullopt, 1000.0, 512.0, Eigen::Vector3d::Zero(), 75.9);
  EXPECT_EQ(marks.angle, "");
  EXPECT_EQ(marks.scale, "");
  EXPECT_EQ(marks.time, "1:15");
  XRayPose behind = poseAt(0, 0);
  EXPECT_EQ(xRayMarks(behind, 1000.0, 512.0, 2.0 * behind.source, 0.0).scale, "");
  EXPECT_EQ(xRayMarks(behind, 1000.0, 512.0, Eigen::Vector3d::Constant(std::nan("")), 0.0).scale, "");
}

TEST(XRayMarks, FluoroscopyTimeCountsWhileImagesCome)
{
  FluoroscopyTime time;
  for (int k = 0; k <= 15; ++k)
    time.addImage(10.0 + k / 15.0);
  EXPECT_NEAR(time.seconds(), 1.0, 1e-9);
  time.addImage(60.0);  // after a pause
  time.addImage(60.1);
  EXPECT_NEAR(time.seconds(), 1.1, 1e-9);
  time.addImage(0.0);  // a new run
  EXPECT_EQ(time.seconds(), 0.0);
}

TEST(XRayMarks, FluoroscopyTimeBeginsAnewWithARun)
{
  FluoroscopyTime time;
  for (int k = 0; k <= 10; ++k)
  {
    time.addState(5.0 + 0.1 * k);
    time.addImage(1000.0 + 0.1 * k);  // wall time, which goes on
  }
  EXPECT_NEAR(time.seconds(), 1.0, 1e-9);
  time.addState(5.5);  // a step of the procedure again
  EXPECT_EQ(time.seconds(), 0.0);
  time.addImage(1001.1);
  EXPECT_NEAR(time.seconds(), 0.1, 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
