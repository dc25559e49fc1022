#include "test/common/input_error_of.h"
#include "vessel/anatomy/anatomy_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "geometry/mesh_distance.h"
#include "geometry/mesh_topology.h"
#include "geometry/polyline.h"
#include "test/common/temporary_folder.h"
#include "vessel/anatomy/implicit_vessel.h"
#include "vessel/io/mesh_cache.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

const std::string kFork = std::string(TEST_DATA_DIR) + "/anatomies/fork.yaml";
const std::string kPlain = std::string(PROJECT_DIR) + "/config/anatomies/plain.yaml";
const std::string kNatural = std::string(PROJECT_DIR) + "/config/anatomies/natural.yaml";

std::string onlyFileOf(const TemporaryFolder& folder)
{
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    files.push_back(entry.path().string());
  return files.size() == 1 ? files[0] : std::string();
}

/** Mean distance from the axis to the wall along rays normal to the axis. */
double meanRadius(const geometry::MeshDistance& wall, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis)
{
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  double sum = 0.0;
  const int count = 64;
  for (int k = 0; k < count; ++k)
  {
    const double angle = 2.0 * M_PI * k / count;
    sum += wall.rayHit(centre, std::cos(angle) * u + std::sin(angle) * v);
  }
  return sum / count;
}

/** True if no other branch and no bulge affects the lumen near a point. */
bool onItsOwn(const CentrelineTree& tree, const Anatomy& anatomy, std::size_t branch, const Eigen::Vector3d& p,
              double radius)
{
  for (std::size_t other = 0; other < tree.branches.size(); ++other)
  {
    const bool joined = tree.branches[other].parent == static_cast<int>(branch) ||
                        tree.branches[branch].parent == static_cast<int>(other);
    const bool in_line = (joined && anatomy.branches[std::max(other, branch)].continues);
    if (other == branch || in_line)
      continue;
    const CentrelineBranch& near = tree.branches[other];
    for (std::size_t k = 0; k < near.points.size(); ++k)
      if ((near.points[k] - p).norm() < 2.2 * near.radii[k] + radius)
        return false;
  }
  for (const Bulge& bulge : anatomy.bulges)
    if ((bulge.centre - p).norm() < 2.2 * bulge.radius + radius)
      return false;
  return true;
}

/** Compares the radii of mesh and file along every branch.
 *  @return number of compared points */
int compareDiameters(const Anatomy& anatomy, const Vessel& vessel, double tolerance)
{
  const geometry::MeshDistance wall(vessel.mesh);
  int compared = 0;
  for (std::size_t b = 0; b < vessel.centreline.branches.size(); ++b)
  {
    const CentrelineBranch& branch = vessel.centreline.branches[b];
    for (std::size_t k = 2; k + 2 < branch.points.size(); k += 3)
    {
      if (!onItsOwn(vessel.centreline, anatomy, b, branch.points[k], branch.radii[k]))
        continue;
      const Eigen::Vector3d axis = (branch.points[k + 1] - branch.points[k - 1]).normalized();
      EXPECT_NEAR(meanRadius(wall, branch.points[k], axis) / branch.radii[k], 1.0, tolerance)
          << branch.name << " at point " << k << " of " << branch.points.size();
      ++compared;
    }
  }
  return compared;
}

TEST(ImplicitVessel, IsTheDistanceToACylinder)
{
  Anatomy anatomy = readAnatomy(kFork);
  anatomy.bulges.clear();
  anatomy.branches.resize(1);
  anatomy.branches[0].points = {{0, 0, 0}, {0, 0, 0.05}};
  anatomy.branches[0].diameters = {{0.0, 6e-3}};
  const ImplicitVessel field(anatomy, sampleChains(anatomy));
  for (int k = 0; k < 100; ++k)
  {
    const Eigen::Vector3d p(0.008 * std::sin(1.1 * k), 0.008 * std::cos(2.3 * k), 0.025 + 0.04 * std::sin(0.3 * k));
    const Eigen::Vector3d foot(0, 0, std::clamp(p.z(), 0.0, 0.05));
    EXPECT_NEAR(field.at(p).distance, (p - foot).norm() - 3e-3, 1e-12);
  }
}

TEST(ImplicitVessel, GradientAgreesWithFiniteDifferences)
{
  Anatomy anatomy = readAnatomy(kFork);
  // The gradient omits the slope of the radius along the branch; it is exact for a constant radius.
  anatomy.branches[0].diameters = {{0.0, 7e-3}};
  anatomy.branches[1].diameters = {{1.0, 7e-3}};
  anatomy.branches[2].diameters = {{0.0, 5e-3}};
  anatomy.branches[2].stenoses.clear();
  const ImplicitVessel field(anatomy, sampleChains(anatomy));
  const double h = 1e-7;
  for (int k = 0; k < 200; ++k)
  {
    const Eigen::Vector3d p(0.006 * std::sin(1.1 * k), 0.005 * std::cos(2.3 * k), 0.045 + 0.03 * std::sin(0.3 * k));
    const FieldSample sample = field.at(p);
    if (std::abs(sample.distance) > 1.5e-3)
      continue;  // the gradient is undefined on the axis
    Eigen::Vector3d difference;
    for (int i = 0; i < 3; ++i)
      difference[i] =
          (field.at(p + h * Eigen::Vector3d::Unit(i)).distance - field.at(p - h * Eigen::Vector3d::Unit(i)).distance) /
          (2.0 * h);
    // The gradient omits the small terms from the blending range and from the curvature of the spline.
    EXPECT_LT((difference - sample.gradient).norm(), 0.02) << p.transpose();
  }
}

TEST(AnatomyMesh, IsOneWatertightSurface)
{
  const Anatomy anatomy = readAnatomy(kFork);
  const Vessel vessel = loadAnatomy(kFork, "");
  const MeshReport report = checkMesh(vessel.mesh);
  EXPECT_EQ(report.summary(), "");
  EXPECT_EQ(report.genus, 0);
  EXPECT_GT(report.signed_volume, 0.0);
  EXPECT_GT(compareDiameters(anatomy, vessel, 0.02), 20);
}

TEST(AnatomyMesh, IsReproducibleBitForBit)
{
  EXPECT_EQ(loadAnatomy(kFork, "").mesh.hash(), loadAnatomy(kFork, "").mesh.hash());
}

TEST(AnatomyMesh, HasItsVerticesOnTheImplicitSurface)
{
  const Anatomy anatomy = readAnatomy(kFork);
  const std::vector<AnatomyChain> chains = sampleChains(anatomy);
  const ImplicitVessel field(anatomy, chains);
  for (const Eigen::Vector3d& v : generateAnatomyMesh(anatomy, chains).vertices)
    ASSERT_LT(std::abs(field.at(v).distance), 1e-7);
}

TEST(AnatomyMesh, RejectsBranchesThatFormALoop)
{
  Anatomy anatomy = readAnatomy(kFork);
  anatomy.branches[2].points.back() = {0.022, 0.0, 0.082};  // into the tip of the left branch
  anatomy.branches[2].points[1] = {-0.004, 0.0, 0.078};
  anatomy.branches[2].stenoses.clear();
  const std::string message = inputErrorOf([&] { generateAnatomyMesh(anatomy, sampleChains(anatomy)); });
  EXPECT_NE(message.find("branches that are not parent and child overlap"), std::string::npos) << message;
}

TEST(AnatomyCache, ReturnsTheSameMeshAndRebuildsDamagedEntries)
{
  const TemporaryFolder folder;
  const std::uint64_t hash = loadAnatomy(kFork, folder.path()).mesh.hash();
  const std::string file = onlyFileOf(folder);
  ASSERT_FALSE(file.empty());
  const Vessel cached = loadAnatomy(kFork, folder.path());
  EXPECT_EQ(cached.mesh.hash(), hash);
  EXPECT_NE(cached.notes.at(0).find("loaded from"), std::string::npos);

  {
    std::fstream damage(file, std::ios::in | std::ios::out | std::ios::binary);
    damage.seekp(5000);
    damage.put('x');
  }
  const Vessel repaired = loadAnatomy(kFork, folder.path());
  EXPECT_EQ(repaired.mesh.hash(), hash);
  EXPECT_NE(repaired.notes.at(0).find("generated"), std::string::npos);
  EXPECT_NE(loadAnatomy(kFork, folder.path()).notes.at(0).find("loaded from"), std::string::npos);

  std::filesystem::resize_file(file, 1000);
  EXPECT_NE(loadAnatomy(kFork, folder.path()).notes.at(0).find("generated"), std::string::npos);
  EXPECT_EQ(onlyFileOf(folder), file) << "no temporary file remains";
}

TEST(AnatomyCache, ReturnsNothingUnderAnotherKey)
{
  const TemporaryFolder folder;
  geometry::TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const std::string file = folder.file("x.mesh");
  ASSERT_TRUE(writeCachedMesh(file, 7, mesh));
  ASSERT_TRUE(readCachedMesh(file, 7).has_value());
  EXPECT_EQ(readCachedMesh(file, 7)->hash(), mesh.hash());
  EXPECT_FALSE(readCachedMesh(file, 8).has_value());
  EXPECT_FALSE(readCachedMesh(folder.file("absent.mesh"), 7).has_value());
}

TEST(AnatomyCache, ToleratesAReadOnlyFolder)
{
  const Vessel vessel = loadAnatomy(kFork, "/proc/no_such_folder");
  EXPECT_EQ(checkMesh(vessel.mesh).summary(), "");
  ASSERT_EQ(vessel.notes.size(), 2U);
  EXPECT_NE(vessel.notes[1].find("could not be cached"), std::string::npos);
}

/** Anatomy of the package with its vessel. */
struct Generated
{
  Anatomy anatomy;
  Vessel vessel;
};

/** Generates an anatomy once for all tests. */
const Generated& generated(const std::string& file)
{
  static std::map<std::string, Generated> all;
  const auto [entry, is_new] = all.try_emplace(file);
  if (is_new)
    entry->second = {readAnatomy(file), loadAnatomy(file, "")};
  return entry->second;
}

class PackageAnatomy : public testing::TestWithParam<std::string>
{
};

TEST_P(PackageAnatomy, IsOneWatertightSurfaceOfModestSize)
{
  const Vessel& vessel = generated(GetParam()).vessel;
  const MeshReport report = checkMesh(vessel.mesh);
  EXPECT_EQ(report.summary(), "");
  EXPECT_EQ(report.genus, 0);
  EXPECT_GT(report.signed_volume, 1e-4);
  EXPECT_LT(vessel.mesh.triangles.size(), 120000U);
  EXPECT_TRUE(vessel.warnings.empty());
}

TEST_P(PackageAnatomy, HasTheDiametersOfItsFile)
{
  EXPECT_GT(compareDiameters(generated(GetParam()).anatomy, generated(GetParam()).vessel, 0.05), 500);
}

INSTANTIATE_TEST_SUITE_P(AnatomyMesh, PackageAnatomy, testing::Values(kPlain, kNatural));

class PlainAnatomy : public testing::Test
{
protected:
  const Anatomy* anatomy_ = &generated(kPlain).anatomy;
  const Vessel* vessel_ = &generated(kPlain).vessel;
};

TEST_F(PlainAnatomy, NarrowsTheLeftAnteriorDescending)
{
  const auto& branches = vessel_->centreline.branches;
  const auto lad = std::find_if(branches.begin(), branches.end(),
                                [](const CentrelineBranch& b) { return b.name == "left_anterior_descending"; });
  ASSERT_NE(lad, branches.end());
  const auto throat = static_cast<std::size_t>(
      std::min_element(lad->radii.begin(), lad->radii.begin() + lad->radii.size() / 2) - lad->radii.begin());
  const geometry::MeshDistance wall(vessel_->mesh);
  const auto radiusAt = [&](std::size_t k)
  { return meanRadius(wall, lad->points[k], (lad->points[k + 1] - lad->points[k - 1]).normalized()); };
  std::size_t before = throat;
  while ((lad->points[before] - lad->points[throat]).norm() < 9e-3)
    --before;
  EXPECT_NEAR(radiusAt(throat) / radiusAt(before),
              1.0 - anatomy_->branches[static_cast<std::size_t>(lad - branches.begin())].stenoses.at(0).reduction,
              0.04);
}

TEST_F(PlainAnatomy, HasTheBranchesAndEndsOfTheIntervention)
{
  std::vector<std::string> ends;
  for (const CentrelineEnd& end : centrelineEnds(vessel_->centreline))
    ends.push_back(vessel_->centreline.branches[static_cast<std::size_t>(end.branch)].name);
  const std::vector<std::string> expected{"ascending_aorta",      "left_common_femoral",      "right_common_femoral",
                                          "right_common_carotid", "right_subclavian",         "left_common_carotid",
                                          "left_subclavian",      "left_anterior_descending", "left_circumflex",
                                          "right_coronary"};
  EXPECT_EQ(ends, expected);
}

TEST_F(PlainAnatomy, HasASmoothWallOfIsotropicFacets)
{
  const geometry::TriangleMesh& mesh = vessel_->mesh;
  const auto normal = [&mesh](int t)
  {
    const auto at = [&](int k)
    { return mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][k])]; };
    return Eigen::Vector3d((at(1) - at(0)).cross(at(2) - at(0)).normalized());
  };
  const std::vector<geometry::HalfEdge> uses = geometry::sortedHalfEdges(mesh);
  std::vector<double> angles;
  for (std::size_t begin = 0; begin < uses.size(); begin += 2)
    angles.push_back(
        std::acos(std::clamp(normal(uses[begin].triangle).dot(normal(uses[begin + 1].triangle)), -1.0, 1.0)));
  std::sort(angles.begin(), angles.end());
  // 20 facets around the lumen: dihedral angle of 18° at an edge along the vessel
  EXPECT_LT(angles[angles.size() / 2], 12.0 * M_PI / 180.0);
  EXPECT_LT(angles[angles.size() * 999 / 1000], 25.0 * M_PI / 180.0);
  // At the sharpest carina
  EXPECT_LT(angles.back(), 75.0 * M_PI / 180.0);

  double worst = 1e300;
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
    {
      const auto at = [&](int i) { return mesh.vertices[static_cast<std::size_t>(t[(k + i) % 3])]; };
      const Eigen::Vector3d u = (at(1) - at(0)).normalized();
      worst = std::min(worst, std::acos(std::clamp(u.dot((at(2) - at(0)).normalized()), -1.0, 1.0)));
    }
  EXPECT_GT(worst, 10.0 * M_PI / 180.0);
}

TEST_F(PlainAnatomy, HasTheMeshOfEarlierVersions)
{
  EXPECT_EQ(vessel_->mesh.triangles.size(), 97870U);
  EXPECT_EQ(vessel_->mesh.hash(), 0x066b9f41686ceb64U);
}

class NaturalAnatomy : public testing::Test
{
protected:
  const CentrelineBranch& branch(const std::string& name) const
  {
    for (const CentrelineBranch& b : vessel_->centreline.branches)
      if (b.name == name)
        return b;
    throw std::runtime_error("no branch " + name);
  }
  /** Direction over the first 8 mm of a branch. */
  Eigen::Vector3d direction(const std::string& name) const
  {
    const CentrelineBranch& b = branch(name);
    std::size_t k = 0;
    while ((b.points[k] - b.points[0]).norm() < 8e-3)
      ++k;
    return (b.points[k] - b.points[0]).normalized();
  }
  static double degrees(const Eigen::Vector3d& u, const Eigen::Vector3d& v)
  {
    return std::acos(std::clamp(u.dot(v), -1.0, 1.0)) * 180.0 / M_PI;
  }
  const Vessel* vessel_ = &generated(kNatural).vessel;
};

TEST_F(NaturalAnatomy, HasTheBranchesOfThePlainAnatomyInTheSamePlaces)
{
  const Anatomy plain = readAnatomy(kPlain);
  const CentrelineTree tree = anatomyCentreline(plain, sampleChains(plain));
  for (const CentrelineBranch& b : tree.branches)
  {
    EXPECT_LT((branch(b.name).points.front() - b.points.front()).norm(), 0.025) << b.name;
    const bool is_groin = b.name.find("femoral") != std::string::npos;
    EXPECT_LT((branch(b.name).points.back() - b.points.back()).norm(), is_groin ? 1e-6 : 1.0) << b.name;
  }
}

TEST_F(NaturalAnatomy, HasSideBranchesOfTheCoronaryArteriesAndOfTheAorta)
{
  for (const char* name :
       {"first_diagonal", "second_diagonal", "first_septal", "second_septal", "first_obtuse_marginal",
        "second_obtuse_marginal", "conus", "acute_marginal", "posterior_descending", "posterolateral", "coeliac_trunk",
        "superior_mesenteric", "inferior_mesenteric", "left_renal", "right_renal", "left_internal_iliac",
        "right_internal_iliac"})
    EXPECT_GT(geometry::Polyline(branch(name).points).length(), 0.015) << name;
}

// Means and standard deviations of docs/VESSELS.md.
TEST_F(NaturalAnatomy, HasAnglesAndLengthsWithinPublishedRanges)
{
  EXPECT_NEAR(degrees(direction("left_anterior_descending"), direction("left_circumflex")), 75.0, 23.0);
  EXPECT_NEAR(degrees(direction("superior_mesenteric"), -Eigen::Vector3d::UnitZ()), 53.0, 31.0);
  const Eigen::Vector3d arch = branch("left_subclavian").points.front() - branch("brachiocephalic").points.front();
  EXPECT_NEAR(std::atan2(std::abs(arch.x()), std::abs(arch.y())) * 180.0 / M_PI, 50.0, 14.0);
  const double renal = branch("left_renal").points.front().z();
  EXPECT_NEAR(branch("coeliac_trunk").points.front().z() - renal, 0.032, 0.008);
  EXPECT_NEAR(branch("superior_mesenteric").points.front().z() - renal, 0.017, 0.005);
}

}  // namespace
}  // namespace endovascular_sim::vessel
