#include "segmentation/mesh/label_vessel.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "geometry/mesh_distance.h"
#include "geometry/surface_samples.h"
#include "segmentation/lumen_centreline.h"
#include "test/common/input_error_of.h"
#include "test/segmentation/label_maps.h"
#include "vessel/centreline/lumen_section.h"
#include "vessel/repair/hole_closing.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kVoxel = 1e-3;  // m

/** Tubes on a grid. */
struct Case
{
  const char* name;
  std::vector<ExactTube> tubes;
  Eigen::Vector3d spacing;
  int ends;
  bool is_typical = true;  // else the grid itself gives another volume: every layer samples the same circle
};

std::vector<Case> cases()
{
  const Eigen::Vector3d isotropic = Eigen::Vector3d::Constant(kVoxel);
  const Eigen::Vector3d tall(kVoxel, kVoxel, 2.0 * kVoxel);
  const Eigen::Vector3d a(0.0301, 0.0297, -0.02);
  const Eigen::Vector3d b(0.0301, 0.0297, 0.08);
  const Eigen::Vector3d c(0.0098, 0.0124, -0.02);
  const Eigen::Vector3d d(0.0502, 0.0433, 0.08);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d up = Eigen::Vector3d(0.0, 0.3, 1.0).normalized();
  const std::vector<Eigen::Vector3d> bow = arc({0.0305, 0.0257, 0.0}, 0.021, x, up, -0.6, M_PI + 0.6);
  const Eigen::Vector3d fork(0.0301, 0.0297, 0.03);
  const std::vector<ExactTube> y = {{{a, fork}, 0.006},
                                    {{fork, fork + 0.06 * Eigen::Vector3d(0.35, 0.1, 1.0)}, 0.0045},
                                    {{fork, fork + 0.06 * Eigen::Vector3d(-0.45, 0.05, 1.0)}, 0.004}};
  return {{"straight_4", {{{a, b}, 0.002}}, isotropic, 2, false},
          {"straight_10", {{{a, b}, 0.005}}, isotropic, 2},
          {"straight_20", {{{a, b}, 0.01}}, isotropic, 2},
          {"oblique_4", {{{c, d}, 0.002}}, isotropic, 2},
          {"oblique_6", {{{c, d}, 0.003}}, isotropic, 2},
          {"oblique_20", {{{c, d}, 0.01}}, isotropic, 2},
          {"bent_4", {{bow, 0.002}}, isotropic, 2},
          {"bent_12", {{bow, 0.006}}, isotropic, 2},
          {"y", y, isotropic, 3},
          {"straight_4_tall", {{{a, b}, 0.002}}, tall, 2, false},
          {"oblique_4_tall", {{{c, d}, 0.002}}, tall, 2},
          {"oblique_8_tall", {{{c, d}, 0.004}}, tall, 2},
          {"bent_8_tall", {{bow, 0.004}}, tall, 2},
          {"y_tall", y, tall, 3}};
}

Scan scanOf(const std::vector<ExactTube>& tubes, const Eigen::Vector3d& spacing)
{
  const Eigen::Vector3i size = Eigen::Vector3d::Constant(0.06).cwiseQuotient(spacing).array().round().cast<int>();
  return Scan(labelMapOf(tubes, size, spacing, Eigen::Vector3d::Zero()));
}

LabelSettings settingsOf(std::size_t labels)
{
  LabelSettings settings;
  for (std::size_t k = 0; k < labels; ++k)
    settings.names.push_back("tube_" + std::to_string(k + 1));
  return settings;
}

/** Volume of tubes within a grid, from its faces, by samples of a third of a voxel [m³]. */
double volumeOf(const std::vector<ExactTube>& tubes, const Scan& scan)
{
  constexpr int kFiner = 3;
  std::size_t inside = 0;
  const Eigen::Vector3i n = kFiner * scan.size();
  const Eigen::Vector3d step = scan.spacing() / kFiner;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i)
        inside +=
            distanceTo(tubes, Eigen::Vector3d(i, j, k).cwiseProduct(step) + 0.5 * step - 0.5 * scan.spacing()) < 0.0
                ? 1U
                : 0U;
  return static_cast<double>(inside) * step.prod();
}

class LabelVesselOfTubes : public ::testing::TestWithParam<Case>
{
};

TEST_P(LabelVesselOfTubes, IsWithinHalfAVoxelAndWithoutBias)
{
  const Case& shape = GetParam();
  const Scan scan = scanOf(shape.tubes, shape.spacing);
  const LabelVessel vessel = labelVessel(scan, settingsOf(shape.tubes.size()), "mask");
  EXPECT_EQ(vessel.genus, 0);
  EXPECT_EQ(vessel.openings.size(), static_cast<std::size_t>(shape.ends));
  const vessel::ClosedMesh closed = vessel::closeHoles(vessel.mesh);
  EXPECT_EQ(closed.holes.size(), static_cast<std::size_t>(shape.ends));
  EXPECT_TRUE(vessel::checkMesh(closed.mesh).clean());

  double area = 0.0;
  double near = 0.0;
  for (const geometry::SurfaceSample& sample : geometry::sampleSurface(vessel.mesh, 0.5 * kVoxel))
  {
    area += sample.area;
    near += std::abs(distanceTo(shape.tubes, sample.point)) <= 0.5 * kVoxel ? sample.area : 0.0;
  }
  const geometry::MeshDistance wall(vessel.closed);
  double bias = 0.0;
  int sections = 0;
  for (const vessel::CentrelineBranch& branch : vessel.centreline.branches)
    for (std::size_t k = 2; k + 2 < branch.points.size(); ++k)
    {
      // Only one tube is near, and no end.
      const Eigen::Vector3d& p = branch.points[k];
      int beside = 0;
      double radius = 0.0;
      for (const ExactTube& tube : shape.tubes)
        if (tube.at(p) < tube.radius)
        {
          ++beside;
          radius = tube.radius;
        }
      if (beside != 1)
        continue;
      const Eigen::Vector3d along = (branch.points[k + 1] - branch.points[k - 1]).normalized();
      bias += vessel::lumenDiameter(wall, p, along) - 2.0 * radius;
      ++sections;
    }
  bias /= std::max(1, sections);
  const double volume = closed.mesh.signedVolume();
  const double exact = volumeOf(shape.tubes, scan);
  std::printf(
      "%s: %.1f %% within half a voxel, diameter %+.3f voxels (%d sections), volume %+.2f %% of the mask, %+.2f %%\n",
      shape.name, 100.0 * near / area, bias / kVoxel, sections, 100.0 * (volume / vessel.mask_volume - 1.0),
      100.0 * (volume / exact - 1.0));
  EXPECT_GE(near / area, 0.95);
  EXPECT_GT(sections, 5);
  EXPECT_LE(std::abs(bias), 0.25 * kVoxel);
  EXPECT_NEAR(volume / vessel.mask_volume, 1.0, 0.02);
  if (shape.is_typical)
  {
    EXPECT_NEAR(volume / exact, 1.0, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, LabelVesselOfTubes, ::testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

const ExactTube kShort{{{0.03, 0.029, 0.014}, {0.031, 0.03, 0.046}}, 0.004};
const ExactTube kLong{{{0.03, 0.029, -0.01}, {0.031, 0.03, 0.07}}, 0.004};

TEST(LabelVessel, OfADamagedMaskIsThatOfTheGoodOne)
{
  image::Volume map = labelMapOf({kShort}, {60, 60, 60}, Eigen::Vector3d::Constant(kVoxel), Eigen::Vector3d::Zero());
  const ExactTube hole{{{0.0, 0.03, 0.03}, {0.06, 0.029, 0.03}}, 0.0011};
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i)
        if (hole.at(kVoxel * Eigen::Vector3d(i, j, k)) < 0.0)
          map.stored[map.grid.offset(i, j, k)] = 0;
  map.stored[map.grid.offset(30, 29, 20)] = 0;
  map.stored[map.grid.offset(50, 50, 50)] = 1;
  const LabelVessel vessel = labelVessel(Scan(map), settingsOf(1), "mask");
  EXPECT_EQ(vessel.genus, 0);
  EXPECT_EQ(vessel.changes.islands.size(), 1U);
  EXPECT_EQ(vessel.changes.cavities, 1U);
  EXPECT_EQ(vessel.changes.tunnels.size(), 1U);
  EXPECT_EQ(vessel.centreline.branches.size(), 1U);
  for (const Eigen::Vector3d& p : vessel.closed.vertices)
    EXPECT_LE(std::abs(kShort.at(p)), kVoxel);
}

TEST(LabelVessel, IsTheSameForTurnedAndFlippedAxes)
{
  const LabelVessel straight = labelVessel(scanOf({kLong}, Eigen::Vector3d::Constant(kVoxel)), settingsOf(1), "mask");
  image::Volume turned = labelMapOf({kLong}, {60, 60, 60}, Eigen::Vector3d::Constant(kVoxel), Eigen::Vector3d::Zero());
  const image::Volume map = turned;
  turned.grid.axes << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  turned.grid.origin = {0.059, 0.059, 0.0};
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i)
        turned.stored[turned.grid.offset(i, j, k)] = map.stored[map.grid.offset(59 - k, 59 - i, j)];
  const LabelVessel other = labelVessel(Scan(turned), settingsOf(1), "mask");
  EXPECT_EQ(other.mesh.hash(), straight.mesh.hash());
}

TEST(LabelVessel, IsOpenWhereClicksAndOptionsSay)
{
  const Scan inner = scanOf({kShort}, Eigen::Vector3d::Constant(kVoxel));
  const Scan across = scanOf({kLong}, Eigen::Vector3d::Constant(kVoxel));
  const auto open = [](const Scan& scan, const LabelSettings& settings)
  { return labelVessel(scan, settings, "mask").openings.size(); };
  LabelSettings settings = settingsOf(1);
  EXPECT_EQ(open(inner, settings), 2U);  // none lies at the border
  EXPECT_EQ(open(across, settings), 2U);
  settings.clicks = {{0.031, 0.03, 0.046}};
  EXPECT_EQ(open(inner, settings), 1U);
  settings.clicks = {{0.5, 0.5, 0.5}};
  EXPECT_NE(inputErrorOf([&] { open(inner, settings); }).find("no click lies near an end"), std::string::npos);
  settings.clicks.clear();
  settings.open = {"0.03,0.029,0.014"};
  EXPECT_EQ(open(inner, settings), 1U);
  settings.open.clear();
  settings.closed = {"largest"};
  EXPECT_EQ(open(across, settings), 1U);
}

TEST(LabelVessel, HasABranchPerLabel)
{
  const Eigen::Vector3d fork(0.0301, 0.0297, 0.03);
  const std::vector<ExactTube> tubes = {{{{0.0301, 0.0297, -0.01}, {0.0301, 0.0297, 0.07}}, 0.006},
                                        {{fork, fork + Eigen::Vector3d(0.04, 0.003, 0.008)}, 0.003}};
  const LabelVessel vessel = labelVessel(scanOf(tubes, Eigen::Vector3d::Constant(kVoxel)), settingsOf(2), "mask");
  ASSERT_EQ(vessel.centreline.branches.size(), 2U);
  EXPECT_EQ(vessel.centreline.branches[0].name, "tube_1");
  EXPECT_EQ(vessel.centreline.branches[1].name, "tube_2");
  EXPECT_EQ(vessel.openings.size(), 3U);
  EXPECT_NEAR(vessel.centreline.branches[0].points.front().z() + vessel.centreline.branches[0].points.back().z(), 0.059,
              1e-4);
}

TEST(LabelVessel, IsRefusedIfItFallsIntoPieces)
{
  std::vector<ExactTube> tubes;
  for (const double x : {0.008, 0.022, 0.036, 0.05})
    tubes.push_back({{{x, 0.03, 0.01}, {x, 0.03, 0.05}}, 0.003});
  const Scan scan = scanOf(tubes, Eigen::Vector3d::Constant(kVoxel));
  EXPECT_NE(inputErrorOf([&] { labelVessel(scan, settingsOf(4), "mask"); }).find("too narrow for the voxels"),
            std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
