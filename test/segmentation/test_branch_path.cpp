#include "segmentation/branch_path.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "segmentation/segment_vessel.h"
#include "test/common/input_error_of.h"
#include "test/segmentation/lumen_scan.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Points = std::vector<Eigen::Vector3d>;

/** Length of a lumen's centreline [mm]. */
double lengthOf(const LumenBranch& branch)
{
  return 1e3 * branch.arc().back();
}

Segmentation segmented(const Scan& scan, const Points& clicks)
{
  return segmentBranches(scan, clicksInto({{"vessel", clicks}}), edgeSettings(scan.modality(), scan.spacing()), 1);
}

std::string errorOf(const Scan& scan, const Points& clicks)
{
  return inputErrorOf([&] { segmented(scan, clicks); });
}

// Ascending aorta of 31 mm along z that becomes a true lumen of 7 × 12 mm. A vessel of 8 mm leads from one to the other
// by a loop of 270 mm.

/** Distance from the wall of the aorta with its true lumen. */
double fromDissectedAorta(const Eigen::Vector3d& p)
{
  const auto level = [](const Eigen::Vector3d& q)
  {
    const double t = std::clamp((q.z() - 50.0) / 50.0, 0.0, 1.0);
    const double s = t * t * (3.0 - 2.0 * t);
    return std::hypot(q.x() / (15.5 - 9.5 * s), q.y() / (15.5 - 12.0 * s)) - 1.0;
  };
  constexpr double kStep = 1e-3;
  Eigen::Vector3d slope;
  for (int axis = 0; axis < 3; ++axis)
    slope[axis] = (level(p + kStep * Eigen::Vector3d::Unit(axis)) - level(p - kStep * Eigen::Vector3d::Unit(axis))) /
                  (2.0 * kStep);
  return level(p) / std::max(slope.norm(), 0.03);
}

const Points kLoop = {{0, 0, 25},   {30, 0, 25},  {60, 0, 35},  {75, 0, 60},
                      {75, 0, 110}, {60, 0, 135}, {30, 0, 145}, {0, 0, 145}};

class DissectedAorta : public testing::Test
{
protected:
  static const Scan& scan()
  {
    static const Scan made(
        scanOfLumens({-24, -24, -10}, {88, 24, 180}, 0.8, {fromDissectedAorta, tubeAlong(kLoop, 4.0)}));
    return made;
  }
};

TEST_F(DissectedAorta, IsFollowedFromTheWideLumenIntoTheNarrowOne)
{
  const Lumen loop = tubeAlong(kLoop, 4.0);
  // Clicks beside the axis of the narrow lumen, whose bound closes the aorta.
  for (const Points& clicks : {Points{{4, 3, 2}, {4.2, 0.3, 168}}, Points{{0, 9, 2}, {1, 1, 168}},
                               Points{{4, 3, 2}, {-5, 2, 40}, {4.2, 0, 110}, {4, 0, 130}, {-4, 0.3, 168}}})
  {
    const Segmentation result = segmented(scan(), clicks);
    const LumenBranch& branch = result.branches[0];
    EXPECT_NEAR(lengthOf(branch), 166.0, 6.0);
    const ContourErrors errors =
        contourErrors(branch.sections, scan().volume().grid.origin, fromDissectedAorta,
                      [&loop](const Eigen::Vector3d& p) { return loop(p) > 3.0 && p.z() > 12.0 && p.z() < 160.0; });
    std::printf("%zu clicks: length %.1f mm, 95 %% %.3f, largest %.2f mm\n", clicks.size(), lengthOf(branch),
                errors.p95, errors.largest);
    EXPECT_LE(errors.p95, 0.15);
    EXPECT_LE(errors.largest, 1.0);
  }
}

// A vessel of 3.4 mm with a loop of 24 mm, at whose neck two lumens lie 0.8 mm apart, one above the other.

/** Straight, round the loop, straight; the loop rises by the distance of the axes. */
Points loopedCourse(double rise)
{
  Points points{{-24, 0, -0.5 * rise}};
  constexpr int kSteps = 120;
  for (int k = 0; k <= kSteps; ++k)
  {
    const double angle = 2.0 * M_PI * k / kSteps;
    points.emplace_back(12.0 * std::sin(angle), 12.0 - 12.0 * std::cos(angle),
                        rise * (static_cast<double>(k) / kSteps - 0.5));
  }
  points.emplace_back(24, 0, 0.5 * rise);
  return points;
}

class KissingLoop : public testing::Test
{
protected:
  static const Scan& scan()
  {
    static const Scan made(scanOfLumens({-28, -6, -7}, {28, 30, 7}, 0.5, {first(), second()}));
    return made;
  }

  /** The two halves of the vessel, so that both lumens count where they lie side by side. */
  static Lumen first()
  {
    const Points all = course();
    return tubeAlong(Points(all.begin(), all.begin() + 62), kRadius);
  }
  static Lumen second()
  {
    const Points all = course();
    return tubeAlong(Points(all.begin() + 61, all.end()), kRadius);
  }
  static Points course() { return loopedCourse(2.0 * kRadius + 0.8); }

  static constexpr double kRadius = 1.7;
};

TEST_F(KissingLoop, IsRefusedWithTheNeckAndTheRemedy)
{
  const std::string error = errorOf(scan(), {{-20, 0.3, -2}, {20, 0, 2.3}});
  EXPECT_NE(error.find("the path between clicks 1 and 2 crosses a dark place at ("), std::string::npos) << error;
  EXPECT_NE(error.find("add a click on the right way"), std::string::npos) << error;
  Eigen::Vector3d place(1e3, 1e3, 1e3);
  std::sscanf(error.c_str() + error.find("dark place at (") + 15, "%lf, %lf, %lf", &place.x(), &place.y(), &place.z());
  EXPECT_LT(std::abs(place.z()), 1.0) << error;
  EXPECT_LT(place.head<2>().norm(), 8.0) << error;
}

TEST_F(KissingLoop, IsFollowedWithOneMoreClick)
{
  const Segmentation result = segmented(scan(), {{-20, 0.3, -2}, {0.5, 24, 0}, {20, 0, 2.3}});
  const LumenBranch& branch = result.branches[0];
  EXPECT_NEAR(lengthOf(branch), 40.0 + 2.0 * M_PI * 12.0, 3.0);
  const Lumen whole = tubeAlong(course(), kRadius);
  const ContourErrors errors = contourErrors(branch.sections, scan().volume().grid.origin, whole,
                                             [](const Eigen::Vector3d& p) { return std::abs(p.x()) < 17.0; });
  std::printf("loop: length %.1f mm, 95 %% %.3f, largest %.2f mm\n", lengthOf(branch), errors.p95, errors.largest);
  EXPECT_LE(errors.p95, 0.15);
  EXPECT_LE(errors.largest, 1.0);
}

TEST_F(KissingLoop, IsANarrowPlaceOfOneVesselWhereClicksOnBothSidesSaySo)
{
  EXPECT_EQ(errorOf(scan(), {{-20, 0.3, -2}, {-3, 0, -2}, {3, 0, 2}, {20, 0, 2.3}}), "");
}

TEST(TwoVessels, SideBySideAreRefusedWhereThePathChangesFromOneToTheOther)
{
  const Scan scan(
      scanOfLumens({-7, -7, -4}, {11, 7, 64}, 0.5,
                   {tubeAlong({{0, 0, -8}, {0, 0, 68}}, 1.7), tubeAlong({{4.2, 0, -8}, {4.2, 0, 68}}, 1.7)}));
  const std::string error = errorOf(scan, {{0.3, 0, 2}, {4, 0.2, 58}});
  EXPECT_NE(error.find("crosses a dark place at (2."), std::string::npos) << error;
  EXPECT_EQ(errorOf(scan, {{0.3, 0, 2}, {0, 0.2, 58}}), "");
}

TEST(Stenosis, OfAnOstiumIsPassed)
{
  const Lumen side = tubeAlong({{0, 0, 30}, {30, 0, 30}},
                               [](double s) { return 1.6 - 0.9 * std::exp(-std::pow((s - 0.2) * 30.0 / 1.5, 2)); });
  const Scan scan(scanOfLumens({-8, -8, -4}, {34, 8, 64}, 0.5, {tubeAlong({{0, 0, -8}, {0, 0, 68}}, 4.0), side}));
  EXPECT_EQ(errorOf(scan, {{0.5, 0, 22}, {28, 0.3, 30}}), "");
}

TEST(Stenosis, IsPassed)
{
  for (const double throat : {0.5, 0.7, 1.0})
  {
    const Lumen artery = tubeAlong({{0, 0, -5}, {0, 0, 45}}, [throat](double s)
                                   { return 1.7 - (1.7 - throat) * std::exp(-std::pow((s - 0.5) * 50.0 / 2.5, 2)); });
    const Scan scan(scanOfLumens({-7, -7, -4}, {7, 7, 44}, 0.5, {artery}));
    const Points clicks = {{0.3, 0, 2}, {0, 0.4, 38}};
    EXPECT_EQ(errorOf(scan, clicks), "") << throat;
  }
}

}  // namespace
}  // namespace endovascular_sim::segmentation
