#include "rviz_plugin/model/held_keys.h"

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

TEST(HeldKeys, ActAtEachPress)
{
  HeldKeys keys;
  EXPECT_TRUE(keys.press(Motion::kPush, 1000));
  keys.release(Motion::kPush, 1500);
  EXPECT_TRUE(keys.press(Motion::kPush, 1500)) << "a repetition of a held key goes on";
}

TEST(HeldKeys, AKeyThatIsHeldBackActsAfterItsReleaseOnly)
{
  HeldKeys keys;
  keys.press(Motion::kPush, 1000);
  keys.holdBack();
  for (std::uint64_t time = 1600; time < 5000; time += 40)
  {
    keys.release(Motion::kPush, time);
    EXPECT_FALSE(keys.press(Motion::kPush, time)) << "a repetition that Qt takes for a press";
  }
  keys.release(Motion::kPush, 5000);
  EXPECT_TRUE(keys.press(Motion::kPush, 5200));
  keys.release(Motion::kPush, 6000);
  EXPECT_TRUE(keys.press(Motion::kPush, 6000));
}

TEST(HeldKeys, AKeyIsHeldBackBetweenReleaseAndPressOfItsRepetition)
{
  HeldKeys keys;
  keys.press(Motion::kPull, 1000);
  keys.release(Motion::kPull, 1700);
  keys.holdBack();
  EXPECT_FALSE(keys.press(Motion::kPull, 1700));
  EXPECT_TRUE(keys.press(Motion::kPush, 1710)) << "another key";
}

TEST(HeldKeys, WithoutTimesEachPressActs)
{
  HeldKeys keys;
  keys.press(Motion::kPush, 0);
  keys.holdBack();
  keys.release(Motion::kPush, 0);
  EXPECT_TRUE(keys.press(Motion::kPush, 0));
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
