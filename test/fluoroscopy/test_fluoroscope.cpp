#include "fluoroscopy/fluoroscope.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/error.h"
#include "fluoroscopy/image/detector.h"
#include "test/fluoroscopy/shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

XRayScene scene()
{
  XRayScene scene;
  scene.tissue_attenuation = 21.5;
  scene.vessel_attenuation = 135.0;
  scene.tissue_thickness = 0.2;
  return scene;
}

std::size_t nearestPixel(const XRayGeometry& geometry, const Eigen::Vector3d& point)
{
  const Eigen::Vector2d pixel = geometry.project(point);
  return static_cast<std::size_t>(std::lround(pixel.y()) * geometry.pixels() + std::lround(pixel.x()));
}

TEST(Fluoroscope, ShowsTissueOnTheCentralRayAtHalfScale)
{
  Fluoroscope fluoroscope(CArmPose{}, scene());
  const Frame& frame = fluoroscope.render({});
  const std::size_t centre = nearestPixel(fluoroscope.geometry(), {0.0, 0.0, 0.0});
  EXPECT_NEAR(frame.raw[centre], Detector::kBackgroundSignal, 2.0);
  EXPECT_NEAR(frame.image[centre], 208, 1);
  EXPECT_LT(frame.raw[0], frame.raw[centre]);  // longer path through the slab
}

TEST(Fluoroscope, AttenuatesByTheDifferenceOfVesselAndTissue)
{
  Fluoroscope fluoroscope(CArmPose{}, scene());
  fluoroscope.setVessel(sphere({0.0, 0.0, 0.0}, 0.01, 60, 120));
  const Frame& frame = fluoroscope.render({});
  const double expected = Detector::kBackgroundSignal * std::exp(-(135.0 - 21.5) * 0.02);
  EXPECT_NEAR(frame.raw[nearestPixel(fluoroscope.geometry(), {0.0, 0.0, 0.0})], expected, 0.005 * expected);
}

/** Centroid (column, row) of all pixels darker than @p signal. */
Eigen::Vector2d centreOfShadow(const Frame& frame, int signal)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (int row = 0; row < frame.pixels; ++row)
    for (int column = 0; column < frame.pixels; ++column)
      if (frame.raw[static_cast<std::size_t>(row * frame.pixels + column)] < signal)
      {
        sum += Eigen::Vector2d(column, row);
        count += 1.0;
      }
  return sum / count;
}

TEST(Fluoroscope, RendersKnownPointsAtTheirProjectionAtAnyAngle)
{
  const Eigen::Vector3d bead(0.03, -0.02, 0.04);  // left, anterior and superior of the isocentre
  XRayWire wire;
  wire.nodes = {0.5 * bead - Eigen::Vector3d(0.0, 0.0, 1e-3), 0.5 * bead + Eigen::Vector3d(0.0, 0.0, 1e-3)};
  wire.radius = {1e-3, 1e-3};
  wire.attenuation = {5000.0};
  for (const double lao : {0.0, 0.8, -0.8, 1.5707963})
    for (const double cranial : {0.0, 0.4, -0.4})
    {
      CArmPose pose;
      pose.primary_angle = lao;
      pose.secondary_angle = cranial;
      Fluoroscope fluoroscope(pose, scene());
      const Eigen::Isometry3d optical = fluoroscope.geometry().patientFromOptical().inverse();
      const Eigen::Matrix3d k = fluoroscope.geometry().cameraMatrix();
      EXPECT_LT(
          (centreOfShadow(fluoroscope.render({wire}), 15000) - (k * (optical * (0.5 * bead))).hnormalized()).norm(),
          0.5);
      fluoroscope.setVessel(sphere(bead, 0.004, 30, 60));
      EXPECT_LT((centreOfShadow(fluoroscope.render({}), 22000) - (k * (optical * bead)).hnormalized()).norm(), 0.5);
    }
}

TEST(Fluoroscope, DarkensOnlyThePixelsOfTheWire)
{
  Fluoroscope fluoroscope(CArmPose{}, scene());
  fluoroscope.setVessel(cylinder({0.0, 0.0, -0.05}, {0.0, 0.0, 0.05}, 0.004, 60));
  const Frame before = fluoroscope.render({});
  XRayWire wire;
  wire.nodes = {{0.0, 0.0, -0.04}, {0.0, 0.0, 0.04}};
  wire.radius = {0.18e-3, 0.18e-3};
  wire.attenuation = {760.0 - 135.0};
  const Frame with = fluoroscope.render({wire});
  int darker = 0;
  for (std::size_t k = 0; k < with.raw.size(); ++k)
  {
    EXPECT_LE(with.raw[k], before.raw[k]);
    EXPECT_LE(with.image[k], before.image[k]);
    darker += with.image[k] < before.image[k] ? 1 : 0;
  }
  EXPECT_GT(darker, 200);
  EXPECT_LT(darker, 1000);
  EXPECT_EQ(fluoroscope.render({}).raw, before.raw);
}

TEST(Fluoroscope, EqualsANewInstanceAfterMovesAndNewVessels)
{
  CArmPose lao;
  lao.primary_angle = 0.7;
  const geometry::TriangleMesh first = sphere({0.0, 0.0, 0.0}, 0.01, 20, 20);
  const geometry::TriangleMesh second = sphere({0.01, 0.0, 0.02}, 0.012, 20, 20);
  Fluoroscope used(CArmPose{}, scene());
  used.setVessel(first);
  used.render({});
  used.setPose(lao);
  Fluoroscope moved(lao, scene());
  moved.setVessel(first);
  EXPECT_EQ(used.render({}).raw, moved.render({}).raw);
  used.setVessel(second);
  Fluoroscope changed(lao, scene());
  changed.setVessel(second);
  EXPECT_EQ(used.render({}).image, changed.render({}).image);
  EXPECT_NE(used.render({}).raw, moved.render({}).raw);
}

TEST(Fluoroscope, RetainsPoseAndVesselAfterARejection)
{
  Fluoroscope fluoroscope(CArmPose{}, scene());
  fluoroscope.setVessel(sphere({0.0, 0.0, 0.0}, 0.01, 20, 20));
  const Frame before = fluoroscope.render({});
  CArmPose bad;
  bad.isocentre = {0.0, -0.75, 0.0};  // source inside the vessel
  EXPECT_THROW(fluoroscope.setPose(bad), InputError);
  EXPECT_THROW(fluoroscope.setVessel(sphere({0.0, 0.75, 0.0}, 0.01, 20, 20)), InputError);
  EXPECT_EQ(fluoroscope.geometry().pose(), CArmPose{});
  EXPECT_EQ(fluoroscope.render({}).raw, before.raw);
  EXPECT_THROW(Fluoroscope(CArmPose{}, XRayScene{-1.0, 0.0, 0.0}), InputError);
}

TEST(Detector, DarkensWithEveryAbsorber)
{
  EXPECT_GT(Detector::grey(1.0, 1.0), Detector::grey(0.64, 1.0) + 30);
  EXPECT_GT(Detector::grey(0.64, 1.0), Detector::grey(0.05, 1.0) + 40);
  EXPECT_GE(Detector::grey(0.05, 1.0), Detector::grey(0.05, 0.8) + 18);
  EXPECT_EQ(Detector::grey(0.05, 0.0), 0);
  EXPECT_EQ(Detector::grey(100.0, 1.0), 255);
  EXPECT_EQ(Detector::signal(100.0), 65535);
  EXPECT_EQ(Detector::signal(0.5), 16384);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
