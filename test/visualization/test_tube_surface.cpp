#include "visualization/tube_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "common/time/processor_time.h"

namespace endovascular_sim::visualization
{
namespace
{

TubeAxis helix(std::size_t count, double radius)
{
  TubeAxis axis;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double t = 0.05 * static_cast<double>(i);
    axis.add({0.02 * std::cos(t), 0.02 * std::sin(t), 0.005 * t}, radius, {{1.0F, 0.5F, 0.25F}, 0.5F});
  }
  return axis;
}

double volume(const Surface& surface)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < surface.triangles.size(); i += 3)
  {
    const auto corner = [&](std::size_t k)
    { return Eigen::Vector3d(surface.positions[surface.triangles[i + k]].cast<double>()); };
    sum += corner(0).dot(corner(1).cross(corner(2)));
  }
  return sum / 6.0;
}

TEST(TubeSurface, OfAStraightTubeHasTheVolumeOfAPrism)
{
  TubeAxis axis;
  for (const double z : {0.0, 0.05, 0.1})
    axis.add({0.0, 0.0, z}, 1e-3, {});
  Surface surface;
  TubeBuilder(8).append(axis, surface);
  EXPECT_NEAR(volume(surface), 0.5 * 8 * std::sin(2 * M_PI / 8) * 1e-6 * 0.1, 1e-13);
}

TEST(TubeSurface, HasUnitNormalsThatAgreeWithItsTriangles)
{
  Surface surface;
  TubeBuilder(12).append(helix(200, 3e-4), surface);
  for (const Eigen::Vector3f& normal : surface.normals)
    EXPECT_NEAR(normal.norm(), 1.0F, 1e-5F);
  for (std::size_t i = 0; i < surface.triangles.size(); i += 3)
  {
    const auto at = [&](std::size_t k) { return surface.triangles[i + k]; };
    const Eigen::Vector3f face = (surface.positions[at(1)] - surface.positions[at(0)])
                                     .cross(surface.positions[at(2)] - surface.positions[at(0)])
                                     .normalized();
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_GT(face.dot(surface.normals[at(k)]), 0.9F);
  }
}

TEST(TubeSurface, IsClosed)
{
  Surface surface;
  TubeBuilder(12).append(helix(50, 3e-4), surface);
  // Vertices of the discs are copies: edges are compared by positions.
  std::map<std::array<float, 6>, int> edges;
  for (std::size_t i = 0; i < surface.triangles.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Eigen::Vector3f& a = surface.positions[surface.triangles[i + k]];
      const Eigen::Vector3f& b = surface.positions[surface.triangles[i + (k + 1) % 3]];
      ++edges[{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
    }
  for (const auto& [edge, count] : edges)
  {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge[3], edge[4], edge[5], edge[0], edge[1], edge[2]}), 1U);
  }
}

TEST(TubeSurface, KeepsTheRadiusAndTheColourOfEachPoint)
{
  TubeAxis axis = helix(30, 3e-4);
  for (std::size_t point = 0; point < axis.points.size(); ++point)
    axis.radii[point] += 1e-6 * static_cast<double>(point);
  Surface surface;
  TubeBuilder(12).append(axis, surface);
  for (std::size_t point = 0; point < axis.points.size(); ++point)
    for (std::size_t side = 0; side < 12; ++side)
    {
      const std::size_t vertex = 12 * point + side;
      EXPECT_NEAR((surface.positions[vertex].cast<double>() - axis.points[point]).norm(), axis.radii[point], 1e-8);
      EXPECT_EQ(surface.colours[vertex].opacity, 0.5F);
      EXPECT_EQ(surface.colours[vertex].colour.blue, 0.25F);
    }
}

TEST(TubeSurface, DoesNotTwist)
{
  const TubeAxis axis = helix(400, 3e-4);
  Surface surface;
  TubeBuilder(12).append(axis, surface);
  for (std::size_t point = 0; point + 1 < axis.points.size(); ++point)
  {
    const Eigen::Vector3f turn = surface.normals[12 * (point + 1)] - surface.normals[12 * point];
    EXPECT_LT(turn.norm(), 0.06F);  // a turn of the helix's tangent is 0.05 rad at most
  }
}

TEST(TubeSurface, SkipsCoincidingPointsAndIsEmptyForOnePoint)
{
  TubeAxis axis;
  for (const double z : {0.0, 0.0, 0.1, 0.1, 0.1})
    axis.add({0.0, 0.0, z}, 1e-3, {});
  Surface surface;
  TubeBuilder builder(6);
  builder.append(axis, surface);
  EXPECT_EQ(surface.positions.size(), 2U * 6U + 2U * 7U);
  axis.clear();
  axis.add({0.0, 0.0, 0.0}, 1e-3, {});
  surface.clear();
  builder.append(axis, surface);
  builder.append({}, surface);
  EXPECT_TRUE(surface.positions.empty());
  EXPECT_TRUE(surface.triangles.empty());
}

TEST(TubeSurface, IsFiniteAtAReversalOfTheCurve)
{
  TubeAxis axis;
  for (const double z : {0.0, 0.1, 0.0, 0.1})
    axis.add({0.0, 0.0, z}, 1e-3, {});
  Surface surface;
  TubeBuilder(2).append(axis, surface);
  EXPECT_EQ(TubeBuilder(2).sides(), 3);
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
    EXPECT_TRUE(surface.positions[i].allFinite() && surface.normals[i].allFinite());
}

TEST(ProblemOfTube, NamesWhatCannotBeDrawn)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(problemOfTube({{0, 0, 0}, {0, 0, 1}}, {1, 1}), nullptr);
  EXPECT_STREQ(problemOfTube({}, {}), "empty");
  EXPECT_STREQ(problemOfTube({{0, 0, 0}}, {1, 1}), "inconsistent lengths");
  EXPECT_STREQ(problemOfTube({{0, 0, nan}}, {1}), "not finite");
  EXPECT_STREQ(problemOfTube({{0, 0, 1e300}}, {1}), "not finite");
  EXPECT_STREQ(problemOfTube({{0, 0, 0}}, {nan}), "not finite");
  EXPECT_STREQ(problemOfTube({{0, 0, 0}}, {-1}), "negative radius");
}

TEST(TubeSurface, Of1600PointsTimes12SidesTakesAtMost3MsAndKeepsItsBuffers)
{
  const TubeAxis axis = helix(1600, 3e-4);
  TubeBuilder builder(12);
  Surface surface;
  builder.append(axis, surface);
  const std::size_t vertices = surface.positions.capacity(), corners = surface.triangles.capacity();
  double fastest = 1.0;
  for (int update = 0; update < 300; ++update)
  {
    const double begin = processorSeconds();
    surface.clear();
    builder.append(axis, surface);
    fastest = std::min(fastest, processorSeconds() - begin);
  }
  EXPECT_EQ(surface.positions.capacity(), vertices);
  EXPECT_EQ(surface.triangles.capacity(), corners);
  EXPECT_LT(fastest, 3e-3);
  RecordProperty("fastest_microseconds", static_cast<int>(1e6 * fastest));
}

}  // namespace
}  // namespace endovascular_sim::visualization
