#include "benchmark/fuzz/wire_check.h"

#include <gtest/gtest.h>

#include "benchmark/fuzz/fuzz_random.h"
#include "vessel/anatomy/tube.h"

namespace endovascular_sim::benchmark
{
namespace
{

/** Channel of 3 mm radius with a bend of 90° about the point (20 mm, 0, 0). */
geometry::TriangleMesh quarterTurn()
{
  vessel::TubeShape shape;
  shape.radius = 3e-3;
  shape.facet_length = 1e-3;
  shape.facets_around = 24;
  shape.pieces = {{0.02 * M_PI / 2.0, 50.0, 0.0}, {0.02, 0.0, 0.0}};
  return vessel::tubeMesh(shape);
}

TEST(WireCheck, DetectsAnEdgeThatLeavesTheLumenBetweenTwoInnerNodes)
{
  const geometry::TriangleMesh mesh = quarterTurn();
  WireCheck check(mesh);
  const Eigen::Vector3d end(0.02, 0.0, 0.02);
  EXPECT_GT(check.signedDistance(Eigen::Vector3d::Zero()), 2e-3);
  EXPECT_GT(check.signedDistance(end), 2e-3);
  EXPECT_TRUE(check.check({{Eigen::Vector3d::Zero(), 0.4e-3, 0.0}, {end, 0.4e-3, 0.0}}).outside);
  const Eigen::Vector3d middle = Eigen::Vector3d(0.02, 0.0, 0.0) + 0.02 * Eigen::Vector3d(-M_SQRT1_2, 0.0, M_SQRT1_2);
  EXPECT_FALSE(check
                   .check({{Eigen::Vector3d::Zero(), 0.4e-3, 0.0},
                           {0.5 * (middle + Eigen::Vector3d(0.0, 0.0, 0.008)), 0.4e-3, 0.0},
                           {middle, 0.4e-3, 0.0}})
                   .outside);
}

TEST(WireCheck, FindsTheDepthOfABruteForceSearchWithManyPoints)
{
  const geometry::TriangleMesh mesh = quarterTurn();
  WireCheck check(mesh);
  FuzzRandom random(3, 1);
  int deep = 0;
  for (int trial = 0; trial < 40; ++trial)
  {
    std::vector<CheckedNode> nodes;
    for (int k = 0; k < 3; ++k)
      nodes.push_back(
          {{random.between(-2.2e-3, 2.2e-3), random.between(-1.5e-3, 1.5e-3), 1e-3 + 1.5e-3 * k}, 0.6e-3, 0.0});
    double depth = 0.0;
    for (int k = 0; k + 1 < 3; ++k)
      for (int s = 0; s <= 60; ++s)
        depth =
            std::max(depth, 0.6e-3 - check.bruteSignedDistance(nodes[k].position +
                                                               s / 60.0 * (nodes[k + 1].position - nodes[k].position)));
    const WireFinding finding = check.check(nodes);
    EXPECT_GE(finding.depth, depth - (depth > 20e-6 ? 2.1e-6 : 22e-6));
    EXPECT_LE(finding.depth, depth + 20e-6);  // the maximum may lie between the sampled points
    deep += depth > 20e-6;
  }
  EXPECT_GT(deep, 2);
}

TEST(WireCheck, ReportsANodeThatIsNotFinite)
{
  const geometry::TriangleMesh mesh = quarterTurn();
  WireCheck check(mesh);
  EXPECT_FALSE(check.check({{Eigen::Vector3d(0.0, NAN, 0.0), 0.4e-3, 0.0}}).finite);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
