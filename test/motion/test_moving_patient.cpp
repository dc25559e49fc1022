#include "motion/moving_patient.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "common/archive.h"
#include "test/common/input_error_of.h"
#include "test/motion/motion_fixtures.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Vector3d;

MovingPatient naturalPatient()
{
  return {naturalHeart(), adultMotion(), 1e-3};
}

Vector3d ostium()
{
  return branchNamed(naturalCentreline(), "left_main").points.front();
}

TEST(MovingPatient, BeginsAtRestAndBeatsAndBreathesAtItsRates)
{
  MovingPatient patient = naturalPatient();
  EXPECT_TRUE(patient.map().resting());
  double descended = 0.0, lowest = 0.0;
  int systolic = 0;
  for (int k = 0; k < 12003; ++k)
  {
    patient.advance();
    descended = std::max(descended, patient.map().displacement(ostium()).norm());
    lowest = std::max(lowest, patient.diaphragm());
    systolic += patient.systole();
  }
  EXPECT_EQ(patient.heart().count(), 14U);  // 12 s at 70 per minute
  EXPECT_EQ(patient.breath().count(), 3U);  // at 15 per minute
  EXPECT_GT(descended, 6e-3);
  EXPECT_NEAR(lowest, 0.018, 1e-6);
  EXPECT_NEAR(1e-3 * systolic / 14.0, 0.344, 2e-3);
}

TEST(MovingPatient, MovesContinuouslyFromStepToStepAlsoWhenTheRateChanges)
{
  MovingPatient patient = naturalPatient();
  Vector3d before = ostium(), speed = Vector3d::Zero();
  for (int k = 0; k < 8000; ++k)
  {
    if (k % 1000 == 500)
      patient.setHeartRate(k % 2000 == 500 ? 3.0 : 0.8);
    patient.advance();
    const Vector3d now = patient.map().position(ostium()), velocity = patient.map().velocity(ostium());
    EXPECT_LT((now - before - 5e-4 * (velocity + speed)).norm(), 3e-6) << k;
    before = now;
    speed = velocity;
  }
}

TEST(MovingPatient, HoldsItsBreathAtEndExpirationWhileTheHeartBeats)
{
  MovingPatient patient = naturalPatient();
  for (int k = 0; k < 1000; ++k)
    patient.advance();
  patient.holdBreath(true);
  patient.advance();
  EXPECT_FALSE(patient.breath().standing());
  EXPECT_GT(patient.shares().breath, 0.0);
  for (int k = 0; k < 5000; ++k)
    patient.advance();
  EXPECT_TRUE(patient.breath().standing());
  EXPECT_EQ(patient.shares().breath, 0.0);
  const unsigned beats = patient.heart().count();
  for (int k = 0; k < 5000; ++k)
  {
    patient.advance();
    ASSERT_EQ(patient.diaphragm(), 0.0);
  }
  EXPECT_GT(patient.heart().count(), beats + 4);
  patient.holdBreath(false);
  for (int k = 0; k < 1000; ++k)
    patient.advance();
  EXPECT_GT(patient.diaphragm(), 0.0);
}

TEST(MovingPatient, GoesOnFromASavedStateWithTheSameBits)
{
  MovingPatient patient = naturalPatient();
  patient.setHeartRate(1.5);
  patient.setBreathingRate(0.3);
  for (int k = 0; k < 1234; ++k)
    patient.advance();
  patient.holdBreath(true);
  Archive saved;
  saved(patient);
  MovingPatient loaded = naturalPatient();
  Archive reader(saved.bytes());
  reader(loaded);
  EXPECT_TRUE(reader.atEnd());
  EXPECT_EQ(patient.map().position(ostium()), loaded.map().position(ostium()));
  for (int k = 0; k < 3000; ++k)
  {
    patient.advance();
    loaded.advance();
    ASSERT_EQ(patient.map().position(ostium()), loaded.map().position(ostium()));
    ASSERT_EQ(patient.map().velocity(ostium()), loaded.map().velocity(ostium()));
  }
}

TEST(MovingPatient, FollowsAClockOutside)
{
  MovingPatient patient = naturalPatient();
  patient.setHeartPhase(0.25, 1.0);
  patient.setBreathPhase(0.3, 0.2);
  const PatientMotion& motion = patient.motion();
  const MotionMap map = motion.map(motion.at(0.25, 1.0, 0.3, 0.2));
  EXPECT_EQ(patient.map().position(ostium()), map.position(ostium()));
  EXPECT_EQ(patient.map().velocity(ostium()), map.velocity(ostium()));
}

TEST(MovingPatient, RefusesRatesAndPhasesThatNoPatientHas)
{
  MovingPatient patient = naturalPatient();
  for (const double rate : {0.0, -1.0, 400.0 / 60.0, std::nan("")})
  {
    EXPECT_THROW(patient.setHeartRate(rate), std::invalid_argument) << rate;
    EXPECT_THROW(patient.setBreathingRate(rate), std::invalid_argument) << rate;
    EXPECT_THROW(patient.setHeartPhase(0.5, rate), std::invalid_argument) << rate;
  }
  for (const double phase : {-0.1, 1.0, std::nan("")})
  {
    EXPECT_THROW(patient.setHeartPhase(phase, 1.0), std::invalid_argument) << phase;
    EXPECT_THROW(patient.setBreathPhase(phase, 0.2), std::invalid_argument) << phase;
  }
  try
  {
    patient.setHeartRate(400.0 / 60.0);
    FAIL();
  }
  catch (const std::invalid_argument& error)
  {
    EXPECT_STREQ(error.what(), "heart.rate: 6.667 Hz = 400 per minute; must be between 20 and 300 per minute");
  }
}

TEST(MovingPatient, IsMadeInTheNaturalAnatomyUnlessItsMotionFoldsSpace)
{
  MotionSettings settings = adultMotion();
  EXPECT_EQ(inputErrorOf(
                [&] {
                  makeMovingPatient(naturalCentreline(), settings, 1e-3, {"scene.yaml", "motion.patient."});
                }),
            "");
  settings.heart.base_displacement = 0.026;
  settings.heart.apex_rotation = 0.6;
  const std::string message = inputErrorOf(
      [&] {
        makeMovingPatient(naturalCentreline(), settings, 1e-3, {"scene.yaml", "motion.patient."});
      });
  EXPECT_NE(message.find("scene.yaml: motion.patient.heart: the motion folds space, or nearly so: det ∇φ falls to "),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("give smaller displacements and rotations of heart and breathing, or a larger region.fade"),
            std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::motion
