#include "patient/body/body_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "common/error.h"
#include "test/common/temporary_folder.h"
#include "test/fluoroscopy/shapes.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/io/mesh_reader.h"

namespace endovascular_sim::patient
{
namespace
{

/** Largest density of bone on the triangles' corners and centres, and inside of them by half a voxel [kg/m³]. */
double boneAtWall(const DensityVolume& volume, const geometry::TriangleMesh& mesh)
{
  double bone = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d inward = -(b - a).cross(c - a).normalized() * 0.5 * volume.grid().spacing.x();
    const Eigen::Vector3d middle = (a + b + c) / 3.0;
    for (const Eigen::Vector3d& p : {a, middle, Eigen::Vector3d(middle + inward)})
      bone = std::max(bone, volume.interpolate(p).bone);
  }
  return bone;
}

const vessel::Vessel& anatomy()
{
  static const vessel::Vessel vessel = vessel::loadAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/plain.yaml");
  return vessel;
}

const PatientVolume& anatomyBody()
{
  static const PatientVolume model = makeBody(anatomy(), {2.5e-3, 1});
  return model;
}

TEST(BodyModel, NoLumenOfThePlainAnatomyLiesInsideBone)
{
  const DensityVolume& volume = *anatomyBody().volume;
  EXPECT_EQ(boneAtWall(volume, anatomy().mesh), 0.0);
  for (const vessel::CentrelineBranch& branch : anatomy().centreline.branches)
    for (std::size_t i = 0; i < branch.points.size(); ++i)
      for (int direction = 0; direction < 27; ++direction)
      {
        const Eigen::Vector3d d(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
        const Eigen::Vector3d p = branch.points[i] + branch.radii[i] * (d.norm() > 0.0 ? d.normalized() : d);
        ASSERT_EQ(volume.interpolate(p).bone, 0.0) << branch.name << " " << i;
      }
}

TEST(BodyModel, TheLumenIsBloodAndTheOutsideIsAir)
{
  const DensityVolume& volume = *anatomyBody().volume;
  for (const vessel::CentrelineBranch& branch : anatomy().centreline.branches)
  {
    if (branch.name.find("aort") == std::string::npos)
      continue;
    for (const Eigen::Vector3d& p : branch.points)
      EXPECT_NEAR(volume.interpolate(p).tissue, 1060.0, 1e-9) << branch.name;
  }
  EXPECT_EQ(volume.at(0, 0, volume.grid().size.z() / 2).tissue, 0.0);
}

TEST(BodyModel, HasThePlausibleMassOfATorso)
{
  double tissue = 0.0, bone = 0.0;
  for (const std::uint16_t voxel : anatomyBody().volume->voxels())
  {
    tissue += DensityVolume::decode(voxel).tissue;
    bone += DensityVolume::decode(voxel).bone;
  }
  const double voxel = std::pow(anatomyBody().volume->grid().spacing.x(), 3);
  EXPECT_NEAR(tissue * voxel, 34.0, 8.0);  // [kg]
  EXPECT_GT(bone * voxel, 0.6);
  EXPECT_LT(bone * voxel, 4.0);
}

TEST(BodyModel, IsPlacedByLandmarksAndSaysSo)
{
  const std::string& note = anatomyBody().notes.at(0);
  EXPECT_EQ(note, "body placed by the aortic bifurcation and the aortic arch, at 96 % of its usual size");
}

TEST(BodyModel, IsFittedToTheExtentOfAVesselWithoutLandmarksAndSaysSo)
{
  vessel::Vessel tube;
  tube.mesh = fluoroscopy::cylinder({0.3, 0.2, 0.1}, {0.31, 0.2, 0.25}, 0.01, 24);
  const PatientVolume model = makeBody(tube, {5e-3, 1});
  EXPECT_NE(model.notes.at(0).find("no branches named"), std::string::npos);
  EXPECT_EQ(boneAtWall(*model.volume, tube.mesh), 0.0);
  EXPECT_NEAR(model.volume->interpolate({0.305, 0.2, 0.175}).tissue, 1060.0, 1e-9);
}

TEST(BodyModel, NoLumenOfARealMeshLiesInsideBone)
{
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  if (folder == nullptr)
    GTEST_SKIP() << "ENDOVASCULAR_DATA_DIR is not set";
  vessel::Vessel real;
  real.mesh = vessel::readMesh(std::string(folder) + "/aortic_arch_tree.obj", 1e-3);
  for (Eigen::Vector3d& v : real.mesh.vertices)
    v = Eigen::Vector3d(v.y(), v.z(), -v.x());  // head towards −x; left and back do not matter here
  for (Eigen::Vector3i& t : real.mesh.triangles)
    std::swap(t[1], t[2]);
  if (real.mesh.signedVolume() < 0.0)
    for (Eigen::Vector3i& t : real.mesh.triangles)
      std::swap(t[1], t[2]);
  const PatientVolume model = makeBody(real, {2.5e-3, 1});
  EXPECT_EQ(boneAtWall(*model.volume, real.mesh), 0.0);
  EXPECT_NE(model.notes.at(0).find("groins to neck"), std::string::npos);
}

TEST(BodyModel, EqualInputsGiveEqualBytesAndTheSeedChangesThem)
{
  vessel::Vessel none;
  const PatientVolume a = makeBody(none, {5e-3, 3}), b = makeBody(none, {5e-3, 3}), c = makeBody(none, {5e-3, 4});
  EXPECT_EQ(a.volume->voxels(), b.volume->voxels());
  EXPECT_NE(a.volume->voxels(), c.volume->voxels());
}

TEST(BodyModel, IsTakenFromTheCacheWhichADamagedEntryDoesNotStop)
{
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  vessel::Vessel none;
  const PatientVolume made = loadBody(none, {8e-3, 1}, folder);
  const PatientVolume cached = loadBody(none, {8e-3, 1}, folder);
  EXPECT_EQ(made.volume->voxels(), cached.volume->voxels());
  EXPECT_NE(cached.notes.back().find("loaded from"), std::string::npos);
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    std::filesystem::resize_file(entry.path(), 1000);
  EXPECT_EQ(loadBody(none, {8e-3, 1}, folder).volume->voxels(), made.volume->voxels());
  EXPECT_NE(loadBody(none, {8e-3, 1}, "/proc/none").notes.back().find("not cached"), std::string::npos);
}

TEST(BodyModel, RefusesSpacingsOutsideOfItsRange)
{
  EXPECT_THROW(makeBody({}, {1.25, 1}), InputError);
  EXPECT_THROW(makeBody({}, {1e-4, 1}), InputError);
}

}  // namespace
}  // namespace endovascular_sim::patient
