#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"
#include "nodes/conversions/motion_conversions.h"
#include "test/motion/motion_fixtures.h"

namespace endovascular_sim::nodes
{
namespace
{

const Eigen::Vector3d kPoint(0.01, 0.02, -0.015);  // of the heart, relative to its base [m]

motion::MovingPatient movedPatient()
{
  motion::MovingPatient patient(motion::naturalHeart(), motion::adultMotion(), 1e-3);
  for (int k = 0; k < 1234; ++k)
    patient.advance();
  return patient;
}

MotionState stateOf(const motion::MovingPatient& patient)
{
  MotionState message;
  toMessage(patient, message);
  return message;
}

TEST(MotionConversions, AMapKeepsItsBits)
{
  const motion::MovingPatient patient = movedPatient();
  const MotionState message = stateOf(patient);
  const motion::MotionMap map = fromMessage(message);
  const Eigen::Vector3d point = patient.map().frame().base + kPoint;
  ASSERT_GT(patient.map().displacement(point).norm(), 1e-4);
  EXPECT_EQ(map.position(point), patient.map().position(point));
  EXPECT_EQ(map.velocity(point), patient.map().velocity(point));
  EXPECT_EQ(map.pullBack(point), patient.map().pullBack(point));
  EXPECT_EQ(map.gradient(point), patient.map().gradient(point));
}

TEST(MotionConversions, AStateHasPhasesAndDiaphragm)
{
  motion::MovingPatient patient = movedPatient();
  MotionState message = stateOf(patient);
  EXPECT_EQ(message.heart_phase, patient.heart().phase());
  EXPECT_EQ(message.heart_rate, patient.heart().rate());
  EXPECT_EQ(message.systole != 0, patient.systole());
  EXPECT_EQ(message.breath_phase, patient.breath().phase());
  EXPECT_EQ(message.breathing_rate, patient.breath().rate());
  EXPECT_FALSE(message.breath_held);
  EXPECT_EQ(message.diaphragm, patient.diaphragm());
  patient.holdBreath(true);
  EXPECT_FALSE(stateOf(patient).breath_held) << "until the end of the expiration";
  for (int k = 0; k < 4000; ++k)
    patient.advance();
  EXPECT_TRUE(stateOf(patient).breath_held);
}

TEST(MotionConversions, RefuseNumbersThatAreNoMap)
{
  const MotionState valid = stateOf(movedPatient());
  const auto isRefused = [&valid](const std::function<void(MotionState&)>& damage)
  {
    MotionState message = valid;
    damage(message);
    EXPECT_THROW(fromMessage(message), InputError);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  isRefused([nan](MotionState& message) { message.shift.x = nan; });
  isRefused([nan](MotionState& message) { message.linear[8] = nan; });
  isRefused([nan](MotionState& message) { message.twist_rate = nan; });
  isRefused([](MotionState& message) { message.axis.x += 0.1; });
  isRefused([](MotionState& message) { message.fade_reach = message.fade_core; });
  isRefused([nan](MotionState& message) { message.fade_centre.z = nan; });
  isRefused([nan](MotionState& message) { message.base.y = nan; });
}

TEST(MotionConversions, ControlsKeepTheirBitsAndImpossibleOnesAreRefused)
{
  const motion::MotionControls controls{1.0 / 3.0 + 1.0, 0.7 / 3.0, true};
  MotionControls message;
  toMessage(controls, message);
  EXPECT_EQ(fromMessage(message), controls);
  message.heart_rate = 6.0;
  EXPECT_THROW(fromMessage(message), InputError);
  message.heart_rate = 1.0;
  message.breathing_rate = 0.0;
  EXPECT_THROW(fromMessage(message), InputError);
}

}  // namespace
}  // namespace endovascular_sim::nodes
