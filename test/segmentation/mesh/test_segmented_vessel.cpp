#include "segmentation/mesh/segmented_vessel.h"

#include <gtest/gtest.h>

#include "test/segmentation/accuracy.h"

// From clicks to a mesh with open ends.

namespace endovascular_sim::segmentation
{
namespace
{

class SegmentedVesselOfTheHeart : public testing::Test
{
protected:
  SegmentedVesselOfTheHeart()
    : scan_(heartScan(truth_, {}, {0.0, -0.095, 0.155}, {0.080, 0.02, 0.225})),
      clicks_(clicksInto(truth_, {"left_main", "left_anterior_descending", "left_circumflex"}, scan_.volume().grid, 3))
  {
    settings_.edge = edgeSettings(scan_.modality(), scan_.spacing());
  }

  Truth truth_;
  Scan scan_;
  ClickSet clicks_;
  VesselSettings settings_;
};

TEST_F(SegmentedVesselOfTheHeart, IsOneTreeWithAnOpeningAtEveryEnd)
{
  std::size_t seen = 0;
  VesselObserver observer;
  observer.segmented = [&seen](const std::vector<LumenBranch>& branches) { seen = branches.size(); };
  const SegmentedVessel vessel = segmentVessel(scan_, clicks_, settings_, "heart", observer);
  EXPECT_EQ(seen, 3U);
  EXPECT_EQ(vessel.branches.size(), 3U);
  EXPECT_EQ(vessel.centreline.branches.size(), 3U);
  EXPECT_EQ(vessel.open_ends, 3);
  EXPECT_LE(vessel.report.result_to_input.largest, settings_.max_distance);
}

TEST_F(SegmentedVesselOfTheHeart, KeepsAnEndClosedThatIsNamed)
{
  settings_.closed = {"left_circumflex"};
  EXPECT_EQ(segmentVessel(scan_, clicks_, settings_, "heart").open_ends, 2);
  settings_.closed = {"no_such_branch"};
  EXPECT_THROW(segmentVessel(scan_, clicks_, settings_, "heart"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
