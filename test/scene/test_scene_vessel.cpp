#include "scene/scene_file.h"
#include "scene/scene_vessel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include <Eigen/Geometry>

#include "geometry/mesh_distance.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"
#include "test/vessel/repair/swept_meshes.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::scene
{
namespace
{

VesselScene tubeScene()
{
  VesselScene scene;
  scene.tube = vessel::TubeShape();
  scene.tube->radius = 3e-3;
  scene.tube->facet_length = 1e-3;
  scene.tube->pieces = {{0.05, 0.0, 0.0}};
  return scene;
}

VesselScene meshScene(const std::string& name)
{
  VesselScene scene;
  scene.mesh = std::string(TEST_DATA_DIR) + "/meshes/" + name;
  scene.unit = 1e-3;
  return scene;
}

VesselScene forkScene()
{
  VesselScene scene;
  scene.anatomy = std::string(TEST_DATA_DIR) + "/anatomies/fork.yaml";
  return scene;
}

/** Scene of a mesh in metres that is written to a file. */
VesselScene writtenScene(const geometry::TriangleMesh& mesh, const std::string& comment = "")
{
  static const TemporaryFolder folder;
  VesselScene scene;
  scene.mesh = folder.file("written.obj");
  vessel::writeObj(mesh, scene.mesh);
  if (!comment.empty())
    std::ofstream(scene.mesh, std::ios::app) << "# " << comment << "\n";
  return scene;
}

TEST(SceneVessel, RefusesAWallWithAThickness)
{
  const VesselScene scene = writtenScene(vessel::thickWall(vessel::straightLine(0.06), 4e-3, 5.5e-3));
  EXPECT_NE(inputErrorOf([&] { buildVessel(scene, {}, "s"); }).find("vessel_prepare --hollow"), std::string::npos);
}

TEST(SceneVessel, RefusesALumenOfAWrongUnit)
{
  VesselScene scene = writtenScene(vessel::sweep(vessel::straightLine(16.0), vessel::circle(0.4)));
  scene.unit = 1e-3;  // of centimetres
  EXPECT_NE(inputErrorOf([&] { buildVessel(scene, {}, "s"); }).find("looks like centimetres"), std::string::npos)
      << inputErrorOf([&] { buildVessel(scene, {}, "s"); });
}

TEST(SceneVessel, NotesThatAMeshWasTurnedAndWarnsOfOneFarAway)
{
  geometry::TriangleMesh mesh = vessel::sweep(vessel::straightLine(0.06), vessel::circle(4e-3));
  for (Eigen::Vector3d& v : mesh.vertices)
    v += Eigen::Vector3d(0.01, 0.02, 100.0);
  const vessel::Vessel vessel = buildVessel(writtenScene(mesh, "SPACE=RAS"), {}, "s");
  ASSERT_EQ(vessel.notes.size(), 2U);
  EXPECT_NE(vessel.notes[0].find("turned from RAS"), std::string::npos);
  EXPECT_LT(vessel::checkMesh(vessel.mesh).upper.x(), 0.0);
  ASSERT_EQ(vessel.warnings.size(), 1U);
  EXPECT_NE(vessel.warnings[0].find("from the origin"), std::string::npos);
}

TEST(SceneVessel, PlacesATubeAtTheEntryPose)
{
  EntryScene entry;
  entry.position = {0.1, 0.2, 0.3};
  entry.direction = Eigen::Vector3d(1, 1, 0).normalized();
  entry.up = Eigen::Vector3d::UnitZ();
  const vessel::Vessel vessel = buildVessel(tubeScene(), entry, "scene.yaml");
  const Eigen::Vector3d end = vessel.centreline.branches[0].points.back();
  EXPECT_LT((end - (entry.position + 0.05 * entry.direction)).norm(), 1e-12);
  const EntryPose pose = resolveEntry(entry, vessel, "scene.yaml");
  EXPECT_EQ(pose.position, entry.position);
  EXPECT_EQ(pose.direction, entry.direction);
  EXPECT_EQ(pose.d1, entry.up);
}

TEST(SceneVessel, MakesTheMaterialDirectorOrthogonal)
{
  EntryScene entry;
  entry.direction = Eigen::Vector3d(0, 0, 1);
  entry.up = Eigen::Vector3d(2, 0, 5);
  EXPECT_LT((resolveEntry(entry, "scene.yaml").d1 - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  entry.up = Eigen::Vector3d(0, 0, -3);
  EXPECT_NE(inputErrorOf([&] { resolveEntry(entry, "scene.yaml"); }).find("scene.yaml: entry.up"), std::string::npos);
}

TEST(SceneVessel, TransformsAMeshToThePatientFrame)
{
  VesselScene scene = meshScene("box_mm.obj");
  scene.transform.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  scene.transform.translation() = Eigen::Vector3d(1, 2, 3);
  const vessel::Vessel vessel = buildVessel(scene, EntryScene(), "scene.yaml");
  const vessel::MeshReport report = vessel::checkMesh(vessel.mesh);
  EXPECT_TRUE(report.clean());
  EXPECT_LT((report.lower - Eigen::Vector3d(0.98, 2, 3)).norm(), 1e-12);
  EXPECT_LT((report.upper - Eigen::Vector3d(1, 2.02, 3.02)).norm(), 1e-12);
  EXPECT_TRUE(vessel.centreline.branches.empty()) << "no centreline was required";
}

TEST(SceneVessel, RepairsOnlyIfAllowed)
{
  VesselScene scene = meshScene("box_inward.obj");
  EXPECT_EQ(buildVessel(scene, EntryScene(), "scene.yaml").notes.size(), 1U);
  scene.repair = false;
  EXPECT_NE(inputErrorOf([&] { buildVessel(scene, EntryScene(), "scene.yaml"); }).find("faces point inward"),
            std::string::npos);
}

TEST(SceneVessel, RejectsAWrongUnit)
{
  VesselScene scene = meshScene("box_mm.obj");
  scene.unit = 1.0;
  const std::string text = inputErrorOf([&] { buildVessel(scene, EntryScene(), "scene.yaml"); });
  EXPECT_NE(text.find("set vessel.unit: 0.001"), std::string::npos) << text;
}

TEST(SceneVessel, SmoothsByLoopSubdivision)
{
  VesselScene scene = tubeScene();
  const std::size_t before = buildVessel(scene, EntryScene(), "scene.yaml").mesh.triangles.size();
  scene.smoothing = 2;
  EXPECT_EQ(buildVessel(scene, EntryScene(), "scene.yaml").mesh.triangles.size(), 16 * before);
}

TEST(SceneVessel, RejectsAnEntryOutsideTheVessel)
{
  const vessel::Vessel vessel = buildVessel(meshScene("box_mm.obj"), EntryScene(), "scene.yaml");
  EntryScene entry;
  entry.position = {0.01, 0.01, 0.023};
  const std::string text = inputErrorOf([&] { resolveEntry(entry, vessel, "scene.yaml"); });
  EXPECT_NE(text.find("scene.yaml: entry.position"), std::string::npos) << text;
  EXPECT_NE(text.find("3 mm outside"), std::string::npos) << text;
  entry.position.z() = 0.01;
  EXPECT_EQ(inputErrorOf([&] { resolveEntry(entry, vessel, "scene.yaml"); }), "");
}

TEST(SceneVessel, PlacesTheEntryAtANamedCentrelineEnd)
{
  EntryScene entry;
  entry.centreline_end = "right";
  entry.offset = 0.006;
  const vessel::Vessel vessel = buildVessel(forkScene(), entry, "scene.yaml");
  const EntryPose pose = resolveEntry(entry, vessel, "scene.yaml");
  const Eigen::Vector3d tip = vessel.centreline.branches[2].points.back();
  EXPECT_NEAR((pose.position - tip).norm(), 0.006, 1e-4);
  EXPECT_LT(pose.direction.z(), -0.8);
  EXPECT_NEAR(pose.direction.norm(), 1.0, 1e-12);
  EXPECT_NEAR(pose.d1.norm(), 1.0, 1e-12);
  EXPECT_NEAR(pose.d1.dot(pose.direction), 0.0, 1e-12);
  EXPECT_GT(geometry::windingNumber(vessel.mesh, pose.position), 0.5);
}

TEST(SceneVessel, PlacesTheEntryAtTheNearestCentrelineEnd)
{
  EntryScene entry;
  entry.nearest_centreline_end = true;
  entry.position = {0, 0, -10};
  const vessel::Vessel vessel = buildVessel(forkScene(), entry, "scene.yaml");
  const EntryPose pose = resolveEntry(entry, vessel, "scene.yaml");
  EXPECT_EQ(pose.position, vessel.centreline.branches[0].points.front());
  EXPECT_GT(pose.direction.z(), 0.9);
}

TEST(SceneVessel, ExtractsTheCentrelineOfAMeshFileIfRequired)
{
  const VesselScene scene = writtenScene(buildVessel(tubeScene(), EntryScene(), "scene.yaml").mesh);
  EntryScene entry;
  EXPECT_TRUE(buildVessel(scene, entry, "scene.yaml").centreline.branches.empty());
  EXPECT_EQ(buildVessel(scene, entry, "scene.yaml", CentrelineUse::kRequired).centreline.branches.size(), 1U);
  entry.nearest_centreline_end = true;
  entry.position = {0, 0, 10};
  entry.offset = 0.004;
  const vessel::Vessel vessel = buildVessel(scene, entry, "scene.yaml");
  const EntryPose pose = resolveEntry(entry, vessel, "scene.yaml");
  EXPECT_LT(pose.direction.z(), -0.99);
  EXPECT_LT(pose.position.head<2>().norm(), 0.2e-3);
  EXPECT_GT(pose.position.z(), 0.04);
}

TEST(SceneVessel, TakesTheCentrelineOfAMeshWithItsNamesFromAFile)
{
  const VesselScene fork = forkScene();
  VesselScene scene = writtenScene(buildVessel(fork, EntryScene(), "scene.yaml").mesh);
  scene.centreline = fork.anatomy;
  scene.transform.translation() = Eigen::Vector3d(0.1, -0.2, 0.3);
  vessel::Lesion lesion;
  lesion.branch = "right";
  lesion.fraction = 0.5;
  lesion.length = 0.004;
  lesion.grade = 0.3;
  scene.lesions = {lesion};
  EntryScene entry;
  entry.centreline_end = "right";
  entry.offset = 0.006;
  const vessel::Vessel vessel = buildVessel(scene, entry, "scene.yaml");
  ASSERT_EQ(vessel.lesions.size(), 1U);
  const EntryPose pose = resolveEntry(entry, vessel, "scene.yaml");
  EXPECT_GT(geometry::windingNumber(vessel.mesh, pose.position), 0.5);
  const vessel::Vessel original = buildVessel(fork, entry, "scene.yaml");
  const EntryPose unmoved = resolveEntry(entry, original, "scene.yaml");
  EXPECT_LT((pose.position - unmoved.position - scene.transform.translation()).norm(), 1e-4);
}

TEST(SceneVessel, RejectsTheCentrelineOfAnotherVesselAndNamesAPointOutside)
{
  geometry::TriangleMesh mesh = buildVessel(forkScene(), EntryScene(), "scene.yaml").mesh;
  for (Eigen::Vector3d& v : mesh.vertices)
    v.x() += 0.05;
  VesselScene scene = writtenScene(mesh);
  scene.centreline = forkScene().anatomy;
  const std::string text = inputErrorOf([&] { buildVessel(scene, EntryScene(), "scene.yaml"); });
  EXPECT_NE(text.find("fork.yaml"), std::string::npos) << text;
  EXPECT_NE(text.find("lies outside of the mesh"), std::string::npos) << text;
}

TEST(SceneVessel, ListsTheEndsIfTheNamedOneDoesNotExist)
{
  EntryScene entry;
  entry.centreline_end = "middle";
  const vessel::Vessel vessel = buildVessel(forkScene(), entry, "scene.yaml");
  const std::string text = inputErrorOf([&] { resolveEntry(entry, vessel, "scene.yaml"); });
  EXPECT_NE(text.find("scene.yaml: entry.centreline_end"), std::string::npos) << text;
  EXPECT_NE(text.find("trunk, left, right"), std::string::npos) << text;
}

TEST(SceneVessel, RejectsAnOffsetLongerThanTheBranch)
{
  EntryScene entry;
  entry.centreline_end = "right";
  entry.offset = 1.0;
  const vessel::Vessel vessel = buildVessel(forkScene(), entry, "scene.yaml");
  EXPECT_NE(inputErrorOf([&] { resolveEntry(entry, vessel, "scene.yaml"); }).find("entry.offset"), std::string::npos);
}

/** Tube with a bend after 50 mm. */
Scene bentScene(const std::string& initial_insertion)
{
  return loadScene(PROJECT_DIR "/config/scenes/tube.yaml", {"drive.initial_insertion=" + initial_insertion});
}

TEST(SceneVessel, AcceptsInitialInsertionsUpToTheWall)
{
  for (const char* insertion : {"0.005", "0.01", "0.05"})
  {
    const Scene scene = bentScene(insertion);
    const vessel::Vessel vessel = buildVessel(*scene.vessel, scene.entry, scene.file);
    EXPECT_EQ(resolveStart(scene, vessel).position, scene.entry.position) << insertion;
  }
}

TEST(SceneVessel, RejectsAnInitialInsertionThroughTheWallAndReportsTheLimit)
{
  const Scene scene = bentScene("0.12");
  const vessel::Vessel vessel = buildVessel(*scene.vessel, scene.entry, scene.file);
  const std::string message = inputErrorOf([&] { resolveStart(scene, vessel); });
  EXPECT_NE(message.find("tube.yaml"), std::string::npos) << message;
  EXPECT_NE(message.find("drive.initial_insertion"), std::string::npos) << message;
  // The wire meets the outer wall where the bend of radius R has a lateral offset equal to the tube's radius r.
  const double bend = 0.03;
  const double side = scene.vessel->tube->radius;
  const double limit = 0.05 + std::sqrt((bend + side) * (bend + side) - bend * bend);
  const std::size_t number = message.find("less than ");
  ASSERT_NE(number, std::string::npos) << message;
  EXPECT_NEAR(std::stod(message.substr(number + 10)), limit, 0.5e-3) << message;
}

}  // namespace
}  // namespace endovascular_sim::scene
