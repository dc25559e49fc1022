#include "vessel/repair/hole_closing.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "test/vessel/repair/swept_meshes.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Section of a D: half a circle and its chord, with an off-centre tongue that no fan fills. */
Eigen::Vector2d dent(double angle)
{
  const double radius = std::abs(angle - M_PI) < 1.0 ? 1e-3 : 5e-3;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

TEST(HoleClosing, ClosesOpenEndsThatNoFanFills)
{
  for (const Section& section : {crescent(5e-3, 8e-3, 0.3), Section(dent)})
  {
    const RepairedMesh closed = repairMesh(sweep(straightLine(0.04), section, false, 96), "open");
    ASSERT_FALSE(closed.notes.empty());
    EXPECT_EQ(closed.notes[0], "2 planar ends closed by lids");
    const MeshReport report = checkMesh(closed.mesh);
    EXPECT_EQ(report.summary(), "");
    EXPECT_EQ(report.genus, 0);
  }
}

TEST(HoleClosing, LidsOfACrescentHaveItsArea)
{
  const ClosedMesh closed = closeHoles(sweep(straightLine(0.04), crescent(5e-3, 8e-3, 0.3), false, 480));
  ASSERT_EQ(closed.holes.size(), 2U);
  const double area = 0.7 * M_PI * (64e-6 - 25e-6);
  for (const ClosedHole& hole : closed.holes)
  {
    EXPECT_TRUE(isFlatEnd(hole));
    EXPECT_NEAR(hole.area, area, 0.02 * area);
  }
}

TEST(HoleClosing, KeepsTheFanOfARoundEnd)
{
  const ClosedMesh closed = closeHoles(sweep(straightLine(0.04), circle(4e-3), false, 24));
  EXPECT_EQ(closed.mesh.triangles.size() - closed.first_lid, 48U);
  EXPECT_EQ(closed.mesh.vertices.size(), 40U * 24U + 2U);
}

TEST(HoleClosing, DoesNotCloseARimThatIsNotPlanar)
{
  geometry::TriangleMesh mesh = sweep(straightLine(0.04), crescent(5e-3, 8e-3, 0.3), false, 96);
  for (int k = 0; k < 96; k += 2)
    mesh.vertices[static_cast<std::size_t>(k)].z() += 1e-3;
  const ClosedMesh closed = closeHoles(mesh);
  EXPECT_EQ(std::count_if(closed.holes.begin(), closed.holes.end(), isFlatEnd), 1);
}

}  // namespace
}  // namespace endovascular_sim::vessel
