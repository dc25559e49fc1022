#include "contact/narrow_phase/smooth_edge_walk.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kTaper = 0.1e-3;  // m

/** An edge of a wire over the inner side of a bend, which is convex towards the lumen along the tube. */
class SmoothEdgeWalkTest : public ::testing::Test
{
protected:
  SmoothEdgeWalkTest()
    : wall_(bentTube()),
      smooth_(wall_),
      search_(smooth_),
      begin_(pointAt(0.75)),
      along_(pointAt(1.05) - begin_),
      edge_(search_, begin_, along_, kTaper)
  {
    double nearest = 1.0;
    for (int t = 0; t < static_cast<int>(wall_.triangles.size()); ++t)
    {
      const double height = std::abs(search_.walk(begin_ + 0.5 * along_, t).height);
      triangle_ = height < nearest ? t : triangle_;
      nearest = std::min(nearest, height);
    }
  }

  static Eigen::Vector3d pointAt(double angle)
  {
    const Eigen::Vector3d inwards(std::cos(0.3), std::sin(0.3), 0.0);  // towards the centre of the bend
    const Eigen::Vector3d centre = Eigen::Vector3d(0.0, 0.0, 0.03) + 0.02 * inwards;
    return centre + 16.5e-3 * (-std::cos(angle) * inwards + std::sin(angle) * Eigen::Vector3d::UnitZ());
  }

  SmoothEdgeWalk::Place placeAt(double parameter) const
  {
    return edge_.placeOf(parameter, search_.walk(begin_ + parameter * along_, triangle_));
  }

  Wall wall_;
  SmoothWall smooth_;
  SmoothFootSearch search_;
  Eigen::Vector3d begin_, along_;
  SmoothEdgeWalk edge_;
  int triangle_ = -1;
};

TEST_F(SmoothEdgeWalkTest, SlopeIsTheDerivativeOfTheGap)
{
  constexpr double kStep = 1e-4;
  for (double t = 0.05; t < 1.0; t += 0.1)
  {
    const double change = (placeAt(t + kStep).gap - placeAt(t - kStep).gap) / (2.0 * kStep);
    EXPECT_NEAR(placeAt(t).slope, change, 1e-5 * along_.norm()) << t;
  }
}

TEST_F(SmoothEdgeWalkTest, FindsTheSameMinimumFromBothSides)
{
  double least = 1.0;
  for (int k = 0; k <= 1000; ++k)
    least = std::min(least, placeAt(k / 1000.0).gap);
  for (double start : {0.02, 0.3, 0.98})
  {
    const std::optional<SmoothEdgeWalk::Place> found = edge_.minimumFrom(start, triangle_);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->gap, least, 1e-9);
    EXPECT_NEAR(edge_.minimumBetween(placeAt(0.0), placeAt(1.0)).parameter, found->parameter, 1e-3);
  }
}

TEST_F(SmoothEdgeWalkTest, FindsNoneWhereTheGapFallsToTheEnd)
{
  const double middle = edge_.minimumFrom(0.5, triangle_)->parameter;
  const SmoothEdgeWalk falling(search_, begin_, 0.8 * middle * along_, kTaper);
  EXPECT_FALSE(falling.minimumFrom(0.5, triangle_));
}

}  // namespace
}  // namespace endovascular_sim::contact
