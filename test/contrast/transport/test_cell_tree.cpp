#include "contrast/transport/cell_tree.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace endovascular_sim::contrast
{
namespace
{

/** Trunk of two cells with a side branch after the first; the trunk is continued by another branch. */
ContrastCells trunkWithSideBranch()
{
  return {{0, 0.0, 1.0, -1}, {0, 1.0, 2.0, 0}, {1, 0.0, 1.0, 0}, {2, 0.0, 1.0, 1}};
}

TEST(CellTree, ContinuesACellInItsBranchOrInItsOnlyChild)
{
  const CellTree tree(trunkWithSideBranch());
  EXPECT_EQ(tree.next(0), 1);
  EXPECT_EQ(tree.previous(1), 0);
  EXPECT_EQ(tree.previous(2), -1) << "a side branch";
  EXPECT_EQ(tree.next(1), 3) << "another branch that continues the trunk";
  EXPECT_EQ(tree.next(3), -1);
  EXPECT_EQ(std::vector<std::size_t>(tree.childrenBegin(0), tree.childrenEnd(0)), (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(tree.childrenBegin(2), tree.childrenEnd(2));
}

TEST(CellTree, RefusesWhatIsNoTree)
{
  ContrastCells cells = trunkWithSideBranch();
  cells[1].parent = 2;
  EXPECT_THROW(CellTree{cells}, std::invalid_argument);
  cells = trunkWithSideBranch();
  cells[2].end = cells[2].begin;
  EXPECT_THROW(CellTree{cells}, std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::contrast
