#include "segmentation/lumen/ray_edges.h"

#include <cstdio>

#include <gtest/gtest.h>

#include "test/segmentation/diseased_accuracy.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Segments the usual image of a disease, and requires the limits of accuracy. */
LumenBranch segmented(const char* disease, double degree)
{
  const auto vessel = phantom::diseasedVessel(disease, degree);
  const Scan scan(phantom::imageOf(*vessel, vessel->usualImage()));
  const Segmentation result =
      segmentBranches(scan, clicksInto(*vessel), edgeSettings(scan.modality(), scan.spacing()), 0);
  const DiseasedAccuracy accuracy = accuracyOf(*vessel, scan, result.branches[0]);
  accuracy.print(disease);
  EXPECT_LE(accuracy.p95, 1.5e-4) << degree;
  EXPECT_LE(accuracy.back, 1.5e-4) << degree;
  EXPECT_LE(std::max(accuracy.largest, accuracy.farthest), 1e-3) << degree;
  return result.branches[0];
}

TEST(RayEdges, OfAWideLumenWhoseSignalFallsAcrossItLieAtTheWall)
{
  for (const double darkest : {0.6, 0.35, 0.25})
    segmented("dim_lumen", darkest);
}

TEST(RayEdges, DoNotTakeBoneBesideTheWallForCalcium)
{
  for (const double gap : {0.0, 2e-4, 6e-4})
  {
    const LumenBranch branch = segmented("bone", gap);
    double calcium = 0.0;
    double bone = 0.0;
    for (const Section& section : branch.sections)
    {
      calcium = std::max(calcium, section.share(RayEnd::kCalcium));
      bone = std::max(bone, section.share(RayEnd::kBone));
    }
    EXPECT_LE(calcium, 0.05) << gap;
    if (gap == 0.0)  // farther away, the image falls to the wall before it
    {
      EXPECT_GE(bone, 0.05);
    }
  }
}

}  // namespace
}  // namespace endovascular_sim::segmentation
