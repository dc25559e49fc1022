#include "test/common/input_error_of.h"
#include "vessel/repair/mesh_repair.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include <Eigen/Geometry>

#include "common/error.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_size.h"

namespace endovascular_sim::vessel
{
namespace
{

geometry::TriangleMesh load(const std::string& name)
{
  return readMesh(std::string(TEST_DATA_DIR) + "/meshes/" + name, 1e-3);
}

std::string errorMessage(const geometry::TriangleMesh& mesh)
{
  return inputErrorOf([&] { repairMesh(mesh, "vessel.obj"); });
}

struct Defect
{
  const char* file;
  const char* summary;  ///< expected text in the summary of the check
  const char* outcome;  ///< expected text in the note of the repair, or in its error
};

class RepairableMesh : public testing::TestWithParam<Defect>
{
};

TEST_P(RepairableMesh, IsCheckedRepairedAndLogged)
{
  const geometry::TriangleMesh mesh = load(GetParam().file);
  EXPECT_NE(checkMesh(mesh).summary().find(GetParam().summary), std::string::npos) << checkMesh(mesh).summary();
  const RepairedMesh repaired = repairMesh(mesh, GetParam().file);
  EXPECT_EQ(checkMesh(repaired.mesh).summary(), "");
  EXPECT_NEAR(repaired.mesh.signedVolume(), 8e-6, 1e-12);
  ASSERT_EQ(repaired.notes.size(), 1U);
  EXPECT_NE(repaired.notes[0].find(GetParam().outcome), std::string::npos) << repaired.notes[0];
}

INSTANTIATE_TEST_SUITE_P(
    MeshRepair, RepairableMesh,
    testing::Values(Defect{"box_inward.obj", "faces point inward", "pointed into the lumen"},
                    Defect{"box_flipped_face.obj", "3 edges with inconsistently oriented faces",
                           "1 misoriented face inverted"},
                    Defect{"box_duplicate_face.obj", "1 duplicate faces", "1 duplicate face dropped"},
                    Defect{"box_degenerate_face.obj", "1 faces without area", "1 degenerate face dropped"},
                    Defect{"box_and_crumb.obj", "2 separate components", "4 faces of components without volume"}));

class IrreparableMesh : public testing::TestWithParam<Defect>
{
};

TEST_P(IrreparableMesh, IsRejectedWithCountAndLocation)
{
  const geometry::TriangleMesh mesh = load(GetParam().file);
  EXPECT_NE(checkMesh(mesh).summary().find(GetParam().summary), std::string::npos) << checkMesh(mesh).summary();
  const std::string text = errorMessage(mesh);
  EXPECT_NE(text.find("vessel.obj"), std::string::npos) << text;
  EXPECT_NE(text.find(GetParam().outcome), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(
    MeshRepair, IrreparableMesh,
    testing::Values(Defect{"box_with_hole.obj", "3 boundary edges", "3 boundary edges (holes), the first near ("},
                    Defect{"box_fin.obj", "1 non-manifold edges", "non-manifold edges (three or more faces meet)"},
                    Defect{"two_boxes.obj", "2 separate components", "two largest have 12 and 12 triangles"},
                    Defect{"boxes_touching_in_a_corner.obj", "1 vertices where separate sheets touch",
                           "2 separate components"},
                    Defect{"moebius.obj", "boundary edges", "boundary edges"}));

TEST(MeshRepair, PreservesACleanMeshBitForBit)
{
  const geometry::TriangleMesh mesh = load("box_mm.obj");
  const RepairedMesh repaired = repairMesh(mesh, "box_mm.obj");
  EXPECT_TRUE(repaired.notes.empty());
  EXPECT_EQ(repaired.mesh.hash(), mesh.hash());
}

TEST(MeshRepair, WeldsVerticesWithinATenthOfAMicrometre)
{
  geometry::TriangleMesh mesh = load("box_mm.obj");
  mesh.vertices.emplace_back(mesh.vertices[0] + Eigen::Vector3d(5e-8, 0, 0));
  for (Eigen::Vector3i& t : mesh.triangles)
    if (t[0] == 0)
    {
      t[0] = 8;
      break;
    }
  EXPECT_GT(checkMesh(mesh).boundary_edges.count, 0);
  const RepairedMesh repaired = repairMesh(mesh, "x");
  EXPECT_EQ(repaired.mesh.vertices.size(), 8U);
  EXPECT_EQ(checkMesh(repaired.mesh).summary(), "");
}

/** Splits the first face at @p count points next to its first edge, and fills the rest with caps.
 *  @param off distance of the points from the edge, towards the third corner [m] */
geometry::TriangleMesh withCaps(geometry::TriangleMesh mesh, int count, double off)
{
  const Eigen::Vector3i face = mesh.triangles.front();
  const auto at = [&mesh](int v) { return Eigen::Vector3d(mesh.vertices[static_cast<std::size_t>(v)]); };
  const Eigen::Vector3d a = at(face[0]), b = at(face[1]), c = at(face[2]);
  const Eigen::Vector3d inward = ((c - a) - (c - a).dot(b - a) / (b - a).squaredNorm() * (b - a)).normalized();
  mesh.triangles.erase(mesh.triangles.begin());
  int before = face[0];
  for (int k = 1; k <= count; ++k)
  {
    const int point = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(a + (b - a) * k / (count + 1) + off * inward);
    mesh.triangles.emplace_back(before, point, face[2]);
    mesh.triangles.emplace_back(before, face[1], point);
    before = point;
  }
  mesh.triangles.emplace_back(before, face[1], face[2]);
  return mesh;
}

TEST(MeshRepair, FlipsTheLongestEdgesOfCaps)
{
  const geometry::TriangleMesh box = load("box_mm.obj");
  for (const int count : {1, 2, 7, 40})
    for (const double off : {0.0, 1e-12, 5e-8})
    {
      const geometry::TriangleMesh mesh = withCaps(box, count, off);
      const RepairedMesh repaired = repairMesh(mesh, "x");
      EXPECT_EQ(checkMesh(repaired.mesh).summary(), "");
      EXPECT_EQ(repaired.mesh.triangles.size(), mesh.triangles.size());
      EXPECT_NEAR(repaired.mesh.signedVolume(), box.signedVolume(), 1e-11);
      ASSERT_EQ(repaired.notes.size(), 1U);
      EXPECT_NE(repaired.notes[0].find("cap triangle"), std::string::npos) << repaired.notes[0];
      for (const Eigen::Vector3i& t : repaired.mesh.triangles)
      {
        const auto at = [&](int k) { return repaired.mesh.vertices[static_cast<std::size_t>(t[k])]; };
        const double longest = std::max({(at(1) - at(0)).norm(), (at(2) - at(1)).norm(), (at(0) - at(2)).norm()});
        EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).norm() / longest, kWeldDistance) << count << " " << off;
      }
    }
}

TEST(MeshRepair, RemovesCapsCoveredByWeldedVerticesAndDuplicateFaces)
{
  geometry::TriangleMesh mesh = withCaps(load("box_mm.obj"), 1, 0.0);
  const int count = static_cast<int>(mesh.triangles.size());
  const auto cap = std::find_if(mesh.triangles.begin(), mesh.triangles.end(),
                                [&mesh](const Eigen::Vector3i& t)
                                {
                                  const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
                                  return (at(1) - at(0)).cross(at(2) - at(0)).norm() < 1e-12;
                                });
  ASSERT_NE(cap, mesh.triangles.end());
  const Eigen::Vector3i face = *cap;
  mesh.vertices.emplace_back(mesh.vertices[static_cast<std::size_t>(face[1])] + Eigen::Vector3d(3e-8, 0.0, 0.0));
  mesh.triangles.emplace_back(face[0], face[1], static_cast<int>(mesh.vertices.size()) - 1);  // collapses by welding
  mesh.triangles.push_back(face);
  const RepairedMesh repaired = repairMesh(mesh, "x");
  EXPECT_EQ(checkMesh(repaired.mesh).summary(), "");
  EXPECT_EQ(static_cast<int>(repaired.mesh.triangles.size()), count);
}

TEST(MeshRepair, RetainsFlatFacesHigherThanTheWeldDistance)
{
  const geometry::TriangleMesh mesh = withCaps(load("box_mm.obj"), 3, 2e-7 * 4.0);
  const RepairedMesh repaired = repairMesh(mesh, "x");
  EXPECT_TRUE(repaired.notes.empty());
  EXPECT_EQ(repaired.mesh.hash(), mesh.hash());
}

TEST(MeshRepair, DropsUnusedVertices)
{
  geometry::TriangleMesh mesh = load("box_mm.obj");
  mesh.vertices.insert(mesh.vertices.begin(), Eigen::Vector3d(1, 2, 3));
  for (Eigen::Vector3i& t : mesh.triangles)
    t.array() += 1;
  EXPECT_EQ(checkMesh(mesh).unused_vertices.count, 1);
  EXPECT_EQ(repairMesh(mesh, "x").mesh.vertices.size(), 8U);
}

TEST(MeshCheck, ReportsAnInvalidIndex)
{
  geometry::TriangleMesh mesh = load("box_mm.obj");
  mesh.triangles[3][1] = 99;
  EXPECT_EQ(checkMesh(mesh).invalid_faces.count, 1);
  EXPECT_THROW(requireClean(checkMesh(mesh), "x"), InputError);
}

TEST(MeshCheck, ReportsTheGenusOfATorus)
{
  geometry::TriangleMesh torus;
  const int n = 12;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
    {
      const double a = 2.0 * M_PI * i / n;
      const double b = 2.0 * M_PI * j / n;
      torus.vertices.emplace_back((0.02 + 0.005 * std::cos(b)) * std::cos(a),
                                  (0.02 + 0.005 * std::cos(b)) * std::sin(a), 0.005 * std::sin(b));
      const int here = i * n + j;
      const int right = (i + 1) % n * n + j;
      const int up = i * n + (j + 1) % n;
      const int both = (i + 1) % n * n + (j + 1) % n;
      torus.triangles.emplace_back(here, right, both);
      torus.triangles.emplace_back(here, both, up);
    }
  EXPECT_EQ(checkMesh(torus).summary(), "");
  EXPECT_EQ(checkMesh(torus).genus, 1);
  EXPECT_EQ(checkMesh(load("box_mm.obj")).genus, 0);
}

TEST(MeshCheck, SuggestsTheUnitOfAMeshOfImplausibleSize)
{
  const std::string box = std::string(TEST_DATA_DIR) + "/meshes/box_mm.obj";
  const auto reason = [&box](double unit)
  {
    try
    {
      const geometry::TriangleMesh mesh = readMesh(box, unit);
      requirePlausibleSize(mesh, checkMesh(mesh), unit, box);
    }
    catch (const InputError& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(reason(1e-3), "");
  EXPECT_NE(reason(1.0).find("looks like millimetres: set vessel.unit: 0.001"), std::string::npos) << reason(1.0);
  EXPECT_NE(reason(1e-6).find("vessel.unit: 0.001"), std::string::npos) << reason(1e-6);
}

/** Meshes of segmented vessels, which are not part of the repository. */
class SegmentedVessels : public testing::Test
{
protected:
  void SetUp() override
  {
    const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
    if (folder == nullptr || !std::filesystem::exists(std::string(folder) + "/aortic_arch_tree.obj"))
      GTEST_SKIP() << "ENDOVASCULAR_DATA_DIR is not set to the folder of the segmented vessels";
    folder_ = std::string(folder) + "/";
  }
  std::string folder_;
};

TEST_F(SegmentedVessels, LoadTheArchWithInvertedFaces)
{
  const geometry::TriangleMesh mesh = readMesh(folder_ + "aortic_arch_tree.obj", 1e-3);
  EXPECT_LT(mesh.signedVolume(), 0.0);
  EXPECT_EQ(mesh.triangles.size(), 3584U);
  const RepairedMesh repaired = repairMesh(mesh, "aortic_arch_tree.obj");
  EXPECT_EQ(repaired.notes.size(), 1U);
  EXPECT_EQ(checkMesh(repaired.mesh).summary(), "");
}

TEST_F(SegmentedVessels, RejectTheDirtyPhantom)
{
  const std::string text = errorMessage(readMesh(folder_ + "abdominal_aorta_phantom.stl", 1.0));
  EXPECT_NE(text.find("18 boundary edges"), std::string::npos) << text;
  EXPECT_NE(text.find("8 non-manifold edges"), std::string::npos) << text;
}

TEST_F(SegmentedVessels, RejectDisconnectedComponents)
{
  const std::string text = errorMessage(readMesh(folder_ + "aorta_coronary_female.obj", 1e-3));
  EXPECT_NE(text.find("6 separate components"), std::string::npos) << text;
}

}  // namespace
}  // namespace endovascular_sim::vessel
