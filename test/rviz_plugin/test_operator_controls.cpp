#include "rviz_plugin/model/operator_controls.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

using Source = OperatorControls::Source;

OperatorControls withWire()
{
  OperatorControls controls;
  controls.choose("wire", 1.0, 60.0);
  return controls;
}

TEST(OperatorControls, MoveNothingWithoutAnInstrument)
{
  OperatorControls controls;
  controls.press(Motion::kPush, Source::kButton);
  EXPECT_TRUE(controls.velocity().isZero());
}

TEST(OperatorControls, PushAndTwistAtTheSetSpeed)
{
  OperatorControls controls = withWire();
  controls.setSpeed(0.5);
  EXPECT_NEAR(controls.speed(), 0.01, 1e-12);  // the middle of 1 to 100 mm/s
  controls.press(Motion::kPush, Source::kButton);
  controls.press(Motion::kTwistLeft, Source::kKey);
  EXPECT_EQ(controls.velocity().instrument, "wire");
  EXPECT_DOUBLE_EQ(controls.velocity().insertion, controls.speed());
  EXPECT_DOUBLE_EQ(controls.velocity().rotation, -controls.turningSpeed());
}

TEST(OperatorControls, OppositeMotionsCancel)
{
  OperatorControls controls = withWire();
  controls.press(Motion::kPush, Source::kButton);
  controls.press(Motion::kPull, Source::kKey);
  EXPECT_TRUE(controls.velocity().isZero());
}

TEST(OperatorControls, AMotionEndsWhenButtonAndKeyAreReleased)
{
  OperatorControls controls = withWire();
  controls.press(Motion::kPull, Source::kButton);
  controls.press(Motion::kPull, Source::kKey);
  controls.release(Motion::kPull, Source::kButton);
  EXPECT_LT(controls.velocity().insertion, 0.0);
  controls.release(Motion::kPull, Source::kKey);
  EXPECT_TRUE(controls.velocity().isZero());
}

TEST(OperatorControls, AnotherInstrumentBeginsAtRestWithinItsLimits)
{
  OperatorControls controls = withWire();
  controls.press(Motion::kPush, Source::kKey);
  controls.choose("catheter", 0.02, 1.0);
  EXPECT_TRUE(controls.velocity().isZero());
  controls.setSpeed(1.0);
  EXPECT_DOUBLE_EQ(controls.speed(), 0.02);
  EXPECT_DOUBLE_EQ(controls.turningSpeed(), 1.0);
  controls.setSpeed(std::nan(""));
  EXPECT_NEAR(controls.speed(), 1e-3, 1e-15);
}

TEST(OperatorControls, FollowTheStickWithAShareOfTheSpeed)
{
  OperatorControls controls;
  controls.choose("wire", 1.0, 60.0);
  controls.setStick(0.5, -1.0);
  EXPECT_DOUBLE_EQ(controls.velocity().insertion, 0.5 * controls.speed());
  EXPECT_DOUBLE_EQ(controls.velocity().rotation, -controls.turningSpeed());
  controls.press(Motion::kPush, OperatorControls::Source::kKey);
  EXPECT_DOUBLE_EQ(controls.velocity().insertion, controls.speed()) << "not faster than the speed";
  controls.setStick(std::nan(""), 7.0);
  EXPECT_DOUBLE_EQ(controls.velocity().rotation, controls.turningSpeed());
  controls.releaseAll();
  EXPECT_TRUE(controls.velocity().isZero());
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
