#include "vessel/io/mesh_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/error.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

const std::string kMeshes = std::string(TEST_DATA_DIR) + "/meshes/";

std::string errorMessage(const std::string& file, double unit = 1e-3)
{
  try
  {
    readMesh(file, unit);
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return "";
}

class EveryFormat : public testing::TestWithParam<const char*>
{
};

TEST_P(EveryFormat, YieldsTheSameWatertightBoxInMetres)
{
  const geometry::TriangleMesh mesh = readMesh(kMeshes + GetParam(), 1e-3);
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_NEAR(mesh.signedVolume(), 8e-6, 1e-12);
  EXPECT_EQ(checkMesh(mesh).summary(), "");
}

INSTANTIATE_TEST_SUITE_P(MeshReader, EveryFormat,
                         testing::Values("box_mm.obj", "box_ascii.stl", "box_binary.stl", "box.ply"));

TEST(MeshReader, IsReproducibleBitForBit)
{
  EXPECT_EQ(readMesh(kMeshes + "box_binary.stl", 1e-3).hash(), readMesh(kMeshes + "box_binary.stl", 1e-3).hash());
}

TEST(MeshReader, RetainsDefects)
{
  EXPECT_EQ(readMesh(kMeshes + "box_with_hole.obj", 1e-3).triangles.size(), 11U);
  EXPECT_LT(readMesh(kMeshes + "box_inward.obj", 1e-3).signedVolume(), 0.0);
}

struct FileError
{
  const char* file;
  const char* reason;
};

class RejectedFile : public testing::TestWithParam<FileError>
{
};

TEST_P(RejectedFile, IsReportedWithTheReason)
{
  const std::string text = errorMessage(kMeshes + GetParam().file);
  EXPECT_NE(text.find(GetParam().file), std::string::npos) << text;
  EXPECT_NE(text.find(GetParam().reason), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(MeshReader, RejectedFile,
                         testing::Values(FileError{"absent.obj", "no such file"}, FileError{"empty.obj", "is empty"},
                                         FileError{"mesh.vtp", "unknown mesh format"},
                                         FileError{"garbage.stl", "cannot be read"},
                                         FileError{"points_only.obj", "no triangles"},
                                         FileError{"not_a_number.obj", "not a finite number"}));

TEST(MeshReader, RejectsANonPositiveUnit)
{
  EXPECT_NE(errorMessage(kMeshes + "box_mm.obj", 0.0).find("unit"), std::string::npos);
  EXPECT_NE(errorMessage(kMeshes + "box_mm.obj", -1.0).find("unit"), std::string::npos);
  EXPECT_NE(errorMessage(kMeshes + "box_mm.obj", std::nan("")).find("unit"), std::string::npos);
}

TEST(MeshReader, RejectsAFolder)
{
  EXPECT_NE(errorMessage(std::string(TEST_DATA_DIR) + "/meshes").find("unknown mesh format"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::vessel
