#include "segmentation/lumen/wall_crossing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "test/segmentation/lumen_scan.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr LumenRange kRange{330.0, 340.0, 60.0};

/** Crossing of a straight path between two points [mm]. */
std::optional<WallCrossing> crossingBetween(const Scan& scan, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  std::vector<Eigen::Vector3d> path;
  const int steps = static_cast<int>((to - from).norm() / 0.4);
  for (int k = 0; k <= steps; ++k)
    path.push_back(scan.toGrid(1e-3 * (from + (to - from) * k / steps)));
  return wallCrossing(scan, path, kRange);
}

TEST(WallCrossing, IsFoundBetweenTwoLumensThatPassByEachOther)
{
  for (const double gap : {0.6, 0.8, 1.2})
  {
    const double apart = 3.4 + gap;
    const Scan scan(
        scanOfLumens({-6, -6, -20}, {6 + apart, 6, 20}, 0.5,
                     {tubeAlong({{0, 0, -24}, {0, 0, 24}}, 1.7), tubeAlong({{apart, 0, -24}, {apart, 0, 24}}, 1.7)}));
    const std::optional<WallCrossing> crossing = crossingBetween(scan, {0, 0, -1}, {apart, 0, 1});
    ASSERT_TRUE(crossing) << gap;
    EXPECT_NEAR(1e3 * scan.toPatient(crossing->location).x(), 0.5 * apart, 0.5);
    EXPECT_FALSE(crossingBetween(scan, {0.5, 0.3, -18}, {0, -0.5, 18})) << gap;
  }
}

TEST(WallCrossing, IsNoStenosisAndNoPathThatCutsABend)
{
  const Lumen stenosis = tubeAlong({{0, 0, -24}, {0, 0, 24}},
                                   [](double s) { return 1.7 - 1.2 * std::exp(-std::pow((s - 0.5) * 48.0 / 2.0, 2)); });
  EXPECT_FALSE(
      crossingBetween(Scan(scanOfLumens({-6, -6, -20}, {6, 6, 20}, 0.5, {stenosis})), {0, 0, -18}, {0, 0, 18}));
  std::vector<Eigen::Vector3d> bend;
  for (int k = 0; k <= 40; ++k)
    bend.emplace_back(10.0 * std::cos(M_PI * k / 40), 0.0, 10.0 * std::sin(M_PI * k / 40));
  const Scan bent(scanOfLumens({-15, -6, -3}, {15, 6, 16}, 0.5, {tubeAlong(bend, 2.5)}));
  EXPECT_FALSE(crossingBetween(bent, {5.0, 0, 7.2}, {-5.0, 0, 7.2}));  // 0.3 mm outside of the lumen in the middle
}

}  // namespace
}  // namespace endovascular_sim::segmentation
