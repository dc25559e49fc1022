#include "vessel/centreline/medial_spheres.h"

#include <gtest/gtest.h>

#include "vessel/anatomy/tube.h"

namespace endovascular_sim::vessel
{
namespace
{

using Neighbours = std::vector<std::vector<int>>;

geometry::TriangleMesh tube()
{
  TubeShape shape;
  shape.radius = 5e-3;
  shape.facet_length = 5e-3;
  shape.pieces = {{0.05, 0.0, 0.0}};
  return tubeMesh(shape);
}

Neighbours connected(const std::vector<MedialSphere>& spheres)
{
  const geometry::TriangleMesh mesh = tube();
  Neighbours neighbours = overlappingSpheres(spheres);
  connectComponents(spheres, geometry::MeshDistance(mesh), neighbours);
  return neighbours;
}

TEST(ConnectComponents, ConnectsTheNearestSpheresWithFreeLineOfSight)
{
  // Two overlapping spheres, and two smaller overlapping ones beyond a gap of 0.2 mm.
  const std::vector<MedialSphere> spheres{
      {{0, 0, 0}, 3e-3}, {{0, 0, 4e-3}, 3e-3}, {{0, 0, 7.7e-3}, 5e-4}, {{0, 0, 8.4e-3}, 5e-4}};
  EXPECT_EQ(connected(spheres), (Neighbours{{1}, {0, 2}, {1, 3}, {2}}));
}

TEST(ConnectComponents, SkipsGapsAboveTheLargerRadius)
{
  const std::vector<MedialSphere> spheres{{{0, 0, 0}, 3e-3}, {{0, 0, 6.6e-3}, 5e-4}};
  EXPECT_EQ(connected(spheres), (Neighbours{{}, {}}));
}

TEST(ConnectComponents, SkipsPairsSeparatedByAWall)
{
  // The second sphere lies outside of the tube, next to it.
  const std::vector<MedialSphere> spheres{{{0, 0, 0}, 4.9e-3}, {{5.9e-3, 0, 0}, 8e-4}};
  EXPECT_EQ(connected(spheres), (Neighbours{{}, {}}));
}

TEST(ConnectComponents, PreservesConnectedComponents)
{
  const std::vector<MedialSphere> spheres{{{0, 0, 0}, 3e-3}, {{0, 0, 4e-3}, 3e-3}, {{0, 0, 9e-3}, 3e-3}};
  EXPECT_EQ(connected(spheres), overlappingSpheres(spheres));
}

}  // namespace
}  // namespace endovascular_sim::vessel
