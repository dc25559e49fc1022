#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/error.h"
#include "test/common/input_error_of.h"
#include "test/common/random_damage.h"
#include "test/common/temporary_folder.h"
#include "test/vessel/io/mesh_files.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/repair/lumen_check.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_repair.h"
#include "vessel/repair/mesh_size.h"

// Damaged mesh files: the reader returns a mesh with valid indices and finite coordinates, or throws InputError.

namespace endovascular_sim::vessel
{
namespace
{

constexpr int kMutations = 2000;

const std::vector<std::string> kNumbers = {"-1",  "4294967295", "2147483648",          "1e308",
                                           "nan", "0",          "99999999999999999999"};

/** Passes a mesh that was read through the checks and repairs of a scene.
 *  @throws InputError where they reject it */
void prepare(geometry::TriangleMesh mesh, const std::string& file)
{
  requirePlausibleSize(mesh, checkMesh(mesh), 1e-3, file);
  requireLumen(repairMesh(std::move(mesh), file).mesh, 1e-3, file);
}

class DamagedMesh : public testing::TestWithParam<MeshFormat>
{
};

TEST_P(DamagedMesh, IsReadWithValidIndicesOrRejected)
{
  const std::string small = meshFile(capsule(16, 10), GetParam());
  const std::string large = meshFile(capsule(64, 38), GetParam());
  const TemporaryFolder folder;
  const std::string name = std::string("damaged") + extensionOf(GetParam());
  test::RandomDamage damage(1, kNumbers, 16);
  int accepted = 0;
  for (int k = 0; k < kMutations; ++k)
  {
    const std::string file = folder.write(name, damage.of(k % 20 == 0 ? large : small, 8));
    try
    {
      const geometry::TriangleMesh mesh = readMesh(file, 1e-3);
      ++accepted;
      ASSERT_FALSE(mesh.triangles.empty());
      for (const Eigen::Vector3i& triangle : mesh.triangles)
      {
        ASSERT_GE(triangle.minCoeff(), 0) << k;
        ASSERT_LT(triangle.maxCoeff(), static_cast<int>(mesh.vertices.size())) << k;
      }
      for (const Eigen::Vector3d& vertex : mesh.vertices)
        ASSERT_TRUE(vertex.allFinite()) << k;
      prepare(mesh, file);
    }
    catch (const InputError& error)
    {
      ASSERT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
  EXPECT_LT(accepted, kMutations);
}

TEST_P(DamagedMesh, IsAcceptedUndamaged)
{
  const geometry::TriangleMesh mesh = capsule(64, 38);
  ASSERT_LE(mesh.triangles.size(), 5000U);
  const TemporaryFolder folder;
  const geometry::TriangleMesh read =
      readMesh(folder.write(std::string("undamaged") + extensionOf(GetParam()), meshFile(mesh, GetParam())), 1e-3);
  EXPECT_EQ(read.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(read.vertices.size(), mesh.vertices.size());
  EXPECT_TRUE(checkMesh(read).clean());
}

INSTANTIATE_TEST_SUITE_P(MeshReader, DamagedMesh,
                         testing::Values(MeshFormat::kObj, MeshFormat::kRelativeObj, MeshFormat::kAsciiStl,
                                         MeshFormat::kBinaryStl, MeshFormat::kAsciiPly, MeshFormat::kLittleEndianPly,
                                         MeshFormat::kBigEndianPly),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

/** Error of reading a file with this content; empty if it is accepted. */
std::string errorOf(const std::string& content, const std::string& extension)
{
  const TemporaryFolder folder;
  return inputErrorOf([&] { readMesh(folder.write("mesh" + extension, content), 1.0); });
}

constexpr auto kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
    "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST(MeshReader, RejectsAVertexNumberThatDoesNotExist)
{
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(errorOf(kPlyHeader + vertices + "3 0 1 2\n", ".ply"), "");
  EXPECT_NE(errorOf(kPlyHeader + vertices + "3 0 1 3\n", ".ply").find("names vertex 3"), std::string::npos);
  EXPECT_NE(errorOf(kPlyHeader + vertices + "3 0 1 -1\n", ".ply").find("names vertex -1"), std::string::npos);
  EXPECT_NE(errorOf("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ".obj").find("line 4"), std::string::npos);
  EXPECT_NE(errorOf("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", ".obj").find("line 4"), std::string::npos);
  EXPECT_NE(errorOf("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", ".obj").find("line 4"), std::string::npos);
}

TEST(MeshReader, RejectsCountsThatExceedTheFile)
{
  std::string header = kPlyHeader;
  header.replace(header.find("vertex 3"), 8, "vertex 4000000000");
  EXPECT_NE(errorOf(header + "0 0 0\n", ".ply").find("more than the file holds"), std::string::npos);
  EXPECT_NE(errorOf(std::string(80, 'x') + std::string("\xff\xff\xff\x7f", 4), ".stl").find("truncated"),
            std::string::npos);
}

TEST(MeshReader, RejectsMoreDataThanTheHeaderAnnounces)
{
  const std::string content = std::string(kPlyHeader) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(errorOf(content + "\n", ".ply"), "");
  EXPECT_NE(errorOf(content + "3 0 1 2\n", ".ply").find("more data than its header"), std::string::npos);
  EXPECT_NE(errorOf(std::string(kPlyHeader) + "0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n", ".ply").find("more values"),
            std::string::npos);
}

TEST(MeshReader, RejectsStatementsThatAreNotOfTheFormat)
{
  const std::string triangle = "v 0 0 0\nv 1 0 0 1\nv 0 1 0 0.5 0.5 0.5 # red\nusemtl wall\n";
  EXPECT_EQ(errorOf(triangle + "f 1/1/1 2//2 \\\n 3/3\n", ".obj"), "");
  EXPECT_NE(errorOf(triangle + "w 1 0 0\nf 1 2 3\n", ".obj").find("line 5"), std::string::npos);
  EXPECT_NE(errorOf(triangle + "f 1/x 2 3\n", ".obj").find("line 5"), std::string::npos);
  EXPECT_NE(errorOf(triangle + "v 1 2 3 4 5 6 7 8\nf 1 2 3\n", ".obj").find("line 5"), std::string::npos);
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  EXPECT_EQ(errorOf("solid a\n" + facet + "endsolid a\n", ".stl"), "");
  EXPECT_NE(errorOf("solid a\n" + facet, ".stl").find("truncated"), std::string::npos);
}

TEST(MeshReader, ReportsItsProgressOnALargeMesh)
{
  const TemporaryFolder folder;
  double last = 0.0;
  int reports = 0;
  readMesh(folder.write("large.obj", meshFile(capsule(200, 200), MeshFormat::kObj)), 1e-3,
           [&](const char* task, double fraction)
           {
             EXPECT_GE(fraction, 0.0);
             EXPECT_LE(fraction, 1.0);
             if (std::string(task) != "reading the mesh file")
               return;
             EXPECT_GE(fraction, last);
             last = fraction;
             ++reports;
           });
  EXPECT_GE(reports, 3);
}

TEST(MeshReader, KeepsDoublePrecision)
{
  const TemporaryFolder folder;
  const std::string file = folder.write("a.obj", "v 0.1234567890123456 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(readMesh(file, 1.0).vertices[0].x(), 0.1234567890123456);
}

TEST(MeshReader, TriangulatesAConcavePolygonWithinItsOutline)
{
  const TemporaryFolder folder;
  const std::string file = folder.write("a.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5\n");
  const geometry::TriangleMesh mesh = readMesh(file, 1.0);
  ASSERT_EQ(mesh.triangles.size(), 3U);
  double area = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const Eigen::Vector3d normal =
        0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    EXPECT_GT(normal.z(), 0.0);
    area += normal.norm();
  }
  EXPECT_NEAR(area, 2.5, 1e-12);
}

}  // namespace
}  // namespace endovascular_sim::vessel
