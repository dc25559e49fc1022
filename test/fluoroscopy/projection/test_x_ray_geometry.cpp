#include "fluoroscopy/projection/x_ray_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kDegree = M_PI / 180.0;
const Eigen::Vector3d kLeft(1.0, 0.0, 0.0), kPosterior(0.0, 1.0, 0.0), kHead(0.0, 0.0, 1.0);

CArmPose pose(double lao, double cranial)
{
  CArmPose pose;
  pose.primary_angle = lao * kDegree;
  pose.secondary_angle = cranial * kDegree;
  pose.isocentre = {0.01, 0.02, 0.3};
  return pose;
}

/** Displacement on the screen, (right, up), of a point 50 mm from the isocentre. */
Eigen::Vector2d onScreen(const CArmPose& pose, const Eigen::Vector3d& direction)
{
  const XRayGeometry geometry(pose);
  const Eigen::Vector2d shift = geometry.project(pose.isocentre + 0.05 * direction) - geometry.project(pose.isocentre);
  return {shift.x(), -shift.y()};
}

TEST(XRayGeometry, ShowsThePatientsLeftOnTheRightAndTheHeadUpInAp)
{
  EXPECT_GT(onScreen(pose(0, 0), kLeft).x(), 50.0);
  EXPECT_NEAR(onScreen(pose(0, 0), kLeft).y(), 0.0, 1e-9);
  EXPECT_GT(onScreen(pose(0, 0), kHead).y(), 50.0);
  EXPECT_NEAR(onScreen(pose(0, 0), kHead).x(), 0.0, 1e-9);
}

TEST(XRayGeometry, HasThePosteriorSourceInAp)
{
  const CArmPose ap = pose(0, 0);
  EXPECT_TRUE(XRayGeometry(ap).source().isApprox(ap.isocentre + ap.source_to_patient * kPosterior));
}

TEST(XRayGeometry, PutsTheDetectorAtThePatientsLeftAtLao90AndTheSpineOnTheImagesRight)
{
  const CArmPose lao = pose(90, 0);
  EXPECT_TRUE(XRayGeometry(lao).source().isApprox(lao.isocentre - lao.source_to_patient * kLeft));
  EXPECT_GT(onScreen(lao, kPosterior).x(), 50.0);
  EXPECT_GT(onScreen(pose(45, 0), kPosterior).x(), 30.0);
}

TEST(XRayGeometry, ShowsTheSpineOnTheImagesLeftInRao)
{
  EXPECT_LT(onScreen(pose(-45, 0), kPosterior).x(), -30.0);
}

TEST(XRayGeometry, MovesTheDetectorToTheHeadWithCranialAngulation)
{
  const CArmPose cranial = pose(0, 30);
  EXPECT_LT(XRayGeometry(cranial).source().z(), cranial.isocentre.z());
  // With cranial angulation, points posterior of the isocentre move up on the screen.
  EXPECT_GT(onScreen(cranial, kPosterior).y(), 20.0);
  EXPECT_LT(onScreen(pose(0, -30), kPosterior).y(), -20.0);
}

TEST(XRayGeometry, HasRightHandedAxesAndTheIsocentreOnTheCentralRayAtAllAngles)
{
  for (double lao = -180; lao <= 180; lao += 30)
    for (double cranial = -90; cranial <= 90; cranial += 30)
    {
      const XRayGeometry geometry(pose(lao, cranial));
      EXPECT_TRUE((geometry.axes().transpose() * geometry.axes()).isIdentity(1e-14));
      EXPECT_NEAR(geometry.axes().determinant(), 1.0, 1e-14);
      EXPECT_TRUE(geometry.toOptical(geometry.pose().isocentre).isApprox(Eigen::Vector3d(0.0, 0.0, 0.75)));
    }
}

TEST(XRayGeometry, ProjectionEqualsCameraMatrixTimesTransform)
{
  const XRayGeometry geometry(pose(37, -21));
  const Eigen::Vector3d point = geometry.pose().isocentre + Eigen::Vector3d(0.03, -0.05, 0.02);
  const Eigen::Vector3d image = geometry.cameraMatrix() * (geometry.patientFromOptical().inverse() * point);
  EXPECT_TRUE(image.hnormalized().isApprox(geometry.project(point), 1e-12));
  const Eigen::Vector2d pixel = geometry.project(point);
  const Eigen::Vector3d ray = geometry.axes() * geometry.ray(pixel.x(), pixel.y());
  EXPECT_NEAR(ray.normalized().cross((point - geometry.source()).normalized()).norm(), 0.0, 1e-12);
}

TEST(XRayGeometry, HasAFocalLengthOfSourceToDetectorOverPixelSize)
{
  EXPECT_DOUBLE_EQ(XRayGeometry(pose(0, 0)).focalLength(), 1.2 / (0.3 / 512));
}

TEST(XRayGeometry, RejectsInvalidPoses)
{
  const auto rejected = [](auto change)
  {
    CArmPose bad = pose(0, 0);
    change(bad);
    EXPECT_THROW(XRayGeometry{bad}, InputError);
  };
  rejected([](CArmPose& p) { p.primary_angle = 4.0; });
  rejected([](CArmPose& p) { p.secondary_angle = std::numeric_limits<double>::quiet_NaN(); });
  rejected([](CArmPose& p) { p.source_to_patient = 0.0; });
  rejected([](CArmPose& p) { p.source_to_detector = 0.7; });
  rejected([](CArmPose& p) { p.detector_width = -0.3; });
  rejected([](CArmPose& p) { p.pixels = 0; });
  rejected([](CArmPose& p) { p.isocentre.x() = std::numeric_limits<double>::infinity(); });
}

TEST(PanToTip, DoesNotMoveWhileTheTipIsInTheCentralHalf)
{
  const CArmPose start = pose(30, 10);
  const XRayGeometry geometry(start);
  const double quarter = 0.25 * 0.3 * 0.75 / 1.2;  // quarter of the field of view at the isocentre [m]
  EXPECT_EQ(panToTip(start, start.isocentre + 0.99 * quarter * geometry.axes().col(0)), start);
  EXPECT_EQ(panToTip(start, start.isocentre + 0.99 * quarter * geometry.axes().col(1)), start);
}

TEST(PanToTip, MovesTheIsocentreToATipOutsideTheCentralHalf)
{
  const CArmPose start = pose(30, 10);
  const double quarter = 0.25 * 0.3 * 0.75 / 1.2;
  for (int axis : {0, 1})
  {
    const Eigen::Vector3d tip = start.isocentre - 1.01 * quarter * XRayGeometry(start).axes().col(axis);
    CArmPose expected = start;
    expected.isocentre = tip;
    EXPECT_EQ(panToTip(start, tip), expected);
  }
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
