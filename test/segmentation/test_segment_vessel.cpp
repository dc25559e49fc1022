#include "segmentation/join_branches.h"
#include "segmentation/segment_vessel.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "segmentation/surface/lumen_surface.h"
#include "test/common/input_error_of.h"
#include "test/segmentation/accuracy.h"
#include "test/segmentation/tree_accuracy.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Number of seeds of noise and clicks: 1, or the environment variable SEGMENTATION_SEEDS. */
int seeds()
{
  const char* text = std::getenv("SEGMENTATION_SEEDS");
  return text != nullptr ? std::max(1, std::atoi(text)) : 1;
}

std::string errorOf(const Scan& scan, const ClickSet& clicks)
{
  return inputErrorOf([&] { segmentBranches(scan, clicks, edgeSettings(scan.modality(), scan.spacing()), 1); });
}

/** Proximal left anterior descending artery with its lesion, and its surroundings. */
image::Volume lesionScan(const Truth& truth)
{
  return heartScan(truth, {}, {0.015, -0.095, 0.155}, {0.080, -0.005, 0.225});
}

class SegmentationOfTheHeart : public ::testing::TestWithParam<const char*>
{
};

TEST_P(SegmentationOfTheHeart, IsWithinATenthOfAVoxel)
{
  const Truth truth;
  const std::string name = GetParam();
  for (int seed = 1; seed <= seeds(); ++seed)
  {
    phantom::PhantomSettings noise;
    noise.seed = static_cast<std::uint64_t>(seed);
    const Scan scan(heartScan(truth, noise));
    EdgeSettings settings = edgeSettings(scan.modality(), scan.spacing());
    const ClickSet clicks = clicksInto(truth, {name}, scan.volume().grid, noise.seed);
    const auto accuracy = [&]
    { return accuracyOf(truth, scan, segmentBranches(scan, clicks, settings, 0).branches[0]); };
    const Accuracy a = accuracy();
    std::printf(
        "%s, seed %d: Dice %.4f, mean %.3f, 95 %% %.3f, back %.3f mm, bias %+.3f %+.3f, rms %.3f %.3f mm, volume "
        "%.3f\n",
        name.c_str(), seed, a.dice, 1e3 * a.mean, 1e3 * a.p95, 1e3 * a.back, 1e3 * a.small.bias, 1e3 * a.medium.bias,
        1e3 * a.small.rms, 1e3 * a.medium.rms, a.volume_ratio);
    EXPECT_GE(a.dice, 0.97);
    EXPECT_LE(a.mean, 5e-5);
    EXPECT_LE(a.p95, 1.2e-4);
    EXPECT_LE(a.volume_ratio, 1.1);
    for (const DiameterErrors& errors : {a.small, a.medium})
    {
      EXPECT_LE(std::abs(errors.bias), 6e-5);
      EXPECT_LE(errors.rms, 1e-4);
      EXPECT_GT(errors.sections, 20);
    }
    if (name == "left_anterior_descending")
    {
      std::printf("  throat: error %+.3f mm, shift %.2f mm\n", 1e3 * a.throat_error, 1e3 * a.throat_shift);
      EXPECT_LE(std::abs(a.throat_error), 2e-4);
      EXPECT_LE(a.throat_shift, 1e-3);
    }
    for (const double factor : {0.8, 1.2})  // a point spread that is wrong
    {
      settings = edgeSettings(scan.modality(), scan.spacing());
      settings.point_spread *= factor;
      const Accuracy b = accuracy();
      std::printf("  point spread %+.0f %%: bias %+.3f %+.3f mm\n", 100.0 * (factor - 1.0), 1e3 * b.small.bias,
                  1e3 * b.medium.bias);
      EXPECT_LE(std::abs(b.small.bias), 8e-5);
      EXPECT_LE(std::abs(b.medium.bias), 8e-5);
    }
    settings = edgeSettings(scan.modality(), scan.spacing());
    settings.half_maximum = true;
    const Accuracy half = accuracy();
    std::printf("  half-maximum: Dice %.4f, bias %+.3f %+.3f mm\n", half.dice, 1e3 * half.small.bias,
                1e3 * half.medium.bias);
    EXPECT_LT(half.dice, a.dice);
  }
}

INSTANTIATE_TEST_SUITE_P(Branches, SegmentationOfTheHeart,
                         ::testing::Values("left_anterior_descending", "left_circumflex", "right_coronary"),
                         [](const auto& info) { return std::string(info.param); });

class SegmentationOfTheNaturalAnatomy : public ::testing::TestWithParam<const char*>
{
};

TEST_P(SegmentationOfTheNaturalAnatomy, MeetsTheBoundsOfThePlainOne)
{
  const Truth truth("natural");
  const std::string name = GetParam();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : truth.chain(name).points)
    box.extend(point);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.012);
  const Scan scan(heartScan(truth, {}, box.min() - margin, box.max() + margin));
  const ClickSet clicks = clicksInto(truth, {name}, scan.volume().grid, 1);
  const Accuracy a = accuracyOf(
      truth, scan, segmentBranches(scan, clicks, edgeSettings(scan.modality(), scan.spacing()), 0).branches[0]);
  std::printf("%s: Dice %.4f, mean %.3f, 95 %% %.3f mm, bias %+.3f %+.3f, rms %.3f %.3f mm, volume %.3f\n",
              name.c_str(), a.dice, 1e3 * a.mean, 1e3 * a.p95, 1e3 * a.small.bias, 1e3 * a.medium.bias,
              1e3 * a.small.rms, 1e3 * a.medium.rms, a.volume_ratio);
  EXPECT_GE(a.dice, 0.97);
  EXPECT_LE(a.mean, 5e-5);
  EXPECT_LE(a.p95, 1.2e-4);
  EXPECT_LE(a.volume_ratio, 1.1);
  for (const DiameterErrors& errors : {a.small, a.medium})
  {
    EXPECT_LE(std::abs(errors.bias), 6e-5);
    EXPECT_LE(errors.rms, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Branches, SegmentationOfTheNaturalAnatomy,
                         ::testing::Values("left_anterior_descending", "left_circumflex", "right_coronary"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Segmentation, OfATreeIsCloseToTheExactSurfaceAlsoAtOstiaBifurcationsAndInTheAorta)
{
  const Truth truth;
  for (int seed = 1; seed <= seeds(); ++seed)
  {
    phantom::PhantomSettings noise;
    noise.seed = static_cast<std::uint64_t>(seed);
    const Scan scan(heartScan(truth, noise));
    const EdgeSettings settings = edgeSettings(scan.modality(), scan.spacing());
    ClickSet clicks = clicksInto(
        truth, {"ascending_aorta", "left_main", "left_anterior_descending", "left_circumflex", "right_coronary"},
        scan.volume().grid, noise.seed);
    // The last simulated click lies beside the left coronary ostium; the aorta continues up to its arch.
    const std::vector<Eigen::Vector3d>& aorta = truth.chain("ascending_aorta").points;
    clicks.branches[0].clicks[1].position =
        *std::find_if(aorta.begin(), aorta.end(), [](const Eigen::Vector3d& p) { return p.z() > 0.221; });
    Segmentation result = segmentBranches(scan, clicks, settings, 0);
    joinBranches(scan, clicks, settings, 0, result);
    SurfaceSettings surface;
    surface.spacing = 3e-4;
    const geometry::TriangleMesh mesh = lumenSurface(result.branches, surface);
    const TreeAccuracy accuracy = TreeComparison(truth, scan, result.branches, mesh).run();
    std::printf("tree, seed %d: aorta Dice %.4f\n", seed, accuracy.aorta_dice);
    EXPECT_GE(accuracy.aorta_dice, 0.98);
    for (const auto& [direction, regions] :
         {std::pair("to the truth", accuracy.there), std::pair("back", accuracy.back)})
      for (const auto& [region, d] : regions)
      {
        const bool is_junction = region.find('+') != std::string::npos;
        std::printf("  %-50s %-12s mean %.3f, 95 %% %.3f, largest %.2f mm, %zu points\n", region.c_str(), direction,
                    1e3 * d.mean, 1e3 * d.p95, 1e3 * d.largest, d.points);
        if (d.points < 100)
          continue;
        if (is_junction && region.find("aorta") == std::string::npos)  // bifurcations
        {
          // The saddle between two lumens is the worst place: a quarter of a voxel, depending on the noise.
          EXPECT_LE(d.mean, 1e-4) << region;
          EXPECT_LE(d.p95, 1.5e-4) << region;
        }
        else if (is_junction)  // ostia: funnels, which are wider than the longest ray of a narrow branch
        {
          EXPECT_LE(d.mean, 1.2e-3) << region;
        }
        else if (region == "ascending_aorta")
        {
          EXPECT_LE(d.mean, 1.5e-4) << region;
        }
      }
  }
}

TEST(Segmentation, HasTheSameBitsWithOneAndWithFourThreads)
{
  const Truth truth;
  const Scan scan(heartScan(truth, {}, {0.0, -0.095, 0.155}, {0.080, 0.02, 0.225}));
  const ClickSet clicks =
      clicksInto(truth, {"left_main", "left_anterior_descending", "left_circumflex"}, scan.volume().grid, 3);
  const EdgeSettings settings = edgeSettings(scan.modality(), scan.spacing());
  std::vector<Segmentation> results;
  for (const int threads : {1, 4})
  {
    results.push_back(segmentBranches(scan, clicks, settings, threads));
    joinBranches(scan, clicks, settings, threads, results.back());
  }
  for (std::size_t b = 0; b < 3; ++b)
  {
    ASSERT_EQ(results[0].branches[b].sections.size(), results[1].branches[b].sections.size());
    for (std::size_t k = 0; k < results[0].branches[b].sections.size(); ++k)
    {
      EXPECT_EQ(results[0].branches[b].sections[k].centre, results[1].branches[b].sections[k].centre);
      EXPECT_EQ(results[0].branches[b].sections[k].radii, results[1].branches[b].sections[k].radii);
    }
  }
}

TEST(Segmentation, NamesTheTissueOfAClickBesideTheLumenAndProposesTheNearestLumen)
{
  const Truth truth;
  const Scan scan(lesionScan(truth));
  ClickSet clicks = clicksInto(truth, {"left_anterior_descending"}, scan.volume().grid, 1);
  EXPECT_EQ(errorOf(scan, clicks), "");
  const Eigen::Vector3d good = clicks.branches[0].clicks[0].position;

  clicks.branches[0].clicks[0].position = good + Eigen::Vector3d(0.0, 0.0, 0.0045);
  std::string error = errorOf(scan, clicks);
  EXPECT_NE(error.find("left_anterior_descending, click 1"), std::string::npos) << error;
  EXPECT_NE(error.find("fat"), std::string::npos) << error;
  EXPECT_NE(error.find("nearest lumen is at ("), std::string::npos) << error;

  clicks.branches[0].clicks[0].position = good + Eigen::Vector3d(0.5, 0.0, 0.0);
  error = errorOf(scan, clicks);
  EXPECT_NE(error.find("outside of the image"), std::string::npos) << error;

  clicks.branches[0].clicks[0].position = Eigen::Vector3d(-good.x(), -good.y(), good.z());
  error = errorOf(scan, clicks);
  EXPECT_NE(error.find("as RAS it would lie inside"), std::string::npos) << error;
}

TEST(Segmentation, RefusesClicksInTwoVessels)
{
  const Truth truth;
  const Scan scan(lesionScan(truth));
  ClickSet clicks = clicksInto(truth, {"left_anterior_descending"}, scan.volume().grid, 1);
  // The left anterior descending artery and the pulmonary trunk.
  clicks.branches[0].clicks[1].position = Eigen::Vector3d(0.024, -0.026, 0.2025);
  const std::string error = errorOf(scan, clicks);
  EXPECT_NE(error.find("lie in two vessels"), std::string::npos) << error;
}

TEST(Segmentation, ReportsImagesWithoutContrast)
{
  const Truth truth;
  image::Volume volume = lesionScan(truth);
  for (std::int16_t& value : volume.stored)
    value = static_cast<std::int16_t>(std::min<int>(value, 60));
  const Scan scan(std::move(volume));
  const std::string error = errorOf(scan, clicksInto(truth, {"left_anterior_descending"}, scan.volume().grid, 1));
  EXPECT_NE(error.find("no click lies in contrast"), std::string::npos) << error;
}

TEST(Segmentation, DoesNotDependOnTheOrderAndTheSignsOfTheAxes)
{
  const Truth truth;
  const image::Volume volume = lesionScan(truth);
  const ClickSet clicks = clicksInto(truth, {"left_anterior_descending"}, volume.grid, 1);
  // Axes (k, −i, j) in place of (i, j, k).
  image::Volume turned = volume;
  turned.grid.size = {volume.grid.size.z(), volume.grid.size.x(), volume.grid.size.y()};
  turned.grid.axes.col(0) = volume.grid.axes.col(2);
  turned.grid.axes.col(1) = -volume.grid.axes.col(0);
  turned.grid.axes.col(2) = volume.grid.axes.col(1);
  turned.grid.origin = volume.grid.position(Eigen::Vector3d(volume.grid.size.x() - 1, 0, 0));
  for (int k = 0; k < volume.grid.size.z(); ++k)
    for (int j = 0; j < volume.grid.size.y(); ++j)
      for (int i = 0; i < volume.grid.size.x(); ++i)
        turned.stored[turned.grid.offset(k, volume.grid.size.x() - 1 - i, j)] =
            volume.stored[volume.grid.offset(i, j, k)];
  // The patient turned by 20 degrees about an oblique axis, with the clicks.
  const Eigen::AngleAxisd rotation(0.35, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());
  image::Volume oblique = volume;
  oblique.grid.axes = rotation * volume.grid.axes;
  oblique.grid.origin = rotation * volume.grid.origin;
  ClickSet turned_clicks = clicks;
  for (Click& click : turned_clicks.branches[0].clicks)
    click.position = rotation * click.position;

  const auto contour = [](const image::Volume& image, const ClickSet& set)
  {
    const Scan scan(image);
    const LumenBranch branch = segmentBranches(scan, set, edgeSettings(scan.modality(), scan.spacing()), 1).branches[0];
    std::vector<Eigen::Vector3d> points;
    for (const Section& section : branch.sections)
      for (int ray = 0; ray < kRays; ++ray)
        points.push_back(
            scan.toPatient(section.centre + section.radii[static_cast<std::size_t>(ray)] * section.direction(ray)));
    return points;
  };
  const std::vector<Eigen::Vector3d> a = contour(volume, clicks);
  const std::vector<Eigen::Vector3d> b = contour(turned, clicks);
  const std::vector<Eigen::Vector3d> c = contour(oblique, turned_clicks);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.size(), c.size());
  double flipped = 0.0;
  double rotated = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    flipped = std::max(flipped, (a[k] - b[k]).norm());
    rotated = std::max(rotated, (rotation * a[k] - c[k]).norm());
  }
  EXPECT_LT(flipped, 1e-6);
  EXPECT_LT(rotated, 2e-5);
}

// MR angiogram of an iliac artery in two branches, one behind the other.
TEST(Segmentation, JoinsABranchThatContinuesAnotherOneWithoutHandles)
{
  const Truth truth;
  phantom::PhantomSettings settings;
  settings.modality = image::Modality::kOther;
  settings.noise = 40.0;
  settings.point_spread = 6e-4;
  settings.grid = phantom::gridOfBox({-0.085, -0.045, -0.155}, {0.01, 0.04, 0.01}, {8.8e-4, 8.8e-4, 1.5e-3});
  const Scan scan(phantom::makePhantom(truth.anatomy, settings));
  const ClickSet clicks = clicksInto(truth, {"right_common_iliac", "right_external_iliac"}, scan.volume().grid, 1);
  const EdgeSettings edges = edgeSettings(scan.modality(), scan.spacing());
  Segmentation result = segmentBranches(scan, clicks, edges, 0);
  joinBranches(scan, clicks, edges, 0, result);
  SurfaceSettings surface;
  surface.spacing = 5e-4;
  int components = 0;
  EXPECT_EQ(genusOf(lumenSurface(result.branches, surface, &components)), 0);
  EXPECT_EQ(components, 1);
  EXPECT_NEAR(result.branches[1].sections.back().diameter(), 8e-3, 3e-4);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
