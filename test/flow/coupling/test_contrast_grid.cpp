#include "flow/coupling/contrast_grid.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "test/flow/body/natural_anatomy.h"

namespace endovascular_sim::flow
{
namespace
{

class NaturalGrid : public testing::Test
{
protected:
  int branch(const std::string& name) const
  {
    for (std::size_t b = 0; b < tree.branches.size(); ++b)
      if (tree.branches[b].name == name)
        return static_cast<int>(b);
    ADD_FAILURE() << name;
    return 0;
  }

  const vessel::CentrelineTree tree = naturalCentreline();
  const VesselFlowTree vessel = vesselFlowTree(tree, readCirculation(PROJECT_DIR "/config/hemodynamics/adult.yaml"), {},
                                               std::vector<bool>(tree.branches.size(), false));
  const ContrastGrid grid{vessel, tree};
};

TEST_F(NaturalGrid, DividesTheHalvesOfTheNetworksCellsWithoutGaps)
{
  double length = 0.0, of_network = 0.0;
  for (const CellPlace& place : vessel.places)
    of_network += place.end - place.begin;
  for (std::size_t k = 0; k < grid.cells().size(); ++k)
  {
    const contrast::ContrastCell& cell = grid.cells()[k];
    const CellPlace& place = vessel.places[grid.flowCell(k)];
    const FlowCell& flow_cell = vessel.tree.cells[grid.flowCell(k)];
    length += cell.end - cell.begin;
    EXPECT_EQ(cell.branch, place.branch);
    EXPECT_LT(cell.parent, static_cast<int>(k));
    const bool is_first = cell.end <= 0.5 * (place.begin + place.end) + 1e-12;
    EXPECT_EQ(static_cast<int>(grid.node(k)), is_first ? flow_cell.from : flow_cell.to) << k;
    EXPECT_LE(cell.end - cell.begin, std::max(2.5e-3, 0.45 * std::sqrt(flow_cell.wall.area / M_PI)) * (1.0 + 1e-6));
    if (k > 0 && grid.cells()[k - 1].branch == cell.branch)
    {
      EXPECT_NEAR(grid.cells()[k - 1].end, cell.begin, 1e-15) << "cell " << k;
      EXPECT_EQ(cell.parent, static_cast<int>(k) - 1);
    }
  }
  EXPECT_NEAR(length, of_network, 1e-12);
  EXPECT_EQ(grid.cells()[0].parent, -1);
  RecordProperty("cells", static_cast<int>(grid.cells().size()));
}

TEST_F(NaturalGrid, ABranchHangsOnTheCellOfItsParentWhereItLeavesIt)
{
  const TreePlace in_left_main{branch("left_main"), 0.02};
  int cell = grid.cellAt(in_left_main);
  while (grid.cells()[static_cast<std::size_t>(cell)].branch == in_left_main.branch)
    cell = grid.cells()[static_cast<std::size_t>(cell)].parent;
  EXPECT_EQ(grid.cells()[static_cast<std::size_t>(cell)].branch, branch("ascending_aorta"));
  EXPECT_LT(grid.cells()[static_cast<std::size_t>(cell)].end, 0.03);
}

TEST_F(NaturalGrid, FindsTheCellOfAPlace)
{
  for (std::size_t k = 0; k < grid.cells().size(); ++k)
  {
    const contrast::ContrastCell& cell = grid.cells()[k];
    EXPECT_EQ(grid.cellAt({cell.branch, 0.5 * (cell.begin + cell.end)}), static_cast<int>(k));
  }
  const int left_main = branch("left_main");
  const int before = grid.cellAt({left_main, 1e-3});
  EXPECT_EQ(grid.cells()[static_cast<std::size_t>(before)].branch, branch("ascending_aorta"))
      << "a tip in the lumen of the aorta";
  EXPECT_EQ(grid.cells()[static_cast<std::size_t>(grid.cellAt({left_main, 1.0}))].branch, left_main);
  EXPECT_EQ(grid.cellAt({-1, 0.0}), -1);
  EXPECT_EQ(grid.cellAt({1000, 0.0}), -1);
}

}  // namespace
}  // namespace endovascular_sim::flow
