#include "test/common/input_error_of.h"
#include "vessel/lesion/add_lesions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <Eigen/Geometry>

#include "common/error.h"
#include "geometry/mesh_distance.h"
#include "geometry/polyline.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/anatomy/tube.h"
#include "vessel/centreline/lumen_section.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/model/vessel.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kTubeRadius = 1.5e-3;  // [m]

Vessel tube(int facets_around = 48, double curvature = 0.0)
{
  TubeShape shape;
  shape.radius = kTubeRadius;
  shape.facets_around = facets_around;
  shape.facet_length = kTubeRadius;
  shape.pieces = {{0.06, curvature, 0.3}};
  Vessel vessel;
  vessel.source = "tube";
  vessel.mesh = tubeMesh(shape);
  vessel.centreline = tubeCentreline(shape);
  return vessel;
}

Lesion lesionOf(double grade, double length = 0.01)
{
  Lesion lesion;
  lesion.branch = "tube";
  lesion.from_start = 0.03;
  lesion.length = length;
  lesion.grade = grade;
  return lesion;
}

/** Largest relative loss of diameter along the lesion. */
double measuredGrade(const Vessel& before, const Vessel& after)
{
  const PlacedLesion& placed = after.lesions.back();  // lesions of the anatomy precede added ones
  const auto b = static_cast<std::size_t>(placed.branch);
  const geometry::Polyline now(after.centreline.branches[b].points);
  const geometry::Polyline healthy(before.centreline.branches[b].points);
  const geometry::MeshDistance narrowed(after.mesh);
  const geometry::MeshDistance whole(before.mesh);
  double largest = 0.0;
  for (int k = -4; k <= 4; ++k)
  {
    const double arc = placed.middle + 0.05 * k * placed.lesion.length;
    const double diameter = lumenDiameter(narrowed, now.at(arc), now.tangentAt(arc));
    const geometry::Polyline::Foot foot = healthy.nearest(now.at(arc));
    largest = std::max(largest, 1.0 - diameter / lumenDiameter(whole, foot.point, healthy.tangentAt(foot.arc)));
  }
  return largest;
}

double widestAngle(const geometry::TriangleMesh& mesh)
{
  double widest = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
    {
      const Eigen::Vector3d u = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
      const Eigen::Vector3d v = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
      widest = std::max(widest, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  return widest;
}

TEST(Lesion, NarrowsATubeByItsGradeWithACosineProfile)
{
  for (double grade : {0.2, 0.65, 0.9})
  {
    Vessel vessel = tube(96);
    addLesions(vessel, {lesionOf(grade)}, "scene");
    const geometry::Polyline axis(vessel.centreline.branches.front().points);
    const geometry::MeshDistance wall(vessel.mesh);
    const double healthy = 2.0 * kTubeRadius;
    for (int k = -6; k <= 6; ++k)
    {
      const double x = k * 0.001;
      const double lost = std::abs(k) >= 5 ? 0.0 : 0.5 * grade * (1.0 + std::cos(2.0 * M_PI * x / 0.01));
      EXPECT_NEAR(lumenDiameter(wall, axis.at(0.03 + x), axis.tangentAt(0.03 + x)), healthy * (1.0 - lost),
                  0.01 * healthy)
          << grade << " at " << x;
      const double radius = axis.interpolate(vessel.centreline.branches.front().radii, 0.03 + x);
      EXPECT_NEAR(radius, kTubeRadius * (1.0 - lost), 0.01 * kTubeRadius);
    }
    EXPECT_NEAR(vessel.lesions.front().middle, 0.03, 1e-12);
    EXPECT_NEAR(vessel.lesions.front().narrowed_diameter, healthy * (1.0 - grade), 0.005 * healthy);
  }
}

TEST(Lesion, HasACleanMeshWithFacetsSmallRelativeToTheLumen)
{
  for (double curvature : {0.0, 60.0})
    for (double grade : {0.5, 0.9, 0.99})
    {
      Vessel vessel = tube(32, curvature);
      addLesions(vessel, {lesionOf(grade, 0.006)}, "scene");
      const MeshReport report = checkMesh(vessel.mesh);
      EXPECT_TRUE(report.clean()) << report.summary();
      EXPECT_EQ(report.genus, 0);
      EXPECT_LT(vessel.mesh.triangles.size(), 60000U);
      EXPECT_LT(widestAngle(vessel.mesh), 160.0 / 180.0 * M_PI);
      const geometry::Polyline axis(vessel.centreline.branches.front().points);
      const double narrow = kTubeRadius * (1.0 - grade);
      double longest = 0.0;
      for (const Eigen::Vector3i& t : vessel.mesh.triangles)
        for (int k = 0; k < 3; ++k)
        {
          const Eigen::Vector3d& a = vessel.mesh.vertices[t[k]];
          const Eigen::Vector3d& b = vessel.mesh.vertices[t[(k + 1) % 3]];
          if (axis.nearest(a).distance < 1.1 * narrow && axis.nearest(b).distance < 1.1 * narrow)
            longest = std::max(longest, (a - b).norm());
        }
      EXPECT_GT(longest, 0.0);
      EXPECT_LT(longest, 0.5 * narrow);
    }
}

TEST(Lesion, PreservesTheWallElsewhereBitForBit)
{
  const Vessel before = tube();
  Vessel after = before;
  addLesions(after, {lesionOf(0.6)}, "scene");
  std::set<std::array<double, 3>> positions;
  for (const Eigen::Vector3d& p : after.mesh.vertices)
    positions.insert({p.x(), p.y(), p.z()});
  int kept = 0;
  for (std::size_t v = 0; v < before.mesh.vertices.size(); ++v)
  {
    const double arc = before.mesh.vertices[v].z() + kTubeRunIn * kTubeRadius;
    if (std::abs(arc - 0.03) < 0.005 + 1e-9)
      continue;
    const Eigen::Vector3d& p = before.mesh.vertices[v];
    EXPECT_EQ(positions.count({p.x(), p.y(), p.z()}), 1U);
    ++kept;
  }
  EXPECT_GT(kept, 100);
}

TEST(Lesion, PreservesTheWallOppositeToEccentricPlaque)
{
  const Vessel before = tube();
  Vessel after = before;
  Lesion lesion = lesionOf(0.6);
  lesion.eccentricity = 1.0;
  lesion.angle = 0.5 * M_PI;  // direction y
  addLesions(after, {lesion}, "scene");
  EXPECT_NEAR(measuredGrade(before, after), 0.6, 0.01);
  const geometry::MeshDistance wall(after.mesh);
  const Eigen::Vector3d middle(0.0, 0.0, 0.03 - kTubeRunIn * kTubeRadius);
  const Eigen::Vector3d low = middle - 0.9 * kTubeRadius * Eigen::Vector3d::UnitY();
  EXPECT_NEAR(wall.rayHit(low, -Eigen::Vector3d::UnitY()), 0.1 * kTubeRadius, 0.01 * kTubeRadius);
  EXPECT_NEAR(wall.rayHit(low, Eigen::Vector3d::UnitY()), (2.0 * 0.4 - 0.1) * kTubeRadius, 0.02 * kTubeRadius);
  EXPECT_TRUE(checkMesh(after.mesh).clean());
}

TEST(Lesion, NarrowsTheLeftAnteriorDescendingArteryByItsGrade)
{
  const Vessel before = loadAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/plain.yaml");
  for (double eccentricity : {0.0, 0.7})
  {
    Vessel after = before;
    Lesion lesion = lesionOf(0.7, 0.012);
    lesion.branch = "left_anterior_descending";
    lesion.from_start = 0.025;
    lesion.eccentricity = eccentricity;
    addLesions(after, {lesion}, "scene");
    EXPECT_NEAR(measuredGrade(before, after), 0.7, 0.02);
    const MeshReport report = checkMesh(after.mesh);
    EXPECT_TRUE(report.clean()) << report.summary();
    EXPECT_EQ(report.genus, 0);
    EXPECT_LT(after.mesh.triangles.size(), before.mesh.triangles.size() + 20000);
  }
}

/** Polyline through the centres of cross-sections of the lumen, from a point in steps of 2 mm. */
CentrelineBranch lumenAxis(const geometry::TriangleMesh& mesh, Eigen::Vector3d p, Eigen::Vector3d direction, int steps)
{
  const geometry::MeshDistance wall(mesh);
  CentrelineBranch branch;
  branch.name = "descending";
  for (int step = 0; step < steps; ++step)
  {
    const Eigen::Vector3d u = direction.unitOrthogonal();
    const Eigen::Vector3d v = direction.cross(u);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int k = 0; k < 32; ++k)
    {
      const Eigen::Vector3d ray = std::cos(k * M_PI / 16.0) * u + std::sin(k * M_PI / 16.0) * v;
      middle += 2.0 / 32.0 * wall.rayHit(p, ray) * ray;
    }
    p += 0.5 * middle;
    if (!branch.points.empty())
      direction = (0.5 * direction + 0.5 * (p - branch.points.back()).normalized()).normalized();
    branch.points.push_back(p);
    branch.radii.push_back(wall.closest(p).distance);
    p += 2e-3 * direction;
  }
  return branch;
}

TEST(Lesion, CanBeAddedToASegmentedAorta)
{
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  const std::string file = folder == nullptr ? "" : std::string(folder) + "/aortic_arch_tree.obj";
  if (file.empty() || !std::filesystem::exists(file))
    GTEST_SKIP() << "ENDOVASCULAR_DATA_DIR is not set to the folder of the segmented vessels";
  Vessel before;
  before.source = file;
  before.mesh = repairMesh(readMesh(file, 1e-3), file).mesh;
  before.centreline.branches = {
      lumenAxis(before.mesh, {-0.32, 0.0595, -0.0736}, Eigen::Vector3d(40.0, -11.0, 21.0).normalized(), 40)};
  for (double grade : {0.4, 0.75})
  {
    Vessel after = before;
    Lesion lesion = lesionOf(grade, 0.03);
    lesion.branch = "descending";
    lesion.from_start = 0.04;
    addLesions(after, {lesion}, "scene");
    EXPECT_NEAR(measuredGrade(before, after), grade, 0.02);
    const MeshReport report = checkMesh(after.mesh);
    EXPECT_TRUE(report.clean()) << report.summary();
    EXPECT_EQ(report.genus, checkMesh(before.mesh).genus);
  }
}

TEST(Lesion, PreservesTheLumenAtGradeZero)
{
  const Vessel before = tube();
  Vessel after = before;
  addLesions(after, {lesionOf(0.0)}, "scene");
  EXPECT_NEAR(after.mesh.signedVolume(), before.mesh.signedVolume(), 1e-12 * before.mesh.signedVolume());
}

TEST(Lesion, IsReproducibleBitForBit)
{
  Vessel a = tube();
  Vessel b = tube();
  addLesions(a, {lesionOf(0.7)}, "scene");
  addLesions(b, {lesionOf(0.7)}, "scene");
  EXPECT_EQ(a.mesh.hash(), b.mesh.hash());
}

TEST(Lesion, CanBeAddedBesideAnotherOne)
{
  Vessel vessel = tube();
  Lesion second = lesionOf(0.5);
  second.from_start = 0.045;
  addLesions(vessel, {lesionOf(0.7), second}, "scene");
  ASSERT_EQ(vessel.lesions.size(), 2U);
  const geometry::MeshDistance wall(vessel.mesh);
  const geometry::Polyline axis(vessel.centreline.branches.front().points);
  EXPECT_NEAR(lumenDiameter(wall, axis.at(0.03), axis.tangentAt(0.03)), 0.3 * 2.0 * kTubeRadius, 3e-5);
  EXPECT_NEAR(lumenDiameter(wall, axis.at(0.045), axis.tangentAt(0.045)), 0.5 * 2.0 * kTubeRadius, 3e-5);
}

std::string errorMessage(const Lesion& lesion)
{
  Vessel vessel = tube();
  return inputErrorOf([&] { addLesions(vessel, {lesion}, "scene.yaml"); });
}

TEST(Lesion, CanBeSpecifiedByAPointInTheLumen)
{
  Vessel by_name = tube();
  addLesions(by_name, {lesionOf(0.5)}, "scene.yaml");
  Lesion lesion = lesionOf(0.5);
  lesion.branch.clear();
  lesion.from_start = std::numeric_limits<double>::quiet_NaN();
  lesion.at = Eigen::Vector3d(0.0005, -0.0004, 0.024);  // the centreline begins 6 mm proximally
  Vessel by_point = tube();
  addLesions(by_point, {lesion}, "scene.yaml");
  EXPECT_EQ(by_point.lesions.back().lesion.branch, "tube");
  EXPECT_NEAR(by_point.lesions.back().middle, 0.03, 1e-9);
  EXPECT_NEAR(by_point.lesions.back().narrowed_diameter, by_name.lesions.back().narrowed_diameter, 1e-7);
  lesion.at = Eigen::Vector3d(0.0, 0.004, 0.024);
  EXPECT_NE(errorMessage(lesion).find("vessel.lesions.0.at: lies 2.5 mm outside of the nearest lumen, \"tube\""),
            std::string::npos);
}

TEST(Lesion, IsRejectedWithTheAvailableBranchesOrRange)
{
  Lesion lesion = lesionOf(0.5);
  lesion.branch = "lad";
  EXPECT_EQ(errorMessage(lesion), "scene.yaml: vessel.lesions.0.branch: no branch \"lad\" in tube; it has tube");
  EXPECT_NE(errorMessage(lesionOf(1.0)).find("vessel.lesions.0.grade: must be a diameter stenosis"), std::string::npos);
  EXPECT_NE(errorMessage(lesionOf(0.5, 0.2)).find("is longer than the branch \"tube\", 66 mm"), std::string::npos);
  lesion = lesionOf(0.5);
  lesion.from_start = 0.064;
  EXPECT_NE(errorMessage(lesion).find("between 5 mm and 61 mm from the start of \"tube\""), std::string::npos);
}

TEST(Lesion, IsRejectedWhereTheBranchRunsInsideItsParent)
{
  Vessel vessel = loadAnatomy(std::string(TEST_DATA_DIR) + "/anatomies/fork.yaml");
  Lesion lesion = lesionOf(0.5, 0.004);
  lesion.branch = "right";
  lesion.from_start = 0.002;
  EXPECT_THROW(addLesions(vessel, {lesion}, "scene"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::vessel
