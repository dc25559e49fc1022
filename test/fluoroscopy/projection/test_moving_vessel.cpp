#include "fluoroscopy/projection/moving_vessel.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "fluoroscopy/projection/vessel_projection.h"
#include "test/fluoroscopy/motion_fixtures.h"
#include "test/fluoroscopy/shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Ball in the heart, and a ball that reaches beyond the fade. */
geometry::TriangleMesh twoBalls()
{
  const Eigen::Vector3d centre = motion::naturalHeart().fade.centre;
  geometry::TriangleMesh mesh = sphere(centre + Eigen::Vector3d(0.01, 0.0, 0.02), 0.03, 20, 30);
  const geometry::TriangleMesh ball = sphere(centre + Eigen::Vector3d(-0.02, 0.05, 0.1), 0.03, 30, 40);
  const auto first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), ball.vertices.begin(), ball.vertices.end());
  for (const Eigen::Vector3i& triangle : ball.triangles)
    mesh.triangles.emplace_back(triangle + Eigen::Vector3i::Constant(first));
  return mesh;
}

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const motion::MotionMap& map)
{
  for (Eigen::Vector3d& vertex : mesh.vertices)
    vertex = map.position(vertex);
  return mesh;
}

TEST(MovingVessel, HasThePathLengthsOfTheMovedMesh)
{
  const geometry::TriangleMesh mesh = twoBalls();
  MovingVessel vessel;
  vessel.setMesh(mesh);
  for (const double angle : {0.0, -0.5, 1.2})
  {
    const XRayGeometry geometry(heartView(angle, 0.2, 200));
    const std::vector<double> rest = vesselPathLength(geometry, mesh);
    for (const double phase : {0.1, 0.3, 0.7})
    {
      const motion::MotionMap map = motion::mapAt(phase, 0.3);
      vessel.project(geometry, map);
      const std::vector<double> wanted = vesselPathLength(geometry, moved(mesh, map));
      double change = 0.0;
      for (std::size_t k = 0; k < wanted.size(); ++k)
      {
        ASSERT_NEAR(vessel.lengths()[k], wanted[k], 1e-12) << k;
        change = std::max(change, std::abs(wanted[k] - rest[k]));
      }
      EXPECT_GT(change, 5e-3);
    }
  }
  EXPECT_GT(vessel.movingTriangles(), 100U);
  EXPECT_LT(vessel.movingTriangles(), mesh.triangles.size());
}

TEST(MovingVessel, OfARestingMapHasTheBitsOfTheRestingMesh)
{
  MovingVessel vessel;
  vessel.setMesh(twoBalls());
  const XRayGeometry geometry(heartView(0.3, 0.2, 128));
  vessel.project(geometry, motion::mapAt(0.2, 0.0));
  vessel.project(geometry, motion::mapAt(0.0, 0.0));
  EXPECT_EQ(vessel.lengths(), vesselPathLength(geometry, vessel.mesh()));
}

TEST(MovingVessel, TakesANewMesh)
{
  MovingVessel vessel;
  vessel.setMesh(twoBalls());
  const XRayGeometry geometry(heartView(0.3, 0.2, 64));
  vessel.project(geometry, motion::mapAt(0.2, 0.0));
  vessel.setMesh(sphere(motion::naturalHeart().fade.centre, 0.02, 12, 12));
  vessel.project(geometry, motion::mapAt(0.2, 0.0));
  const std::vector<double> wanted = vesselPathLength(geometry, moved(vessel.mesh(), motion::mapAt(0.2, 0.0)));
  for (std::size_t k = 0; k < wanted.size(); ++k)
    ASSERT_NEAR(vessel.lengths()[k], wanted[k], 1e-12);
  vessel.setMesh({});
  vessel.project(geometry, motion::mapAt(0.2, 0.0));
  EXPECT_EQ(vessel.lengths(), std::vector<double>(64 * 64, 0.0));
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
