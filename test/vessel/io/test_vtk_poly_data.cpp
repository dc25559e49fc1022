#include "test/common/input_error_of.h"
#include "vessel/io/vtk_poly_data.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "common/error.h"
#include "test/common/random_damage.h"
#include "test/vessel/io/vtk_files.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

std::pair<geometry::TriangleMesh, MeshRemarks> surfaceOf(const VtkContent& content, VtkStorage storage)
{
  MeshBuilder builder("v", 1e-3);
  addSurface(readVtkPolyData(vtkFile(content, storage), std::string("v") + extensionOf(storage)), builder);
  geometry::TriangleMesh mesh = builder.build();
  return {mesh, builder.remarks()};
}

std::string refusalOf(const std::string& bytes, const std::string& name)
{
  return inputErrorOf(
      [&]
      {
        MeshBuilder builder(name, 1e-3);
        addSurface(readVtkPolyData(bytes, name), builder);
        builder.build();
      });
}

class EveryVtkStorage : public testing::TestWithParam<VtkStorage>
{
};

TEST_P(EveryVtkStorage, GivesTheSurfaceBitForBit)
{
  const geometry::TriangleMesh mesh = capsule(16, 10);
  MeshBuilder builder("v", 1e-3);
  for (const Eigen::Vector3d& v : mesh.vertices)
    builder.addVertex(v);
  for (const Eigen::Vector3i& t : mesh.triangles)
    builder.addFace({t[0], t[1], t[2]});
  const auto [read, remarks] = surfaceOf(surfaceContent(mesh), GetParam());
  EXPECT_EQ(read.hash(), builder.build().hash());
  EXPECT_TRUE(remarks.notes.empty());
}

TEST_P(EveryVtkStorage, GivesStripsPolygonsLinesAndRadii)
{
  VtkContent content;
  content.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
  content.strips = {{0, 1, 2, 3, 4}};
  content.polygons = {{0, 2, 3, 1}};
  content.lines = {{0, 2, 4}, {1, 3}};
  content.radii = {1.0, 1.5, 2.0, 2.5, 3.0};
  const std::string name = std::string("v") + extensionOf(GetParam());
  const VtkPolyData data = readVtkPolyData(vtkFile(content, GetParam()), name);
  ASSERT_EQ(data.lines.size(), 2U);
  EXPECT_EQ(data.lines.cell(0), (std::vector<long long>{0, 2, 4}));
  EXPECT_EQ(data.lines.cell(1), (std::vector<long long>{1, 3}));
  EXPECT_EQ(data.radii, content.radii);
  const geometry::TriangleMesh mesh = surfaceOf(content, GetParam()).first;
  ASSERT_EQ(mesh.triangles.size(), 5U);
  double up = 0.0;  // the strip alternates, so that all of its triangles look upwards and the polygon downwards
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    up += (at(1) - at(0)).cross(at(2) - at(0)).z();
  }
  EXPECT_NEAR(up, 3e-6 - 2e-6, 1e-12);
}

TEST_P(EveryVtkStorage, IsTurnedFromRasBySlicersField)
{
  const geometry::TriangleMesh lps = capsule(16, 10);
  VtkContent content = surfaceContent(lps);
  content.space = "LPS";
  const std::uint64_t hash = surfaceOf(content, GetParam()).first.hash();
  for (Eigen::Vector3d& p : content.points)
    p.head<2>() *= -1.0;
  content.space = "RAS";
  const auto [read, remarks] = surfaceOf(content, GetParam());
  EXPECT_EQ(read.hash(), hash);
  EXPECT_EQ(remarks.notes.size(), 1U);
}

TEST_P(EveryVtkStorage, IsRefusedWhenTruncated)
{
  const std::string bytes = vtkFile(surfaceContent(capsule(16, 10)), GetParam());
  const std::string name = std::string("v") + extensionOf(GetParam());
  for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9})
    EXPECT_NE(refusalOf(bytes.substr(0, static_cast<std::size_t>(part * static_cast<double>(bytes.size()))), name), "")
        << part;
}

TEST_P(EveryVtkStorage, IsReadOrRefusedWhenDamaged)
{
  constexpr int kMutations = 300;
  VtkContent content = surfaceContent(capsule(16, 10));
  content.lines = {{0, 1, 2}};
  content.radii.assign(content.points.size(), 2.0);
  const std::string bytes = vtkFile(content, GetParam());
  const std::string name = std::string("v") + extensionOf(GetParam());
  test::RandomDamage damage(1, {"-1", "4294967295", "18446744073709551615", "1e308", "nan", "0"}, 16);
  for (int k = 0; k < kMutations; ++k)
    try
    {
      MeshBuilder builder(name, 1e-3);
      const VtkPolyData data = readVtkPolyData(damage.of(bytes, 8), name);
      EXPECT_TRUE(data.radii.empty() || data.radii.size() == data.points.size());
      addSurface(data, builder);
      const geometry::TriangleMesh mesh = builder.build();
      for (const Eigen::Vector3i& t : mesh.triangles)
        ASSERT_TRUE(t.minCoeff() >= 0 && t.maxCoeff() < static_cast<int>(mesh.vertices.size())) << k;
    }
    catch (const InputError& error)
    {
      ASSERT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(VtkPolyData, EveryVtkStorage, testing::ValuesIn(kVtkStorages),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

TEST(VtkPolyData, RefusesOtherDataAndCompressionByName)
{
  const std::string head = "<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\">";
  EXPECT_NE(refusalOf(head + "<PolyData/></VTKFile>", "v.vtp").find("vtkLZ4DataCompressor"), std::string::npos);
  EXPECT_NE(refusalOf("<VTKFile type=\"UnstructuredGrid\"/>", "v.vtp").find("holds UnstructuredGrid"),
            std::string::npos);
  const std::string legacy = "# vtk DataFile Version 4.2\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  EXPECT_NE(refusalOf(legacy, "v.vtk").find("is UNSTRUCTURED_GRID"), std::string::npos);
  EXPECT_NE(refusalOf("solid", "v.vtk").find("# vtk DataFile"), std::string::npos);
  VtkContent lines;
  lines.points = {{0, 0, 0}, {1, 0, 0}};
  lines.lines = {{0, 1}};
  EXPECT_NE(refusalOf(vtkFile(lines, VtkStorage::kAscii), "v.vtp").find("has no triangles"), std::string::npos);
}

TEST(VtkPolyData, RefusesACompressedBombAndADeepDocument)
{
  const std::string bomb =
      "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece>"
      "<Points><DataArray type=\"Float32\" format=\"appended\" offset=\"0\"/></Points></Piece></PolyData>"
      "<AppendedData encoding=\"raw\">_";
  std::string lengths;
  for (const std::uint32_t value : {1U, 0xFFFFFFFFU, 0U, 8U})
    append(lengths, value);
  EXPECT_NE(refusalOf(bomb + lengths + "12345678</AppendedData></VTKFile>", "v.vtp").find("damaged"),
            std::string::npos);
  std::string deep;
  for (int k = 0; k < 20000; ++k)
    deep += "<a>";
  EXPECT_NE(refusalOf("<VTKFile type=\"PolyData\">" + deep, "v.vtp").find("nested deeper"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::vessel
