#include "contrast/cells/cell_finder.h"

#include <gtest/gtest.h>

#include <limits>

#include "test/contrast/lumen_fixtures.h"

namespace endovascular_sim::contrast
{
namespace
{

TEST(CellFinder, FindsTheCellsOfPointsOnTheCentreline)
{
  const DividedVessel& vessel = generatedVessel("natural");
  const CellFinder finder(vessel.centreline, vessel.cells);
  std::size_t found = 0, tried = 0;
  for (std::size_t k = 0; k < vessel.cells.size(); ++k)
  {
    const ContrastCell& cell = vessel.cells[k];
    const auto b = static_cast<std::size_t>(cell.branch);
    const geometry::Polyline line(vessel.centreline.branches[b].points);
    if (cell.begin < 0.02)
      continue;  // a parent's lumen may be nearer
    ++tried;
    found += finder.at(line.at(0.5 * (cell.begin + cell.end))) == static_cast<int>(k) ? 1 : 0;
  }
  EXPECT_GT(found, tried * 95 / 100);
  EXPECT_GT(tried, 200U);
}

TEST(CellFinder, GivesTheParentsCellBeforeTheFirstOneOfABranch)
{
  const vessel::CentrelineTree tree{{{"trunk", -1, {{0, 0, 0}, {0, 0, 0.1}}, {5e-3, 5e-3}},
                                     {"side", 0, {{0, 0, 0.05}, {0.05, 0, 0.05}}, {2e-3, 2e-3}}}};
  const ContrastCells cells{{0, 0.0, 0.04, -1}, {0, 0.04, 0.1, 0}, {1, 0.02, 0.05, 1}};
  const CellFinder finder(tree, cells);
  EXPECT_EQ(finder.at({0.0, 0.0, -0.01}), 0);
  EXPECT_EQ(finder.at({0.0, 1e-3, 0.03}), 0);
  EXPECT_EQ(finder.at({0.0, 1e-3, 0.09}), 1);
  EXPECT_EQ(finder.at({0.01, 0.0, 0.05}), 1);
  EXPECT_EQ(finder.at({0.03, 0.0, 0.05}), 2);
  EXPECT_EQ(finder.at(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())), -1);
}

}  // namespace
}  // namespace endovascular_sim::contrast
