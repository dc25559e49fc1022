#include "fluoroscopy/projection/vessel_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/error.h"
#include "test/fluoroscopy/shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

CArmPose smallPose(int pixels)
{
  CArmPose pose;
  pose.pixels = pixels;
  pose.detector_width = 0.1;
  pose.primary_angle = 0.5;
  pose.secondary_angle = -0.2;
  return pose;
}

/** Path length of a ray inside a mesh by brute force (Möller–Trumbore). */
double castRay(const Eigen::Vector3d& s, const Eigen::Vector3d& d, const geometry::TriangleMesh& mesh)
{
  double sum = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d ab = mesh.vertices[static_cast<std::size_t>(t[1])] - a;
    const Eigen::Vector3d ac = mesh.vertices[static_cast<std::size_t>(t[2])] - a;
    const Eigen::Vector3d normal = ab.cross(ac);
    const double facing = normal.dot(d);
    const Eigen::Vector3d moment = (s - a).cross(d);
    const double v = -ac.dot(moment) / facing, w = ab.dot(moment) / facing;
    if (facing != 0.0 && v >= 0.0 && w >= 0.0 && v + w <= 1.0)
      sum += (facing > 0.0 ? 1.0 : -1.0) * normal.dot(a - s) / facing;
  }
  return sum * d.norm();
}

double at(const std::vector<double>& map, int pixels, int row, int column)
{
  return map[static_cast<std::size_t>(row * pixels + column)];
}

/** Compares the projection with brute force: a loose bound of every pixel, and a tight bound of the mean. Grazing
 *  facets amplify the rounding of vertices to 1/4096 pixel (0.1 µm at the isocentre). */
void expectBruteForce(const geometry::TriangleMesh& mesh, const CArmPose& pose)
{
  const XRayGeometry geometry(pose);
  const std::vector<double> map = vesselPathLength(geometry, mesh);
  double longest = 0.0, error = 0.0;
  for (int row = 0; row < pose.pixels; ++row)
    for (int column = 0; column < pose.pixels; ++column)
    {
      const double exact = castRay(geometry.source(), geometry.axes() * geometry.ray(column, row), mesh);
      longest = std::max(longest, exact);
      error += std::abs(at(map, pose.pixels, row, column) - exact) / static_cast<double>(map.size());
      ASSERT_NEAR(at(map, pose.pixels, row, column), exact, 5e-5) << row << " " << column;
    }
  EXPECT_GT(longest, 1e-3);
  EXPECT_LT(error, 2e-7);
}

TEST(VesselPathLength, EqualsBruteForceRayCastingOnASphere)
{
  // Asymmetric position: no central ray intersects an edge, for which the brute force has no fill rule.
  expectBruteForce(sphere({1.234e-3, -2.3e-3, 0.7e-3}, 0.02, 13, 17), smallPose(64));
}

TEST(VesselPathLength, EqualsBruteForceRayCastingOnOverlappingFoldedShapes)
{
  geometry::TriangleMesh mesh = cylinder({-0.02, 0.001, -0.015}, {0.021, 0.003, 0.017}, 0.004, 23);
  const geometry::TriangleMesh other = cylinder({-0.018, -0.03, 0.013}, {0.023, 0.04, -0.019}, 0.003, 19);
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Eigen::Vector3i& t : other.triangles)
    mesh.triangles.emplace_back(t.array() + offset);
  expectBruteForce(mesh, smallPose(64));
}

TEST(VesselPathLength, EqualsTheChordOfASphere)
{
  const CArmPose pose = smallPose(64);
  const XRayGeometry geometry(pose);
  const Eigen::Vector3d centre(0.005, 0.003, -0.004);
  const std::vector<double> map = vesselPathLength(geometry, sphere(centre, 0.02, 200, 400));
  for (int row = 0; row < pose.pixels; ++row)
    for (int column = 0; column < pose.pixels; ++column)
    {
      const double exact = chordInSphere(geometry.source(), geometry.axes() * geometry.ray(column, row), centre, 0.02);
      if (exact > 0.0 && exact <= 0.01)
        continue;  // dominated by the sagitta of the facets
      EXPECT_NEAR(at(map, pose.pixels, row, column), exact, 2e-5) << row << " " << column;
    }
}

TEST(VesselPathLength, EqualsTheDiameterAcrossACylinderOnItsAxis)
{
  CArmPose pose;
  pose.pixels = 65;  // the image centre is a pixel centre
  const XRayGeometry geometry(pose);
  const auto map = vesselPathLength(geometry, cylinder({0.0, 0.0, -0.05}, {0.0, 0.0, 0.05}, 0.004, 360));
  EXPECT_NEAR(at(map, 65, 32, 32), 0.008, 1e-6);
  for (int row = 28; row < 37; ++row)
  {
    const Eigen::Vector3d ray = geometry.ray(32, row);
    EXPECT_NEAR(at(map, 65, row, 32), 0.008 * ray.norm(), 1e-6);
  }
}

TEST(VesselPathLength, CountsEveryPixelOnceWithEdgesAndVerticesOnPixelCentres)
{
  // Diagonals and vertices of the far side of a box at the isocentre project onto pixel centres. A missed or double
  // intersection would change a path length by the distance to the source.
  CArmPose pose;
  pose.pixels = 65;
  const XRayGeometry geometry(pose);
  const double near = 0.74, far = 0.75, pixel = 1.0 / geometry.focalLength();
  geometry::TriangleMesh mesh;
  for (const double depth : {near, far})
    for (const auto& corner : {Eigen::Vector2d(-8, -8), Eigen::Vector2d(8, -8), Eigen::Vector2d(8, 8),
                               Eigen::Vector2d(-8, 8), Eigen::Vector2d(0, 0)})
      mesh.vertices.emplace_back(
          geometry.source() + geometry.axes() * (depth * Eigen::Vector3d(corner.x() * pixel, corner.y() * pixel, 1.0)));
  for (int k = 0; k < 4; ++k)
  {
    const int a = k, b = (k + 1) % 4;
    mesh.triangles.emplace_back(4, b, a);
    mesh.triangles.emplace_back(9, 5 + a, 5 + b);
    mesh.triangles.emplace_back(a, b, 5 + b);
    mesh.triangles.emplace_back(a, 5 + b, 5 + a);
  }
  ASSERT_GT(mesh.signedVolume(), 0.0);
  const std::vector<double> map = vesselPathLength(geometry, mesh);
  int inside = 0;
  for (int row = 0; row < 65; ++row)
    for (int column = 0; column < 65; ++column)
    {
      const double length = at(map, 65, row, column);
      if (length == 0.0)
        continue;
      ++inside;
      EXPECT_NEAR(length, (far - near) * geometry.ray(column, row).norm(), 1e-9);
    }
  EXPECT_EQ(inside, 16 * 16);  // the fill rule includes the pixels on two of the four sides
}

TEST(VesselPathLength, PreservesItsTotalAtAnySubPixelShift)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> shift(-1e-3, 1e-3);
  for (int k = 0; k < 20; ++k)
  {
    const CArmPose pose = smallPose(64);
    const XRayGeometry geometry(pose);
    const Eigen::Vector3d centre(shift(random), shift(random), shift(random));
    const auto map = vesselPathLength(geometry, sphere(centre, 0.015, 40, 80));
    // A leak would change one pixel by about ±0.75 m.
    for (const double length : map)
      ASSERT_LT(length, 0.0301);
    double volume = 0.0;
    for (int row = 0; row < 64; ++row)
      for (int column = 0; column < 64; ++column)
        volume += at(map, 64, row, column) * std::pow(0.75 / geometry.focalLength(), 2);
    EXPECT_NEAR(volume, 4.0 / 3.0 * M_PI * std::pow(0.015, 3), 0.03 * volume);
  }
}

TEST(VesselPathLength, EndsAtTheDetector)
{
  CArmPose pose;
  pose.pixels = 65;
  const XRayGeometry geometry(pose);
  const Eigen::Vector3d forward = geometry.axes().col(2);
  const auto map = vesselPathLength(
      geometry, cylinder(geometry.source() + 1.15 * forward, geometry.source() + 1.35 * forward, 0.03, 40));
  EXPECT_NEAR(at(map, 65, 32, 32), 0.05, 1e-9);
}

TEST(VesselPathLength, RejectsAVesselAroundTheSource)
{
  const CArmPose pose;
  EXPECT_THROW(vesselPathLength(XRayGeometry(pose), sphere({0.0, 0.75, 0.0}, 0.02, 10, 10)), InputError);
  EXPECT_THROW(requireVesselInFrontOfSource(XRayGeometry(pose), sphere({0.0, 0.9, 0.0}, 0.02, 10, 10)), InputError);
  EXPECT_NO_THROW(requireVesselInFrontOfSource(XRayGeometry(pose), sphere({0.0, 0.0, 0.0}, 0.02, 10, 10)));
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
