#include "segmentation/tree_of_ends.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "segmentation/join_branches.h"
#include "test/segmentation/forked_vessel.h"

namespace endovascular_sim::segmentation
{
namespace
{

TEST_F(ForkedVessel, HasABranchPerEndOfAListOfEnds)
{
  ClickSet clicks = clicksInto({{"Endpoints", {{0.5, 0, 4}, {-14, 0, 61}, {14, 0.5, 61}}}});
  clicks.branches[0].are_ends = true;
  std::vector<std::string> warnings;
  const ClickSet branches = withBranchPerEnd(scan(), clicks, settings(), warnings);
  ASSERT_EQ(branches.branches.size(), 2u);
  EXPECT_TRUE(holds(warnings, "is the end of a branch of its own, Endpoints_"));
  Segmentation result = segmentBranches(scan(), branches, settings(), 1);
  joinBranches(scan(), branches, settings(), 1, result);
  double length = 0.0;
  for (const LumenBranch& branch : result.branches)
  {
    EXPECT_NEAR(branch.sections.back().diameter(), 8e-3, 2e-4);
    length = std::max(length, branch.arc().back());
  }
  EXPECT_NEAR(length, 0.0602, 2e-3);
  EXPECT_EQ(std::count_if(result.branches.begin(), result.branches.end(),
                          [](const LumenBranch& branch) { return branch.parent < 0; }),
            1);
}

TEST_F(ForkedVessel, GivesNoBranchToAnEndOnTheWayToAnother)
{
  ClickSet clicks = clicksInto({{"Endpoints", {{0.5, 0, 4}, {-14, 0, 61}, {0, 0.5, 20}}}});
  clicks.branches[0].are_ends = true;
  std::vector<std::string> warnings;
  EXPECT_EQ(withBranchPerEnd(scan(), clicks, settings(), warnings).branches.size(), 1u);
  EXPECT_TRUE(holds(warnings, "click 3 lies on the way to another end"));
}

}  // namespace
}  // namespace endovascular_sim::segmentation
