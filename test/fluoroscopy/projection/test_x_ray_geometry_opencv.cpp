#include "fluoroscopy/projection/x_ray_geometry.h"

#include <gtest/gtest.h>

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

#include "common/units.h"
#include "fluoroscopy/projection/vessel_projection.h"
#include "test/fluoroscopy/shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kDegree;

/** Pixel by OpenCV, from the camera matrix and the frame of a camera. */
Eigen::Vector2d projectedByOpenCv(const Eigen::Vector3d& point, const Eigen::Isometry3d& patient_from_camera,
                                  const Eigen::Matrix3d& matrix)
{
  const Eigen::Isometry3d camera_from_patient = patient_from_camera.inverse();
  const Eigen::AngleAxisd turn(camera_from_patient.linear());
  const Eigen::Vector3d rotation = turn.angle() * turn.axis(), translation = camera_from_patient.translation();
  cv::Matx33d k;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      k(row, column) = matrix(row, column);
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), point.z()}},
                    cv::Vec3d(rotation.x(), rotation.y(), rotation.z()),
                    cv::Vec3d(translation.x(), translation.y(), translation.z()), k, cv::noArray(), pixels);
  return {pixels.at(0).x, pixels.at(0).y};
}

/** Centroid of the path lengths in an image; @p mirrored: with its columns in reverse order. */
Eigen::Vector2d centroid(const std::vector<double>& image, int pixels, bool mirrored)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double total = 0.0;
  for (int row = 0; row < pixels; ++row)
    for (int column = 0; column < pixels; ++column)
    {
      const double value = image[static_cast<std::size_t>(row * pixels + column)];
      sum += value * Eigen::Vector2d(mirrored ? pixels - 1 - column : column, row);
      total += value;
    }
  return sum / total;
}

TEST(XRayGeometryOpenCv, ProjectsToTheRenderedPixelInBothViews)
{
  const Eigen::Vector3d point(0.03, -0.04, 0.33);
  const geometry::TriangleMesh ball = sphere(point, 0.004, 24, 48);
  for (const auto& [lao, cranial] : {std::pair(0, 0), {40, 0}, {-30, -20}, {45, 25}, {45, -30}, {90, 0}})
  {
    CArmPose pose;
    pose.primary_angle = lao * kDegree;
    pose.secondary_angle = cranial * kDegree;
    pose.isocentre = {0.01, -0.02, 0.3};
    const XRayGeometry geometry(pose);
    const std::vector<double> rendered = vesselPathLength(geometry, ball);
    const Eigen::Vector2d image = projectedByOpenCv(point, geometry.patientFromOptical(), geometry.cameraMatrix());
    EXPECT_LT((image - geometry.project(point)).norm(), 1e-6);
    EXPECT_LT((image - centroid(rendered, pose.pixels, false)).norm(), 0.02) << lao << " " << cranial;
    const Eigen::Vector2d view =
        projectedByOpenCv(point, geometry.patientFromSourceView(), geometry.sourceViewMatrix());
    EXPECT_LT((view - centroid(rendered, pose.pixels, true)).norm(), 0.02) << lao << " " << cranial;
  }
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
