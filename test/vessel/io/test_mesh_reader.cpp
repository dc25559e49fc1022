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

std::string refusal(const std::string& file, double unit = 1e-3)
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

TEST_P(EveryFormat, GivesTheSameWatertightBoxInMetres)
{
  const geometry::TriangleMesh mesh = readMesh(kMeshes + GetParam(), 1e-3);
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_NEAR(mesh.signedVolume(), 8e-6, 1e-12);
  EXPECT_EQ(checkMesh(mesh).summary(), "");
}

INSTANTIATE_TEST_SUITE_P(MeshReader, EveryFormat,
                         testing::Values("box_mm.obj", "box_ascii.stl", "box_binary.stl", "box.ply"));

TEST(MeshReader, ReadsTheSameBitsTwice)
{
  EXPECT_EQ(readMesh(kMeshes + "box_binary.stl", 1e-3).hash(), readMesh(kMeshes + "box_binary.stl", 1e-3).hash());
}

TEST(MeshReader, KeepsDefectsForTheCheck)
{
  EXPECT_EQ(readMesh(kMeshes + "box_with_hole.obj", 1e-3).triangles.size(), 11U);
  EXPECT_LT(readMesh(kMeshes + "box_inward.obj", 1e-3).signedVolume(), 0.0);
}

struct Refused
{
  const char* file;
  const char* reason;
};

class RefusedFile : public testing::TestWithParam<Refused>
{
};

TEST_P(RefusedFile, IsNamedWithItsReason)
{
  const std::string text = refusal(kMeshes + GetParam().file);
  EXPECT_NE(text.find(GetParam().file), std::string::npos) << text;
  EXPECT_NE(text.find(GetParam().reason), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(MeshReader, RefusedFile,
                         testing::Values(Refused{"absent.obj", "no such file"}, Refused{"empty.obj", "is empty"},
                                         Refused{"mesh.vtp", "unknown mesh format"},
                                         Refused{"garbage.stl", "cannot be read"},
                                         Refused{"points_only.obj", "no triangles"},
                                         Refused{"not_a_number.obj", "not a finite number"}));

TEST(MeshReader, RefusesAUnitThatIsNotPositive)
{
  EXPECT_NE(refusal(kMeshes + "box_mm.obj", 0.0).find("unit"), std::string::npos);
  EXPECT_NE(refusal(kMeshes + "box_mm.obj", -1.0).find("unit"), std::string::npos);
  EXPECT_NE(refusal(kMeshes + "box_mm.obj", std::nan("")).find("unit"), std::string::npos);
}

TEST(MeshReader, RefusesAFolder)
{
  EXPECT_NE(refusal(std::string(TEST_DATA_DIR) + "/meshes").find("unknown mesh format"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::vessel
