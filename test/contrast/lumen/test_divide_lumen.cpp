#include "contrast/lumen/divide_lumen.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <set>

#include "contrast/lumen/branch_line.h"
#include "geometry/mesh_topology.h"
#include "test/common/input_error_of.h"
#include "test/contrast/lumen_fixtures.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::contrast
{
namespace
{

double sum(const std::vector<double>& values)
{
  double result = 0.0;
  for (const double value : values)
    result += value;
  return result;
}

/** Triangles of each part, outward oriented. */
std::vector<geometry::TriangleMesh> surfaces(const LumenCells& lumen, const std::vector<Eigen::Vector3d>& positions)
{
  std::vector<geometry::TriangleMesh> result(lumen.parts);
  for (geometry::TriangleMesh& mesh : result)
    mesh.vertices = positions;
  for (const WallPiece& wall : lumen.walls)
    result[static_cast<std::size_t>(wall.part)].triangles.push_back(wall.corners);
  for (const LumenCap& cap : lumen.caps)
  {
    result[static_cast<std::size_t>(cap.plus)].triangles.push_back(cap.corners);
    result[static_cast<std::size_t>(cap.minus)].triangles.emplace_back(cap.corners[0], cap.corners[2], cap.corners[1]);
  }
  return result;
}

/** True if every directed edge has its reverse, and the triangles are connected over edges. */
void expectClosedAndConnected(const geometry::TriangleMesh& surface, const std::string& name)
{
  ASSERT_FALSE(surface.triangles.empty()) << name;
  const std::vector<geometry::HalfEdge> edges = geometry::sortedHalfEdges(surface);
  for (std::size_t k = 0; k < edges.size();)
  {
    const std::size_t end = geometry::endOfEdge(edges, k);
    int balance = 0;
    for (; k < end; ++k)
      balance += edges[k].forward ? 1 : -1;
    ASSERT_EQ(balance, 0) << name;
  }
  const std::vector<int> components = geometry::triangleComponents(surface, edges);
  EXPECT_EQ(std::set<int>(components.begin(), components.end()).size(), 1U) << name;
}

void expectPartition(const DividedVessel& vessel, double least_parts)
{
  const LumenCells lumen = divideLumen(vessel.mesh, vessel.centreline, vessel.cells);
  ASSERT_EQ(lumen.volumes.size(), vessel.cells.size());
  const double whole = vessel.mesh.signedVolume();
  EXPECT_NEAR(sum(lumen.volumes), whole, 1e-12 * whole) << vessel.name;
  for (std::size_t k = 0; k < lumen.volumes.size(); ++k)
    EXPECT_GT(lumen.volumes[k], 0.0) << vessel.name << ", cell " << k;
  EXPECT_GE(static_cast<double>(lumen.parts), least_parts * static_cast<double>(vessel.cells.size())) << vessel.name;
  const std::vector<Eigen::Vector3d> positions = lumen.place(vessel.mesh.vertices);
  const std::vector<geometry::TriangleMesh> parts = surfaces(lumen, positions);
  for (std::size_t p = 0; p < parts.size(); ++p)
    expectClosedAndConnected(parts[p], vessel.name + ", part " + std::to_string(p));
}

TEST(DivideLumen, OfATubeGivesClosedConnectedPartsThatFillIt)
{
  expectPartition(bentTube(), 1.0);
}

TEST(DivideLumen, OfGeneratedAnatomiesGivesClosedConnectedPartsThatFillThem)
{
  for (const char* name : {"fork", "plain", "natural"})
    expectPartition(generatedVessel(name), 0.85);  // some cells end before the mouth of their branch
}

TEST(DivideLumen, OfASegmentedVesselGivesClosedConnectedPartsThatFillIt)
{
  const DividedVessel* vessel = segmentedVessel("aortic_arch_tree.obj");
  if (vessel == nullptr)
    GTEST_SKIP() << "ENDOVASCULAR_DATA_DIR is not set to the folder of the segmented vessels";
  expectPartition(*vessel, 0.5);  // of 81 branches, many are as short as they are wide
}

TEST(DivideLumen, OfAVesselWithALoopGivesClosedConnectedPartsThatFillIt)
{
  ASSERT_EQ(vessel::checkMesh(vesselWithLoop().mesh).genus, 1);
  expectPartition(vesselWithLoop(), 0.75);
}

TEST(DivideLumen, CutsATubeIntoCellsOfItsSectionTimesTheirLength)
{
  const DividedVessel tube = bentTube();
  const LumenCells lumen = divideLumen(tube.mesh, tube.centreline, tube.cells);
  const double section = 0.5 * 32.0 * std::sin(2.0 * M_PI / 32.0) * 9e-6;  // polygon of 32 corners
  for (std::size_t k = 1; k + 1 < tube.cells.size(); ++k)
    EXPECT_NEAR(lumen.volumes[k], section * (tube.cells[k].end - tube.cells[k].begin), 3e-3 * lumen.volumes[k]) << k;
}

TEST(DivideLumen, BoundsEveryCellByPlanesNormalToTheCentreline)
{
  const DividedVessel& vessel = generatedVessel("natural");
  const LumenCells lumen = divideLumen(vessel.mesh, vessel.centreline, vessel.cells);
  const std::vector<Eigen::Vector3d> positions = lumen.place(vessel.mesh.vertices);
  std::vector<BranchLine> lines;
  for (const vessel::CentrelineBranch& branch : vessel.centreline.branches)
    lines.emplace_back(branch);
  std::map<int, std::vector<std::size_t>> cells_of_part;
  for (std::size_t k = 0; k < vessel.cells.size(); ++k)
    cells_of_part[lumen.part_of_cell[k]].push_back(k);
  // Planes at the ends of a part's cells, and at the mouth of their branch.
  const auto distance = [&](int part, const Eigen::Vector3d& p)
  {
    double least = 1.0;
    for (const std::size_t k : cells_of_part[part])
    {
      const auto b = static_cast<std::size_t>(vessel.cells[k].branch);
      for (const double arc : {vessel.cells[k].end, lumen.mouths[b]})
      {
        const CutPlane plane = lines[b].planeAt(arc);
        const double length = lines[b].length();
        const Eigen::Vector3d chord =
            lines[b].line().at(std::min(arc + 1e-3, length)) - lines[b].line().at(std::max(arc - 1e-3, 0.0));
        EXPECT_GT(plane.normal.dot(chord.normalized()), 0.9);
        least = std::min(least, std::abs(plane.normal.dot(p - plane.point)));
      }
    }
    return least;
  };
  std::size_t checked = 0;
  for (const LumenCap& cap : lumen.caps)
    for (int c = 0; c < 3; ++c, ++checked)
    {
      const Eigen::Vector3d& p = positions[static_cast<std::size_t>(cap.corners[c])];
      ASSERT_LT(std::min(distance(cap.plus, p), distance(cap.minus, p)), 1e-9);
    }
  EXPECT_GT(checked, 10000U);
}

/** Parts that hold only cells of a branch, behind its mouth. */
std::set<int> ownParts(const DividedVessel& vessel, const LumenCells& lumen, int branch)
{
  std::set<int> parts;
  for (std::size_t k = 0; k < vessel.cells.size(); ++k)
    if (vessel.cells[k].branch == branch && vessel.cells[k].end > lumen.mouths[static_cast<std::size_t>(branch)])
      parts.insert(lumen.part_of_cell[k]);
  for (std::size_t k = 0; k < vessel.cells.size(); ++k)  // a cell without a lumen of its own shares a neighbour's part
    if (vessel.cells[k].branch != branch)
      parts.erase(lumen.part_of_cell[k]);
  return parts;
}

/** Expects that walls of a branch near its mouth are those of its own lumen. */
void expectOwnWalls(const DividedVessel& vessel, const LumenCells& lumen, const std::vector<Eigen::Vector3d>& positions,
                    std::size_t b)
{
  const vessel::CentrelineBranch& branch = vessel.centreline.branches[b];
  ASSERT_TRUE(std::isfinite(lumen.mouths[b])) << vessel.name << ", " << branch.name;
  const BranchLine line(branch);
  const std::set<int> parts = ownParts(vessel, lumen, static_cast<int>(b));
  EXPECT_FALSE(parts.empty()) << vessel.name << ", " << branch.name;
  for (const WallPiece& wall : lumen.walls)
    if (parts.count(wall.part) > 0)
      for (int c = 0; c < 3; ++c)
      {
        const geometry::Polyline::Foot foot = line.line().nearest(positions[static_cast<std::size_t>(wall.corners[c])]);
        if (foot.arc < lumen.mouths[b] + 3.0 * line.radiusAt(foot.arc))
        {
          ASSERT_LT(foot.distance, 1.9 * line.radiusAt(foot.arc))
              << vessel.name << ", " << branch.name << " at " << foot.arc;
        }
      }
}

TEST(DivideLumen, LeavesBulgesToTheParentWhereBranchesBegin)
{
  for (const DividedVessel* vessel : {&generatedVessel("natural"), &generatedVessel("plain"), &vesselWithLoop()})
  {
    const LumenCells lumen = divideLumen(vessel->mesh, vessel->centreline, vessel->cells);
    const std::vector<Eigen::Vector3d> positions = lumen.place(vessel->mesh.vertices);
    for (std::size_t b = 0; b < vessel->centreline.branches.size(); ++b)
      expectOwnWalls(*vessel, lumen, positions, b);
  }
}

/** Nearly parallel branches part far behind the place where their centrelines do. */
TEST(DivideLumen, CutsAShallowForkWhereItsLumensPart)
{
  const DividedVessel& vessel = generatedVessel("natural");
  const LumenCells lumen = divideLumen(vessel.mesh, vessel.centreline, vessel.cells);
  const auto branch = [&](const std::string& name)
  {
    for (std::size_t b = 0; b < vessel.centreline.branches.size(); ++b)
      if (vessel.centreline.branches[b].name == name)
        return b;
    ADD_FAILURE() << name;
    return std::size_t{0};
  };
  const std::size_t side = branch("second_diagonal"), trunk = branch("left_anterior_descending");
  const BranchLine line(vessel.centreline.branches[side]), parent(vessel.centreline.branches[trunk]);
  const geometry::Polyline::Foot foot = parent.line().nearest(line.line().at(lumen.mouths[side]));
  EXPECT_GT(foot.distance, 0.9 * (line.radiusAt(lumen.mouths[side]) + parent.radiusAt(foot.arc)));
  EXPECT_GE(ownParts(vessel, lumen, static_cast<int>(trunk)).size(), 50U) << "of 57 cells";
}

TEST(LumenCells, FollowAWallThatMoves)
{
  const DividedVessel tube = bentTube();
  const LumenCells lumen = divideLumen(tube.mesh, tube.centreline, tube.cells);
  geometry::TriangleMesh moved = tube.mesh;
  for (Eigen::Vector3d& p : moved.vertices)
    p += 0.3e-3 * Eigen::Vector3d(std::sin(300.0 * p.z()), std::cos(200.0 * p.x()), std::sin(250.0 * p.y()));
  ASSERT_TRUE(lumen.fits(moved));
  const std::vector<Eigen::Vector3d> positions = lumen.place(moved.vertices);
  EXPECT_NEAR(sum(lumen.partVolumes(positions)), moved.signedVolume(), 1e-12 * moved.signedVolume());
  for (const WallPiece& wall : lumen.walls)
  {
    const Eigen::Vector3i& whole = moved.triangles[static_cast<std::size_t>(wall.triangle)];
    const Eigen::Vector3d& a = moved.vertices[static_cast<std::size_t>(whole[0])];
    const Eigen::Vector3d normal = (moved.vertices[static_cast<std::size_t>(whole[1])] - a)
                                       .cross(moved.vertices[static_cast<std::size_t>(whole[2])] - a)
                                       .normalized();
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(normal.dot(positions[static_cast<std::size_t>(wall.corners[c])] - a), 0.0, 1e-12);
  }
  moved.triangles.pop_back();
  EXPECT_FALSE(lumen.fits(moved));
}

TEST(LumenCells, MixTheCellsOfOnePartByVolume)
{
  const DividedVessel& vessel = generatedVessel("natural");
  const LumenCells lumen = divideLumen(vessel.mesh, vessel.centreline, vessel.cells);
  EXPECT_LT(lumen.parts, vessel.cells.size());
  std::vector<double> concentrations;
  double mass = 0.0, drawn = 0.0;
  for (std::size_t k = 0; k < vessel.cells.size(); ++k)
  {
    concentrations.push_back(static_cast<double>((7 * k) % 11));
    mass += concentrations.back() * lumen.volumes[k];
  }
  const std::vector<double> parts = lumen.partConcentrations(concentrations);
  const std::vector<double> volumes = lumen.partVolumes(lumen.place(vessel.mesh.vertices));
  for (std::size_t p = 0; p < parts.size(); ++p)
    drawn += parts[p] * volumes[p];
  EXPECT_NEAR(drawn, mass, 1e-12 * mass);
}

TEST(DivideLumen, RefusesCellsOfAnotherVessel)
{
  const DividedVessel tube = bentTube();
  const auto error = [&](ContrastCells cells)
  { return inputErrorOf([&] { divideLumen(tube.mesh, tube.centreline, cells); }); };
  EXPECT_EQ(error(tube.cells), "");
  EXPECT_NE(error({}), "");
  EXPECT_NE(error({{1, 0.0, 0.01, -1}}), "");
  EXPECT_NE(error({{0, 0.01, 0.01, -1}}), "");
  EXPECT_NE(error({{0, 0.0, 0.02, -1}, {0, 0.01, 0.03, 0}}), "");
  EXPECT_NE(error({{0, 0.0, 0.02, -1}, {0, 0.02, 0.03, 1}}), "");
}

}  // namespace
}  // namespace endovascular_sim::contrast
