#include "fluoroscopy/projection/x_ray_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/error.h"
#include "common/units.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kDegree;
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

TEST(XRayGeometry, ShowsKnownPointsInSixViewsWithinAHundredthOfAPixel)
{
  // From another program, which turns the C-arm by two rotations and intersects rays with the plane of the detector.
  struct Known
  {
    double lao, cranial;
    Eigen::Vector3d point;
    Eigen::Vector2d pixel;
  };
  const Known known[] = {
      {0, 0, {0.06, -0.02, 0.3}, {385.8704, 255.5000}},      {0, 0, {0.01, -0.06, 0.33}, {255.5000, 181.3947}},
      {0, 0, {-0.02, 0.01, 0.27}, {173.8768, 337.1232}},     {90, 0, {0.06, -0.02, 0.3}, {255.5000, 255.5000}},
      {90, 0, {0.01, -0.06, 0.33}, {151.2037, 177.2778}},    {90, 0, {-0.02, 0.01, 0.27}, {337.1232, 337.1232}},
      {40, 0, {0.06, -0.02, 0.3}, {351.1020, 255.5000}},     {40, 0, {0.01, -0.06, 0.33}, {191.1963, 180.4709}},
      {40, 0, {-0.02, 0.01, 0.27}, {245.2573, 338.6003}},    {-30, -20, {0.06, -0.02, 0.3}, {372.2122, 278.5466}},
      {-30, -20, {0.01, -0.06, 0.33}, {306.0821, 154.2379}}, {-30, -20, {-0.02, 0.01, 0.27}, {148.6379, 338.8040}},
      {45, 25, {0.06, -0.02, 0.3}, {343.7579, 292.7994}},    {45, 25, {0.01, -0.06, 0.33}, {185.4774, 217.7812}},
      {45, 25, {-0.02, 0.01, 0.27}, {255.5000, 281.4876}},   {45, -30, {0.06, -0.02, 0.3}, {343.9254, 211.2873}},
      {45, -30, {0.01, -0.06, 0.33}, {182.7113, 152.2449}},  {45, -30, {-0.02, 0.01, 0.27}, {255.5000, 382.3855}},
  };
  for (const Known& expected : known)
  {
    CArmPose view = pose(expected.lao, expected.cranial);
    view.isocentre = {0.01, -0.02, 0.3};
    view.source_to_detector = 1.1;
    view.source_to_patient = 0.72;
    const Eigen::Vector2d pixel = XRayGeometry(view).project(expected.point);
    EXPECT_LT((pixel - expected.pixel).norm(), 0.01) << expected.lao << " " << expected.cranial << ": " << pixel;
  }
}

TEST(XRayGeometry, MagnifiesByTheRatioOfTheDistances)
{
  for (const double sid : {0.9, 1.1, 1.3})
    for (const double sod : {0.6, 0.75})
    {
      CArmPose view = pose(35, -15);
      view.source_to_detector = sid;
      view.source_to_patient = sod;
      const XRayGeometry geometry(view);
      const Eigen::Vector2d shift = geometry.project(view.isocentre + 0.02 * geometry.axes().col(0)) -
                                    geometry.project(view.isocentre - 0.02 * geometry.axes().col(0));
      EXPECT_NEAR(shift.norm() * view.detector_width / view.pixels, 0.04 * sid / sod, 1e-12);
    }
}

TEST(XRayGeometry, TheSourceViewIsTheImageWithItsColumnsReversed)
{
  const XRayGeometry geometry(pose(37, -21));
  const Eigen::Matrix3d axes = geometry.patientFromSourceView().linear();
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-14);
  EXPECT_GT(geometry.sourceViewMatrix()(0, 0), 0.0);
  EXPECT_EQ(geometry.sourceViewMatrix()(1, 1), geometry.sourceViewMatrix()(0, 0));
  for (const Eigen::Vector3d& shift : {kLeft, kPosterior, kHead})
  {
    const Eigen::Vector3d point = geometry.pose().isocentre + 0.04 * shift;
    const Eigen::Vector3d image = geometry.sourceViewMatrix() * (geometry.patientFromSourceView().inverse() * point);
    const Eigen::Vector2d pixel = geometry.project(point);
    EXPECT_TRUE(image.hnormalized().isApprox(Eigen::Vector2d(511.0 - pixel.x(), pixel.y()), 1e-12));
  }
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
  rejected([](CArmPose& p) { p.field_width = 0.31; });
  rejected([](CArmPose& p) { p.field_height = -0.1; });
  rejected([](CArmPose& p) { p.field_height = std::numeric_limits<double>::quiet_NaN(); });
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
