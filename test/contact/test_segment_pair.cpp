#include "contact/segment_pair.h"

#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::contact
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

}  // namespace
}  // namespace endovascular_sim::contact
