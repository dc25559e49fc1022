#include "fluoroscopy/patient/change_cache.h"

#include <gtest/gtest.h>

#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

TEST(ChangeCache, FindsTheChangeOfAnEqualMotionOnly)
{
  ChangeCache cache(1 << 20);
  EXPECT_EQ(cache.find(motionAt(0.1, 0.0)), nullptr);
  cache.put(motionAt(0.1, 0.0), {1.0F});
  cache.put(motionAt(0.102, 0.0), {2.0F});
  ASSERT_NE(cache.find(motionAt(0.1, 0.0)), nullptr);
  EXPECT_EQ(cache.find(motionAt(0.1, 0.0))->front(), 1.0F);
  EXPECT_EQ(cache.find(motionAt(0.102, 0.0))->front(), 2.0F);
  EXPECT_EQ(cache.find(motionAt(0.1001, 0.0)), nullptr);
  EXPECT_EQ(cache.find(motionAt(0.1, 0.2)), nullptr);  // the diaphragm
  cache.clear();
  EXPECT_EQ(cache.find(motionAt(0.1, 0.0)), nullptr);
}

TEST(ChangeCache, ForgetsTheOldestChangeWhenItsMemoryIsFull)
{
  ChangeCache cache(3 * 4 * sizeof(float));
  for (int k = 0; k < 5; ++k)
    cache.put(motionAt(0.1 * k, 0.0), std::vector<float>(4, static_cast<float>(k)));
  EXPECT_EQ(cache.size(), 3U);
  EXPECT_EQ(cache.find(motionAt(0.1, 0.0)), nullptr);
  EXPECT_EQ(cache.find(motionAt(0.4, 0.0))->front(), 4.0F);
  cache.put(motionAt(0.45, 0.0), std::vector<float>(13));  // larger than the memory
  EXPECT_EQ(cache.size(), 3U);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
