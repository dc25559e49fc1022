#include "flow/body/lesion_lumen.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "flow/body/vessel_flow_tree.h"
#include "geometry/mesh_distance.h"
#include "geometry/polyline.h"
#include "vessel/anatomy/tube.h"
#include "vessel/centreline/lumen_section.h"
#include "vessel/lesion/add_lesions.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kRadius = 1.5e-3;  // [m]

vessel::Vessel tube(const std::vector<vessel::TubePiece>& pieces = {{0.06, 0.0, 0.3}})
{
  vessel::TubeShape shape;
  shape.radius = kRadius;
  shape.facets_around = 48;
  shape.facet_length = kRadius;
  shape.pieces = pieces;
  vessel::Vessel vessel;
  vessel.source = "tube";
  vessel.mesh = vessel::tubeMesh(shape);
  vessel.centreline = vessel::tubeCentreline(shape);
  return vessel;
}

vessel::Lesion lesion(double grade)
{
  vessel::Lesion lesion;
  lesion.branch = "tube";
  lesion.from_start = 0.03;
  lesion.length = 0.01;
  lesion.grade = grade;
  return lesion;
}

TEST(LesionLumen, HasTheAreaOfTheGradeAtTheThroatAndTheHealthyOneAtItsEnds)
{
  for (const double grade : {0.5, 0.7})
  {
    vessel::Vessel narrowed = tube();
    vessel::addLesions(narrowed, {lesion(grade)}, "test");
    LesionLumens measured(narrowed.mesh, narrowed.centreline, narrowed.lesions);
    const std::vector<LumenProfile>& lumens = measured.measure(narrowed.mesh.vertices);
    ASSERT_EQ(lumens.size(), 1U);
    const double healthy = M_PI * kRadius * kRadius;
    const double throat = *std::min_element(lumens[0].areas.begin(), lumens[0].areas.end());
    EXPECT_NEAR(std::sqrt(throat / healthy), 1.0 - grade, 0.02);
    EXPECT_NEAR(lumens[0].areas.front() / healthy, 1.0, 0.02);
    EXPECT_NEAR(lumens[0].areaAt(0.03, healthy), throat, 0.05 * throat);
    EXPECT_EQ(lumens[0].areaAt(0.01, healthy), healthy);
  }
}

/** Wall whose points within a lesion have at least a distance from the centreline. */
geometry::TriangleMesh opened(const vessel::Vessel& vessel, std::size_t lesion, double radius)
{
  geometry::TriangleMesh wall = vessel.mesh;
  const vessel::PlacedLesion& placed = vessel.lesions[lesion];
  const geometry::Polyline axis(vessel.centreline.branches[0].points);
  for (Eigen::Vector3d& point : wall.vertices)
  {
    const geometry::Polyline::Foot foot = axis.nearest(point);
    if (foot.arc > placed.begin - 1e-3 && foot.arc < placed.end + 1e-3 && foot.distance < radius)
      point = foot.point + radius / foot.distance * (point - foot.point);
  }
  return wall;
}

TEST(LesionLumen, OfAnOpenedWallIsThatOfTheBalloon)
{
  vessel::Vessel narrowed = tube();
  vessel::addLesions(narrowed, {lesion(0.6)}, "test");
  LesionLumens lumens(narrowed.mesh, narrowed.centreline, narrowed.lesions);
  for (const double size : {1.0, 1.2})
    for (const double area : lumens.measure(opened(narrowed, 0, size * kRadius).vertices)[0].areas)
      EXPECT_NEAR(area, M_PI * std::pow(size * kRadius, 2), 0.02 * area) << size;
}

TEST(LesionLumen, IsThatOfTheWholeWallWhileABalloonOpensIt)
{
  vessel::Vessel narrowed = tube({{0.02, 0.0, 0.3}, {0.03, 25.0, 0.9}, {0.02, 0.0, 0.3}});
  vessel::Lesion eccentric = lesion(0.8), second = lesion(0.5);
  eccentric.eccentricity = 0.7;
  second.from_start = 0.05;
  vessel::addLesions(narrowed, {eccentric, second}, "test");
  LesionLumens lumens(narrowed.mesh, narrowed.centreline, narrowed.lesions);
  for (const double radius : {0.0, 0.4, 0.9, 1.3, 1.9})
  {
    const geometry::TriangleMesh wall = opened(narrowed, 0, radius * kRadius);
    const std::vector<LumenProfile>& found = lumens.measure(wall.vertices);
    const geometry::MeshDistance whole(wall);
    const geometry::Polyline axis(narrowed.centreline.branches[0].points, 1e-3);
    ASSERT_EQ(found.size(), 2U);
    for (const LumenProfile& lumen : found)
      for (std::size_t k = 0; k < lumen.arcs.size(); ++k)
      {
        const geometry::Polyline::Foot foot = axis.normalPlaneFoot(axis.at(lumen.arcs[k]));
        const double diameter = vessel::lumenDiameter(whole, foot.point, foot.tangent);
        EXPECT_NEAR(lumen.areas[k] / (0.25 * M_PI * diameter * diameter), 1.0, 1e-9) << radius << ", " << k;
      }
  }
}

TEST(LesionLumen, LeavesTheRadiiOfTheHealthyVesselToTheNetwork)
{
  vessel::Vessel narrowed = tube();
  vessel::addLesions(narrowed, {lesion(0.7)}, "test");
  EXPECT_LT(
      *std::min_element(narrowed.centreline.branches[0].radii.begin(), narrowed.centreline.branches[0].radii.end()),
      0.5 * kRadius);
  const vessel::CentrelineTree healthy = withoutLesions(narrowed.centreline, narrowed.lesions);
  for (const double radius : healthy.branches[0].radii)
    EXPECT_NEAR(radius, kRadius, 0.02 * kRadius);
}

}  // namespace
}  // namespace endovascular_sim::flow
