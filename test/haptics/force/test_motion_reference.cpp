#include "haptics/force/motion_reference.h"

#include <gtest/gtest.h>

#include <cmath>

namespace endovascular_sim::haptics
{
namespace
{

TEST(MotionReference, StartsAtTheGivenCommandForAnyPositionOfTheDevice)
{
  MotionReference motion({0.1, 0.5});
  EXPECT_EQ(motion.update({7.0, -3.0})->insertion, 0.1);
  EXPECT_NEAR(motion.update({7.01, -3.5})->insertion, 0.11, 1e-12);
  EXPECT_DOUBLE_EQ(motion.command().rotation, 0.0);
}

TEST(MotionReference, HoldsAndContinuesWhenTheCountOfTheDeviceRestarts)
{
  MotionReference motion;
  motion.update({0.0, 0.0});
  for (int i = 1; i <= 20; ++i)
    motion.update({0.01 * i, 0.0});
  motion.hold();
  EXPECT_EQ(motion.update({0.0, 0.0})->insertion, 0.2) << "no jump back to the device's zero";
  EXPECT_DOUBLE_EQ(motion.update({0.005, 0.0})->insertion, 0.205);
  EXPECT_EQ(motion.rebased(), 1U);
}

TEST(MotionReference, SkipsASingleOutlier)
{
  MotionReference motion;
  motion.update({0.0, 0.0});
  EXPECT_FALSE(motion.update({55.0, 0.0}));
  EXPECT_FALSE(motion.update({std::nan(""), 0.0}));
  EXPECT_FALSE(motion.update({0.0, 1e30}));
  EXPECT_EQ(motion.update({0.001, 0.0})->insertion, 0.001);
  EXPECT_EQ(motion.rejected(), 3U);
  EXPECT_EQ(motion.rebased(), 0U);
}

TEST(MotionReference, TreatsTwoConsistentSamplesAfterAJumpAsARestart)
{
  MotionReference motion;
  motion.update({0.3, 0.0});
  motion.update({0.31, 0.0});
  EXPECT_FALSE(motion.update({0.0, 0.0}));
  EXPECT_NEAR(motion.update({0.0001, 0.0})->insertion, 0.01, 1e-12);
  EXPECT_EQ(motion.rebased(), 1U);
}

TEST(SampleTimes, FindTheNewestSampleWithTheGivenCommand)
{
  SampleTimes times;
  EXPECT_FALSE(times.find({0.0, 0.0}));
  times.add({0.1, 0.2}, 5);
  times.add({0.1, 0.2}, 6);
  times.add({0.3, 0.2}, 7);
  EXPECT_EQ(times.find({0.1, 0.2}), 6U);
  EXPECT_FALSE(times.find({std::nextafter(0.1, 1.0), 0.2}));
  for (std::uint32_t i = 0; i < 4095; ++i)
    times.add({1.0, static_cast<double>(i)}, i);
  EXPECT_EQ(times.find({0.3, 0.2}), 7U);
  times.add({2.0, 0.0}, 1);
  EXPECT_FALSE(times.find({0.3, 0.2})) << "older than the ring buffer";
}

}  // namespace
}  // namespace endovascular_sim::haptics
