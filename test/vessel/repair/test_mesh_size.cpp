#include "test/common/input_error_of.h"
#include "vessel/repair/mesh_size.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/vessel/repair/swept_meshes.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Refusal of a tube of 8 mm by 160 mm that was written in one unit and read with another one. */
std::string refusalOf(double written, double read)
{
  const double scale = read / written;
  const geometry::TriangleMesh mesh = sweep(straightLine(0.16 * scale), circle(4e-3 * scale));
  return inputErrorOf([&] { requirePlausibleSize(mesh, checkMesh(mesh), read, "tube.stl"); });
}

TEST(MeshSize, ProposesTheUnitThatGivesAUsualLumen)
{
  EXPECT_EQ(refusalOf(1e-3, 1e-3), "");
  const std::string metres = refusalOf(1.0, 1e-3);
  EXPECT_NE(metres.find("looks like metres: set vessel.unit: 1 (lumen 7.98 mm wide"), std::string::npos) << metres;
  const std::string micrometres = refusalOf(1e-6, 1e-3);
  EXPECT_NE(micrometres.find("looks like micrometres: set vessel.unit: 1e-06"), std::string::npos) << micrometres;
  const std::string inches = refusalOf(0.0254, 1.0);
  EXPECT_NE(inches.find("looks like inches: set vessel.unit: 0.0254"), std::string::npos) << inches;
}

TEST(MeshSize, RefusesANarrowLumenOnlyWhereAnotherUnitGivesAVesselOfUsualLength)
{
  const MeshReport aorta_in_cm = checkMesh(sweep(straightLine(0.016), circle(0.4e-3)));
  EXPECT_THROW(requirePlausibleWidth(0.8e-3, aorta_in_cm, 1e-3, "cm.stl"), InputError);
  const MeshReport phantom = checkMesh(sweep(straightLine(0.06), circle(0.45e-3)));
  EXPECT_NO_THROW(requirePlausibleWidth(0.9e-3, phantom, 1e-3, "phantom.stl"));
  EXPECT_THROW(requirePlausibleWidth(0.2e-3, phantom, 1e-3, "hair.stl"), InputError);
}

TEST(MeshSize, WarnsOfAMeshFarFromTheOrigin)
{
  geometry::TriangleMesh mesh = sweep(straightLine(0.16), circle(4e-3));
  EXPECT_EQ(distanceWarning(checkMesh(mesh), "tube.stl"), "");
  for (Eigen::Vector3d& v : mesh.vertices)
    v.z() += 120.0;
  const std::string warning = distanceWarning(checkMesh(mesh), "tube.stl");
  EXPECT_NE(warning.find("lies 120 m from the origin"), std::string::npos) << warning;
  EXPECT_NE(warning.find("7.2 um"), std::string::npos) << warning;
}

}  // namespace
}  // namespace endovascular_sim::vessel
