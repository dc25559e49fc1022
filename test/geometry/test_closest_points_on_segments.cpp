#include "geometry/closest_points_on_segments.h"

#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::geometry
{
namespace
{

class SegmentPairTest : public testing::Test
{
protected:
  Eigen::Vector3d next()
  {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return {uniform(random_), uniform(random_), uniform(random_)};
  }
  std::mt19937 random_{11};
};

TEST_F(SegmentPairTest, OfTwoSegmentsIsNeverBeatenByAGrid)
{
  for (int trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d p1 = next(), q1 = next(), p2 = next(), q2 = next();
    const SegmentPair pair = closestPointsOfSegments(p1, q1, p2, q2);
    const double distance = (p1 + pair.first * (q1 - p1) - p2 - pair.second * (q2 - p2)).norm();
    double best = 1e9;
    for (int i = 0; i <= 80; ++i)
      for (int j = 0; j <= 80; ++j)
        best = std::min(best, (p1 + (q1 - p1) * i / 80.0 - p2 - (q2 - p2) * j / 80.0).norm());
    EXPECT_LE(distance, best + 1e-12);
    EXPECT_GE(distance, best - 0.05);
  }
}

TEST_F(SegmentPairTest, OfAConeAndASegmentIsNeverBeatenByAGrid)
{
  constexpr int kCells = 80;
  int inside = 0;
  for (int trial = 0; trial < 300; ++trial)
  {
    const Eigen::Vector3d p1 = next(), q1 = next(), p2 = next();
    const Eigen::Vector3d q2 = trial % 10 == 0 ? Eigen::Vector3d(p2 + 0.7 * (q1 - p1)) : next();  // some are parallel
    const double taper = (trial % 3 == 0 ? 2.0 : 0.5) * next().x();                               // some are steep
    const auto surface = [&](double t, double s)
    { return (p1 + t * (q1 - p1) - p2 - s * (q2 - p2)).norm() - t * taper; };
    const SegmentPair pair = closestPointsOfCone({p1, q1, taper}, p2, q2);
    double best = 1e9;
    for (int i = 0; i <= kCells; ++i)
      for (int j = 0; j <= kCells; ++j)
        best = std::min(best, surface(static_cast<double>(i) / kCells, static_cast<double>(j) / kCells));
    EXPECT_LE(surface(pair.first, pair.second), best + 1e-9) << "trial " << trial;
    EXPECT_GE(surface(pair.first, pair.second), best - 0.06) << "trial " << trial;
    inside += pair.first > 0.0 && pair.first < 1.0;
  }
  EXPECT_GT(inside, 100);
}

TEST_F(SegmentPairTest, OfAConeThatDoesNotTaperIsThatOfTheSegments)
{
  for (int trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d p1 = next(), q1 = next(), p2 = next(), q2 = next();
    const SegmentPair plain = closestPointsOfSegments(p1, q1, p2, q2);
    const SegmentPair cone = closestPointsOfCone({p1, q1, 0.0}, p2, q2);
    EXPECT_NEAR(cone.first, plain.first, 1e-9);
    EXPECT_NEAR(cone.second, plain.second, 1e-9);
  }
}

}  // namespace
}  // namespace endovascular_sim::geometry
