#include "segmentation/click_order.h"

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/segmentation/forked_vessel.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Points = std::vector<Eigen::Vector3d>;

TEST_F(ForkedVessel, HasClicksInTheirOrderAlongABranch)
{
  const Points along = {{0.5, 0, 4}, {0, 0.5, 20}, {-5.5, 0, 42}, {-14, 0, 61}};
  const Segmentation wanted = segmented(along);
  EXPECT_TRUE(wanted.warnings.empty());
  for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{0, 3, 1, 2}, {1, 0, 3, 2}, {3, 1, 2, 0}})
  {
    Points clicks;
    for (const std::size_t k : order)
      clicks.push_back(along[k]);
    const Segmentation result = segmented(clicks);
    EXPECT_TRUE(holds(result.warnings, "vessel: its clicks were put into their order along the branch: "));
    EXPECT_NEAR(result.branches[0].arc().back(), wanted.branches[0].arc().back(), 1e-3);
  }
}

TEST_F(ForkedVessel, RefusesEndsAsOneBranch)
{
  const std::string error = inputErrorOf([] { segmented({{0.5, 0, 4}, {-14, 0, 61}, {14, 0.5, 61}}); });
  EXPECT_NE(error.find("vessel: the path turns back at click 2"), std::string::npos) << error;
  EXPECT_NE(error.find("Endpoints"), std::string::npos) << error;
}

}  // namespace
}  // namespace endovascular_sim::segmentation
