#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "contact/detector.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

/** A duct along y with three reflex edges in its floor: two of them 2 mm apart, and between them a third one with a
 *  reflex angle of a fraction of a degree. @param rise height of the third edge above the other two [m] */
geometry::TriangleMesh ductWithFlatEdge(double rise)
{
  const std::vector<Eigen::Vector2d> section = {{-6e-3, 0.0}, {-1e-3, 1.3e-3}, {0.0, 1.3e-3 + rise}, {1e-3, 1.3e-3},
                                                {6e-3, 0.0},  {6e-3, 6e-3},    {0.0, 6e-3},          {-6e-3, 6e-3}};
  const int corners = static_cast<int>(section.size());
  constexpr int kLayers = 10;
  geometry::TriangleMesh mesh;
  for (int layer = 0; layer <= kLayers; ++layer)
    for (const Eigen::Vector2d& corner : section)
      mesh.vertices.emplace_back(corner.x(), 1e-3 * layer, corner.y());
  for (int layer = 0; layer < kLayers; ++layer)
    for (int k = 0; k < corners; ++k)
    {
      const int a = layer * corners + k;
      const int b = layer * corners + (k + 1) % corners;
      mesh.triangles.emplace_back(a, b + corners, b);
      mesh.triangles.emplace_back(a, a + corners, b + corners);
    }
  for (int end = 0; end < 2; ++end)
  {
    const int middle = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(0.0, end == 0 ? 0.0 : 1e-3 * kLayers, 3e-3);
    for (int k = 0; k < corners; ++k)
    {
      const int a = end * kLayers * corners + k;
      const int b = end * kLayers * corners + (k + 1) % corners;
      mesh.triangles.emplace_back(middle, end == 0 ? a : b, end == 0 ? b : a);
    }
  }
  return mesh;
}

TEST(NearlyFlatEdges, AreContactedByTheMiddleOfAWireEdgeAtAnyTilt)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> tilt(-0.01, 0.01);
  std::uniform_real_distribution<double> askew(-0.5, 0.5);
  for (double rise : {0.0, 0.3e-6, 3.6e-6, 15e-6})
  {
    const geometry::TriangleMesh mesh = ductWithFlatEdge(rise);
    Detector detector(mesh, WallLaw{});
    for (int trial = 0; trial < 60; ++trial)
    {
      const Eigen::Vector3d middle(0.2e-3 * askew(random), 5e-3 + 1e-3 * askew(random), 1.35e-3);
      const Eigen::Vector3d half = 1.27e-3 * Eigen::Vector3d(1.0, askew(random), tilt(random)).normalized();
      Query query;
      query.margin = {0.25e-3, 0.25e-3};
      query.nodes = {middle - half, middle + half};
      query.radius = {0.195e-3, 0.195e-3};
      ContactSet set;
      detector.detect(query, set);
      double listed = 1.0;
      for (const Feature& feature : set.features)
        listed = std::min(listed, feature.gap);
      double nearest = 1.0;
      int triangle = -1;
      for (int k = -500; k <= 500; ++k)
        nearest = std::min(nearest, bruteDistance(detector.wall(), middle + 2e-3 * k * half, triangle));
      EXPECT_NEAR(listed, nearest - query.radius[0], 1e-6) << "rise " << rise << " trial " << trial;
    }
  }
}

}  // namespace
}  // namespace endovascular_sim::contact
