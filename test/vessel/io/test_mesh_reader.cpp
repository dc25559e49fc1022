#include "test/common/input_error_of.h"
#include "vessel/io/mesh_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "test/common/temporary_folder.h"
#include "test/vessel/io/mesh_files.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

const std::string kMeshes = std::string(TEST_DATA_DIR) + "/meshes/";

std::string errorMessage(const std::string& file, double unit = 1e-3)
{
  return inputErrorOf([&] { readMesh(file, unit); });
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

/** File of a format with a header or comment of its writer. */
std::string withHeader(const geometry::TriangleMesh& mesh, MeshFormat format, const std::string& header)
{
  std::string bytes = meshFile(mesh, format);
  switch (format)
  {
    case MeshFormat::kObj:
    case MeshFormat::kRelativeObj:
      return "# " + header + "\n" + bytes;
    case MeshFormat::kAsciiStl:
      return "solid " + header + bytes.substr(bytes.find('\n'));
    case MeshFormat::kBinaryStl:
      return bytes.replace(0, header.size(), header);
    default:
      return bytes.insert(bytes.find("element"), "comment " + header + "\n");
  }
}

class EverySpace : public testing::TestWithParam<MeshFormat>
{
};

TEST_P(EverySpace, OfSlicerIsTurnedToThePatientFrame)
{
  const geometry::TriangleMesh lps = capsule(16, 10);
  geometry::TriangleMesh ras = lps;
  for (Eigen::Vector3d& v : ras.vertices)
    v.head<2>() *= -1.0;
  const TemporaryFolder folder;
  const auto read = [&](const geometry::TriangleMesh& mesh, const std::string& header, MeshRemarks& remarks)
  {
    const std::string file =
        folder.write(std::string("a") + extensionOf(GetParam()), withHeader(mesh, GetParam(), header));
    return readMesh(file, 1e-3, {}, &remarks).hash();
  };
  MeshRemarks of_lps;
  MeshRemarks of_ras;
  EXPECT_EQ(read(lps, "3D Slicer output. SPACE=LPS", of_lps), read(ras, "3D Slicer output. SPACE=RAS", of_ras));
  EXPECT_TRUE(of_lps.notes.empty());
  ASSERT_EQ(of_ras.notes.size(), 1U);
  EXPECT_NE(of_ras.notes[0].find("SPACE=RAS"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(MeshReader, EverySpace,
                         testing::Values(MeshFormat::kObj, MeshFormat::kAsciiStl, MeshFormat::kBinaryStl,
                                         MeshFormat::kAsciiPly, MeshFormat::kBigEndianPly),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

TEST(MeshReader, ReadsAnObjAndAPlyAfterAByteOrderMark)
{
  const TemporaryFolder folder;
  for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::kAsciiPly})
  {
    const std::string content = "\xEF\xBB\xBF" + meshFile(capsule(16, 10), format);
    EXPECT_EQ(errorMessage(folder.write(std::string("a") + extensionOf(format), content)), "");
  }
}

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
                                         FileError{"mesh.vtp", "holds no PolyData"},
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
