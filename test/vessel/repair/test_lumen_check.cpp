#include "test/common/input_error_of.h"
#include "vessel/repair/lumen_check.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "test/vessel/repair/swept_meshes.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/prepare/prepare.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::vessel
{
namespace
{

ThickWall thickWallIn(const geometry::TriangleMesh& mesh)
{
  const geometry::TriangleMesh closed = repairMesh(mesh, "mesh").mesh;
  return findThickWall(closed, checkMesh(closed));
}

std::string refusalOf(const geometry::TriangleMesh& mesh)
{
  return inputErrorOf([&] { requireLumen(repairMesh(mesh, "vessel.stl").mesh, 1e-3, "vessel.stl"); });
}

TEST(LumenCheck, RefusesAWallWithAThicknessAndNamesTheRemedy)
{
  const std::string text = refusalOf(thickWall(straightLine(0.06), 4e-3, 5.5e-3));
  EXPECT_NE(text.find("a wall 1.5 mm thick around a lumen 8 mm wide"), std::string::npos) << text;
  EXPECT_NE(text.find("vessel_prepare --hollow --open all, with a --plug at each opening"), std::string::npos) << text;
}

TEST(LumenCheck, FindsThinThickCurvedAndShortWalls)
{
  const double radii[][2] = {{12e-3, 13.5e-3}, {1.5e-3, 2.5e-3}, {2e-3, 4e-3}, {3e-3, 3.4e-3}};
  for (const auto& [inner, outer] : radii)
  {
    EXPECT_TRUE(thickWallIn(thickWall(straightLine(0.06), inner, outer)).found()) << inner;
    EXPECT_TRUE(thickWallIn(thickWall(arc(0.03, M_PI), inner, outer)).found()) << inner;
  }
  EXPECT_TRUE(thickWallIn(thickWall(straightLine(0.025), 8e-3, 9.5e-3)).found());
}

TEST(LumenCheck, TheRemedyMakesTheLumenOfAWall)
{
  PrepareOptions options;
  options.hollow = true;
  options.open = {"all"};
  options.facets_around = 16;
  options.max_distance = 3e-4;
  options.plugs = {{{0, 0, 1e-3}, 5e-3}, {{0, 0, 0.029}, 5e-3}};
  const PreparedVessel lumen = prepareVessel(thickWall(straightLine(0.03), 4e-3, 5.5e-3), "wall", options);
  EXPECT_EQ(refusalOf(lumen.mesh), "");
}

TEST(LumenCheck, AcceptsRingsOfVessels)
{
  const double radii[][2] = {{0.03, 2e-3}, {0.01, 4e-3}, {6e-3, 4e-3}, {5e-3, 4e-3}, {0.06, 3e-3}};
  for (const auto& [ring, lumen] : radii)
  {
    const geometry::TriangleMesh mesh = sweep(arc(ring, 2.0 * M_PI), circle(lumen), true);
    EXPECT_EQ(checkMesh(mesh).genus, 1);
    EXPECT_EQ(refusalOf(mesh), "");
    EXPECT_EQ(thickWallIn(mesh).share, 0.0) << ring;
  }
  const auto flat = [](double x, double y)
  { return [=](double angle) { return Eigen::Vector2d(x * std::cos(angle), y * std::sin(angle)); }; };
  EXPECT_EQ(refusalOf(sweep(arc(0.02, 2.0 * M_PI), flat(2e-3, 6e-3), true)), "") << "compressed veins";
  EXPECT_EQ(refusalOf(sweep(arc(0.02, 2.0 * M_PI), flat(6e-3, 2e-3), true)), "");
}

TEST(LumenCheck, AcceptsALumenInTheShapeOfACAndATightCoil)
{
  for (const double mouth : {0.1, 0.2, 0.4})
    EXPECT_EQ(refusalOf(sweep(straightLine(0.08), crescent(5e-3, 8e-3, mouth), false, 120)), "") << mouth;
  std::vector<Eigen::Vector3d> coil;
  for (int k = 0; k < 400; ++k)
    coil.emplace_back(8e-3 * std::cos(0.1 * k), 8e-3 * std::sin(0.1 * k), 4.4e-3 * 0.1 * k / (2.0 * M_PI));
  EXPECT_EQ(refusalOf(sweep(coil, circle(2e-3))), "");
}

TEST(LumenCheck, AcceptsGeneratedAnatomies)
{
  for (const char* name : {"fork", "plain", "natural"})
  {
    const geometry::TriangleMesh mesh =
        loadAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/" + name + ".yaml").mesh;
    EXPECT_NO_THROW(requireLumen(mesh, 1.0, name));
    EXPECT_LT(findThickWall(mesh, checkMesh(mesh)).share, 0.01) << name;
  }
}

TEST(LumenCheck, AcceptsCoronaryTreesAndRefusesTheirDiametersInAWrongUnit)
{
  for (const double radius : {0.5e-3, 1e-3, 2e-3})
    EXPECT_EQ(refusalOf(sweep(straightLine(0.06), circle(1.01 * radius))), "") << radius;
  const std::string centimetres = refusalOf(sweep(straightLine(0.016), circle(0.4e-3)));
  EXPECT_NE(centimetres.find("its lumen is 0.798 mm wide"), std::string::npos) << centimetres;
  EXPECT_NE(centimetres.find("it looks like centimetres: set vessel.unit: 0.01 "), std::string::npos) << centimetres;
  const std::string inches = refusalOf(sweep(straightLine(6.4e-3), circle(0.1575e-3)));
  EXPECT_NE(inches.find("it looks like inches: set vessel.unit: 0.0254 "), std::string::npos) << inches;
  EXPECT_NE(refusalOf(sweep(straightLine(1.6), circle(0.08))).find("lumen"), std::string::npos);
}

TEST(LumenCheck, AcceptsSegmentedVessels)
{
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  if (folder == nullptr || !std::filesystem::exists(std::string(folder) + "/aortic_arch_tree.obj"))
    GTEST_SKIP() << "ENDOVASCULAR_DATA_DIR is not set to the folder of the segmented vessels";
  EXPECT_EQ(refusalOf(readMesh(std::string(folder) + "/aortic_arch_tree.obj", 1e-3)), "");
}

}  // namespace
}  // namespace endovascular_sim::vessel
