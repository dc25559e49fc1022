#include "fluoroscopy/patient/change_cache.h"

#include <gtest/gtest.h>

#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

TEST(ChangeCache, FindsTheNearestPhaseWithinItsTolerance)
{
  ChangeCache cache(0.7e-3, 1 << 20);
  EXPECT_EQ(cache.find(motionAt(0.1, 0.0)), nullptr);
  cache.put(motionAt(0.1, 0.0), {1.0F});
  cache.put(motionAt(0.102, 0.0), {2.0F});
  ASSERT_NE(cache.find(motionAt(0.1, 0.0)), nullptr);
  EXPECT_EQ(cache.find(motionAt(0.1, 0.0))->front(), 1.0F);
  EXPECT_EQ(cache.find(motionAt(0.103, 0.0))->front(), 2.0F);
  EXPECT_EQ(cache.find(motionAt(0.25, 0.0)), nullptr);
  EXPECT_EQ(cache.find(motionAt(0.1, 0.2)), nullptr);  // the diaphragm
  cache.clear();
  EXPECT_EQ(cache.find(motionAt(0.1, 0.0)), nullptr);
}

TEST(ChangeCache, ForgetsTheOldestChangeWhenItsMemoryIsFull)
{
  ChangeCache cache(1e-6, 3 * 4 * sizeof(float));
  for (int k = 0; k < 5; ++k)
    cache.put(motionAt(0.1 * k, 0.0), std::vector<float>(4, static_cast<float>(k)));
  EXPECT_EQ(cache.size(), 3U);
  EXPECT_EQ(cache.find(motionAt(0.1, 0.0)), nullptr);
  EXPECT_EQ(cache.find(motionAt(0.4, 0.0))->front(), 4.0F);
  cache.put(motionAt(0.45, 0.0), std::vector<float>(13));  // larger than the memory
  EXPECT_EQ(cache.size(), 3U);
}

TEST(ChangeCache, BoundsTheDistanceOfThePlacesOfEveryPoint)
{
  for (const auto& [a, b] :
       {std::pair{motionAt(0.1, 0.1), motionAt(0.14, 0.1)}, std::pair{motionAt(0.5, 0.7), motionAt(0.45, 0.72)},
        std::pair{motionAt(0.0, 0.0), motionAt(0.0, 0.12)}, std::pair{motionAt(0.2, 0.2), largestMotion()}})
  {
    double largest = 0.0;
    for (const Eigen::Vector3d& point : motion::pointsAround(a.map().frame(), 12))
      largest = std::max(largest, (a.map().position(point) - b.map().position(point)).norm());
    EXPECT_LT(largest, 1.3 * distanceBetween(a, b));
    EXPECT_GE(distanceBetween(a, b), std::abs(a.diaphragm() - b.diaphragm()));
  }
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
