#include "segmentation/lumen/contour_filter.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/segmentation/diseased_accuracy.h"

namespace endovascular_sim::segmentation
{
namespace
{

TEST(ContourFilter, KeepsTheCornersOfADissectedLumenBesideAFalseOneAndAnEndograft)
{
  for (const double flap : {-0.5, -0.1, 0.2})
  {
    const auto vessel = phantom::diseasedVessel("dissection", flap);
    const Scan scan(phantom::imageOf(*vessel, vessel->usualImage()));
    const Segmentation result =
        segmentBranches(scan, clicksInto(*vessel), edgeSettings(scan.modality(), scan.spacing()), 0);
    const DiseasedAccuracy accuracy = accuracyOf(*vessel, scan, result.branches[0]);
    accuracy.print("dissection");
    EXPECT_LE(accuracy.p95, 1.5e-4) << flap;
    EXPECT_LE(accuracy.largest, 1e-3) << flap;
    // The rays cut off the edges between flap and wall, which are sharp.
    EXPECT_LE(accuracy.back, 2.5e-4) << flap;
    EXPECT_LE(accuracy.farthest, 1.5e-3) << flap;
  }
}

TEST(ContourFilter, LeavesNoCrescentWhoseHornsTheRaysDoNotSee)
{
  for (const double flap : {-0.3, 0.5})
  {
    const auto vessel = phantom::diseasedVessel("crescent", flap);
    const Scan scan(phantom::imageOf(*vessel, vessel->usualImage()));
    const std::string error = inputErrorOf(
        [&] { segmentBranches(scan, clicksInto(*vessel), edgeSettings(scan.modality(), scan.spacing()), 0); });
    EXPECT_NE(error.find("hides a part of the lumen from its middle at"), std::string::npos) << error;
  }
}

/** Edges of a circle, with an outlier in every section. */
RayTable circle(double radius, double outlier)
{
  RayTable table;
  table.radii.assign(20, {});
  table.ends.assign(20, {});
  for (std::size_t k = 0; k < 20; ++k)
  {
    table.radii[k].fill(radius);
    table.ends[k].fill(RayEnd::kWall);
    table.radii[k][7] = outlier;
  }
  return table;
}

TEST(ContourFilter, DropsASideBranchAndKeepsTheCircle)
{
  RayTable table = circle(2e-3, 4e-3);
  std::vector<Section> sections(20);
  const std::vector<double> radius = medianRadii(sections, table);
  dropOutliers(radius, table);
  EXPECT_EQ(table.ends[10][7], RayEnd::kDropped);
  setContours(radius, table, sections);
  for (const double r : sections[10].radii)
    EXPECT_NEAR(r, 2e-3, 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
