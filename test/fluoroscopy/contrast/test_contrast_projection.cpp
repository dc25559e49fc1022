#include "fluoroscopy/contrast/contrast_projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "contrast/lumen/divide_lumen.h"
#include "fluoroscopy/projection/covered_pixels.h"
#include "fluoroscopy/projection/signed_depth.h"
#include "test/contrast/lumen_fixtures.h"
#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

std::shared_ptr<const contrast::LumenCells> lumenOf(const contrast::DividedVessel& vessel)
{
  return std::make_shared<contrast::LumenCells>(contrast::divideLumen(vessel.mesh, vessel.centreline, vessel.cells));
}

std::shared_ptr<const contrast::LumenCells> naturalLumen()
{
  static const std::shared_ptr<const contrast::LumenCells> kLumen = lumenOf(contrast::generatedVessel("natural"));
  return kLumen;
}

constexpr double kSinglePrecision = 1e-6;

/** Concentrations that differ from cell to cell, zero in a third of them [kg/m³]. */
std::vector<double> unevenIn(const contrast::LumenCells& lumen)
{
  std::vector<double> result;
  for (std::size_t k = 0; k < lumen.part_of_cell.size(); ++k)
    result.push_back(k % 3 == 0 ? 0.0 : 50.0 + 200.0 * std::abs(std::sin(0.37 * static_cast<double>(k))));
  return result;
}

/** Areal densities of all pixels [kg/m²]. */
std::vector<double> dense(const IodineImage& image, int pixels)
{
  std::vector<double> result(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels), 0.0);
  for (std::size_t k = 0; k < image.pixels.size(); ++k)
    result[image.pixels[k]] = static_cast<double>(image.densities[k]);
  return result;
}

std::vector<double> projected(const std::shared_ptr<const contrast::LumenCells>& lumen,
                              const geometry::TriangleMesh& mesh, const XRayGeometry& geometry,
                              const motion::MotionMap& map, const std::vector<double>& concentrations)
{
  MovingVessel vessel;
  vessel.setMesh(mesh);
  vessel.project(geometry, map);
  ContrastProjection projection;
  projection.setLumen(lumen);
  IodineImage image;
  projection.project(geometry, map, vessel, concentrations, image);
  return dense(image, geometry.pixels());
}

/** Map whose heart is far from the vessel: it moves nothing, and does not rest. */
motion::MotionMap distantMap()
{
  motion::HeartFrame frame = motion::naturalHeart();
  frame.base += Eigen::Vector3d(5.0, 0.0, 0.0);
  frame.fade.centre += Eigen::Vector3d(5.0, 0.0, 0.0);
  return motion::mapAt(0.3, 0.4, frame, motion::adultMotion());
}

struct Difference
{
  double relative_rms = 0.0, largest = 0.0;
};

Difference differenceOf(const std::vector<double>& found, const std::vector<double>& wanted)
{
  double squares = 0.0, norm = 0.0;
  Difference result;
  for (std::size_t k = 0; k < wanted.size(); ++k)
  {
    const double difference = std::abs(found[k] - wanted[k]);
    squares += difference * difference;
    norm += wanted[k] * wanted[k];
    result.largest = std::max(result.largest, difference);
  }
  result.relative_rms = std::sqrt(squares / norm);
  return result;
}

void expectPlainLengths(const std::shared_ptr<const contrast::LumenCells>& lumen, const geometry::TriangleMesh& mesh,
                        const XRayGeometry& geometry, const motion::MotionMap& map)
{
  const std::vector<double> even(lumen->part_of_cell.size(), 100.0);
  std::vector<double> wanted;
  MovingVessel plain;
  plain.setMesh(mesh);
  plain.project(geometry, map);
  for (const double length : plain.lengths())
    wanted.push_back(100.0 * length);
  const Difference difference = differenceOf(projected(lumen, mesh, geometry, map, even), wanted);
  EXPECT_LT(difference.relative_rms, 1e-6);
  EXPECT_LT(difference.largest, 100.0 * 1e-6);  // grazing rays
}

TEST(ContrastProjection, OfAnEvenConcentrationHasThePlainPathLengths)
{
  for (const double angle : {0.0, -0.52, 0.8, 1.57})
    for (const motion::MotionMap& map : {motion::mapAt(0.0, 0.0), motion::mapAt(0.3, 0.4), distantMap()})
      expectPlainLengths(naturalLumen(), contrast::generatedVessel("natural").mesh,
                         XRayGeometry(heartView(angle, 0.3, 512)), map);
}

TEST(ContrastProjection, OfAnEvenConcentrationInASegmentedVesselHasThePlainPathLengths)
{
  const contrast::DividedVessel* vessel = contrast::segmentedVessel("aortic_arch_tree.obj");
  if (vessel == nullptr)
    GTEST_SKIP() << "ENDOVASCULAR_DATA_DIR is not set to the folder of the segmented vessels";
  CArmPose pose;
  pose.isocentre = vessel->centreline.branches.front().points[vessel->centreline.branches.front().points.size() / 2];
  expectPlainLengths(lumenOf(*vessel), vessel->mesh, XRayGeometry(pose), motion::mapAt(0.0, 0.0));
}

TEST(ContrastProjection, AtRestAgreesWithTheSweepOfAMovingVessel)
{
  const std::vector<double> uneven = unevenIn(*naturalLumen());
  const geometry::TriangleMesh& mesh = contrast::generatedVessel("natural").mesh;
  for (const double angle : {0.0, -0.52, 1.2})
  {
    const XRayGeometry geometry(heartView(angle, -0.35, 512));
    const std::vector<double> at_rest = projected(naturalLumen(), mesh, geometry, motion::mapAt(0.0, 0.0), uneven);
    const std::vector<double> swept = projected(naturalLumen(), mesh, geometry, distantMap(), uneven);
    const Difference difference = differenceOf(swept, at_rest);
    EXPECT_LT(difference.relative_rms, 1e-6);
    EXPECT_LT(difference.largest, 3e-6);
  }
}

/** Iodine from the signed path lengths in each part's closed surface. */
std::vector<double> bruteForce(const contrast::LumenCells& lumen, const std::vector<Eigen::Vector3d>& positions,
                               const std::vector<double>& concentrations, const XRayGeometry& geometry)
{
  const std::vector<double> parts = lumen.partConcentrations(concentrations);
  std::vector<geometry::TriangleMesh> surfaces(lumen.parts);
  const auto add = [&](int part, const Eigen::Vector3i& corners)
  {
    geometry::TriangleMesh& surface = surfaces[static_cast<std::size_t>(part)];
    const int first = static_cast<int>(surface.vertices.size());
    for (int c = 0; c < 3; ++c)
      surface.vertices.push_back(positions[static_cast<std::size_t>(corners[c])]);
    surface.triangles.emplace_back(first, first + 1, first + 2);
  };
  for (const contrast::WallPiece& wall : lumen.walls)
    add(wall.part, wall.corners);
  for (const contrast::LumenCap& cap : lumen.caps)
  {
    add(cap.plus, cap.corners);
    add(cap.minus, {cap.corners[0], cap.corners[2], cap.corners[1]});
  }
  const auto side = static_cast<std::size_t>(geometry.pixels());
  std::vector<double> result(side * side, 0.0);
  for (std::size_t p = 0; p < surfaces.size(); ++p)
  {
    if (parts[p] == 0.0)
      continue;
    std::vector<double> depths(side * side, 0.0);
    std::vector<Corner> corners;
    for (const Eigen::Vector3d& vertex : surfaces[p].vertices)
      corners.push_back(projectCorner(geometry, vertex));
    for (const Eigen::Vector3i& t : surfaces[p].triangles)
      addTriangle(corners[static_cast<std::size_t>(t[0])], corners[static_cast<std::size_t>(t[1])],
                  corners[static_cast<std::size_t>(t[2])], geometry.pose().source_to_detector, geometry.pixels(),
                  depths);
    for (std::size_t k = 0; k < depths.size(); ++k)
      result[k] +=
          parts[p] * depths[k] * geometry.ray(static_cast<double>(k % side), static_cast<double>(k / side)).norm();
  }
  return result;
}

/** Largest change of a triangle's inverse depth at a pixel when its vertices move by ½ · 1/4096 pixel along both axes,
 *  twice: once as corners of the triangle, once as those of a piece of it [1/m]. It does not exceed the range of the
 *  inverse depths, which limits the steep triangles that are seen edge-on. */
double roundingOf(const XRayGeometry& geometry, const std::array<Eigen::Vector3d, 3>& triangle)
{
  std::array<Eigen::Vector3d, 3> seen;  // column, row [pixel], inverse depth
  for (std::size_t k = 0; k < 3; ++k)
    seen[k] << geometry.project(triangle[k]), 1.0 / geometry.toOptical(triangle[k]).z();
  const Eigen::Vector3d b = seen[1] - seen[0], c = seen[2] - seen[0];
  const double area = b.x() * c.y() - b.y() * c.x();
  const double along_columns = (b.z() * c.y() - c.z() * b.y()) / area;
  const double along_rows = (c.z() * b.x() - b.z() * c.x()) / area;
  const double range =
      std::max({seen[0].z(), seen[1].z(), seen[2].z()}) - std::min({seen[0].z(), seen[1].z(), seen[2].z()});
  const double rounding = (std::abs(along_columns) + std::abs(along_rows)) / static_cast<double>(kSubpixels);
  return rounding < range ? rounding : range;  // also for an area of zero
}

/** Largest difference, in each pixel, between depths of pieces and those of the whole triangles [kg/m²]. */
std::vector<double> roundingBounds(const contrast::LumenCells& lumen, const std::vector<Eigen::Vector3d>& positions,
                                   const std::vector<double>& concentrations, const XRayGeometry& geometry)
{
  constexpr double kSecondOrder = 1.01;  // of the depth in the inverse depth, over a triangle
  const auto at = [&positions](int vertex) { return positions[static_cast<std::size_t>(vertex)]; };
  const std::vector<double> parts = lumen.partConcentrations(concentrations);
  const auto side = static_cast<std::size_t>(geometry.pixels());
  std::vector<double> result(side * side, 0.0);
  for (const contrast::WallPiece& piece : lumen.walls)
  {
    const Eigen::Vector3i &own = piece.corners, &whole = lumen.triangles[static_cast<std::size_t>(piece.triangle)];
    const double concentration = parts[static_cast<std::size_t>(piece.part)];
    if (own == whole || concentration == 0.0)
      continue;
    const double bound = roundingOf(geometry, {at(whole[0]), at(whole[1]), at(whole[2])});
    coveredPixels(projectCorner(geometry, at(own[0])), projectCorner(geometry, at(own[1])),
                  projectCorner(geometry, at(own[2])), geometry.pixels(),
                  [&](int row, int column, double inverse_depth, double)
                  {
                    result[static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column)] +=
                        kSecondOrder * concentration * geometry.ray(column, row).norm() * bound /
                        (inverse_depth * inverse_depth);
                  });
  }
  return result;
}

TEST(ContrastProjection, OfAMovedVesselIsThatOfTheSurfacesOfItsMovedParts)
{
  const std::vector<double> uneven = unevenIn(*naturalLumen());
  const geometry::TriangleMesh& mesh = contrast::generatedVessel("natural").mesh;
  const XRayGeometry geometry(heartView(-0.52, -0.35, 128));
  const std::vector<double> rest = projected(naturalLumen(), mesh, geometry, motion::mapAt(0.0, 0.0), uneven);
  for (const double phase : {0.0, 0.15, 0.35})
  {
    const motion::MotionMap map = motion::mapAt(phase, phase);
    std::vector<Eigen::Vector3d> moved;
    map.positions(mesh.vertices, moved);
    const std::vector<Eigen::Vector3d> positions = naturalLumen()->place(moved);
    const std::vector<double> wanted = bruteForce(*naturalLumen(), positions, uneven, geometry);
    const std::vector<double> found = projected(naturalLumen(), mesh, geometry, map, uneven);
    const Difference difference = differenceOf(found, wanted);
    EXPECT_LT(difference.relative_rms, 2e-5) << phase;  // vertices of cut triangles are rounded to 1/4096 pixel
    const std::vector<double> bounds = roundingBounds(*naturalLumen(), positions, uneven, geometry);
    for (std::size_t k = 0; k < bounds.size(); ++k)  // a moved cap may fold over: a negative sum is left out
      ASSERT_LE(std::abs(found[k] - std::max(wanted[k], 0.0)),
                bounds[k] + kSinglePrecision * std::abs(wanted[k]) + IodineImage::kLeast)
          << phase << ", pixel " << k;
    EXPECT_LT(*std::max_element(bounds.begin(), bounds.end()), 0.05) << "of up to 10 kg/m²";
    if (phase > 0.0)
    {
      EXPECT_GT(differenceOf(found, rest).relative_rms, 0.05);
    }
  }
}

TEST(ContrastProjection, HasTheSameBitsWhateverWasProjectedBefore)
{
  const geometry::TriangleMesh& mesh = contrast::generatedVessel("natural").mesh;
  const std::vector<double> uneven = unevenIn(*naturalLumen());
  std::vector<double> first_half = uneven;
  std::fill(first_half.begin() + static_cast<std::ptrdiff_t>(first_half.size() / 2), first_half.end(), 0.0);
  MovingVessel vessel;
  vessel.setMesh(mesh);
  ContrastProjection projection;
  projection.setLumen(naturalLumen());
  IodineImage image;
  for (const double angle : {-0.52, 0.3})
    for (const double phase : {0.15, 0.0, 0.35})
      for (const std::vector<double>& concentrations : {uneven, first_half})
      {
        const XRayGeometry geometry(heartView(angle, -0.35, 128));
        const motion::MotionMap map = motion::mapAt(phase, phase);
        if (phase == 0.15)
          projection.reset();
        vessel.project(geometry, map);
        projection.project(geometry, map, vessel, concentrations, image);
        EXPECT_EQ(dense(image, 128), projected(naturalLumen(), mesh, geometry, map, concentrations))
            << angle << ", " << phase;
      }
}

TEST(ContrastProjection, LeavesOutWhatHasNoIodine)
{
  const contrast::LumenCells& lumen = *naturalLumen();
  std::vector<double> none(lumen.part_of_cell.size(), 0.0);
  const geometry::TriangleMesh& mesh = contrast::generatedVessel("natural").mesh;
  const XRayGeometry geometry(heartView(0.0, 0.0, 64));
  for (const motion::MotionMap& map : {motion::mapAt(0.0, 0.0), motion::mapAt(0.3, 0.4)})
    for (const double density : projected(naturalLumen(), mesh, geometry, map, none))
      ASSERT_EQ(density, 0.0);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
