#include "flow/body/vessel_flow_tree.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"

namespace endovascular_sim::flow
{
namespace
{

/** Trunk with two branches, and a branch of the second one. */
vessel::CentrelineTree fork()
{
  const auto branch = [](const char* name, int parent, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return vessel::CentrelineBranch{name, parent, {from, 0.5 * (from + to), to}, {2e-3, 2e-3, 2e-3}};
  };
  return {{branch("trunk", -1, {0, 0, 0}, {0, 0, 0.1}), branch("left", 0, {0, 0, 0.1}, {0.05, 0, 0.15}),
           branch("right", 0, {0, 0, 0.1}, {-0.05, 0, 0.15}), branch("side", 2, {-0.025, 0, 0.125}, {-0.025, 0, 0.2})}};
}

VesselFlowTree built(const vessel::CentrelineTree& tree)
{
  return vesselFlowTree(tree, Circulation(), {}, std::vector<bool>(tree.branches.size(), false));
}

std::string errorOf(const vessel::CentrelineTree& tree)
{
  return inputErrorOf([&] { built(tree); });
}

TEST(VesselFlowTree, DividesEachBranchIntoConsecutiveCells)
{
  const vessel::CentrelineTree tree = fork();
  const VesselFlowTree vessel = built(tree);
  ASSERT_EQ(vessel.ranges.size(), tree.branches.size());
  std::size_t cells = 0;
  for (std::size_t b = 0; b < vessel.ranges.size(); ++b)
  {
    const CellRange& range = vessel.ranges[b];
    ASSERT_LT(range.begin, range.end);
    cells += range.end - range.begin;
    for (std::size_t k = range.begin; k < range.end; ++k)
    {
      EXPECT_EQ(vessel.places[k].branch, static_cast<int>(b));
      if (k > range.begin)
      {
        EXPECT_EQ(vessel.places[k].begin, vessel.places[k - 1].end);
      }
    }
  }
  EXPECT_EQ(cells, vessel.places.size());
  EXPECT_EQ(vessel.outlets.size(), 3U);
}

TEST(VesselFlowTree, RefusesALoopWithBranchAndRemedy)
{
  const std::string remedy =
      "its parent is not an earlier branch, so that the vessel may have a loop; list parents before their children";
  vessel::CentrelineTree loop = fork();
  loop.branches[2].parent = 3;  // the parent of which is this branch
  EXPECT_EQ(errorOf(loop), "flow: centreline, branch \"right\": " + remedy);
  vessel::CentrelineTree own = fork();
  own.branches[1].parent = 1;
  EXPECT_EQ(errorOf(own), "flow: centreline, branch \"left\": " + remedy);
  vessel::CentrelineTree beyond = fork();
  beyond.branches[3].parent = 17;
  EXPECT_EQ(errorOf(beyond), "flow: centreline, branch \"side\": " + remedy);
}

TEST(VesselFlowTree, RefusesWhatIsNoTreeOfVessels)
{
  EXPECT_EQ(errorOf({}), "flow: centreline: the vessel has no centreline; give vessel.centreline");
  vessel::CentrelineTree roots = fork();
  roots.branches[1].parent = -1;
  EXPECT_EQ(errorOf(roots),
            "flow: centreline, branch \"left\": it has no parent as the first branch, and blood enters "
            "at one place; name its parent");
  vessel::CentrelineTree point = fork();
  point.branches[3].points.resize(1);
  EXPECT_EQ(errorOf(point),
            "flow: centreline, branch \"side\": it has 1 points and 3 radii; give two or more points, "
            "each with a radius");
  vessel::CentrelineTree still = fork();
  still.branches[3].points.assign(3, Eigen::Vector3d::Zero());
  EXPECT_EQ(errorOf(still),
            "flow: centreline, branch \"side\": its length is not positive; give points at different places");
  for (const double radius : {0.0, -1e-3, std::nan("")})
  {
    vessel::CentrelineTree closed = fork();
    closed.branches[1].radii[1] = radius;
    EXPECT_EQ(errorOf(closed), "flow: centreline, branch \"left\": a radius is not positive; give radii in metres");
  }
  EXPECT_THROW(vesselFlowTree(fork(), Circulation(), {}, {true}), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::flow
