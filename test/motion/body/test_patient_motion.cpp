#include "motion/body/patient_motion.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "test/motion/motion_fixtures.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Vector3d;

/** Heart along z with a core that covers it. */
HeartFrame largeHeart()
{
  HeartFrame frame;
  frame.axis = -Vector3d::UnitZ();
  frame.length = 0.1;
  frame.fade = {Vector3d(0.0, 0.0, -0.05), 0.2, 0.4};
  return frame;
}

MotionMap endSystolic(const MotionSettings& settings)
{
  return mapAt(settings.heart.systolicShare(settings.heart.rate), 0.0, largeHeart(), settings);
}

TEST(HeartAtEndSystole, HasItsBaseTowardsTheApexAndItsApexInPlace)
{
  MotionSettings settings;
  settings.heart.radial_shortening = settings.heart.base_rotation = settings.heart.apex_rotation = 0.0;
  const MotionMap map = endSystolic(settings);
  EXPECT_LT((map.displacement({0, 0, 0}) - Vector3d(0, 0, -0.012)).norm(), 1e-15);
  EXPECT_LT((map.displacement({0.03, 0.02, 0}) - Vector3d(0, 0, -0.012)).norm(), 1e-15);
  EXPECT_LT((map.displacement({0, 0, -0.05}) - Vector3d(0, 0, -0.006)).norm(), 1e-15);
  EXPECT_LT(map.displacement({0, 0, -0.1}).norm(), 1e-15);
}

TEST(HeartAtEndSystole, IsNarrowerByTheRadialShortening)
{
  MotionSettings settings;
  settings.heart.base_displacement = settings.heart.base_rotation = settings.heart.apex_rotation = 0.0;
  const MotionMap map = endSystolic(settings);
  EXPECT_LT((map.displacement({0.03, -0.04, -0.02}) - 0.06 * Vector3d(-0.03, 0.04, 0.0)).norm(), 1e-15);
}

TEST(HeartAtEndSystole, IsTwistedCounterClockwiseAtTheApexAsSeenFromThere)
{
  MotionSettings settings;
  settings.heart.base_displacement = settings.heart.radial_shortening = 0.0;
  const MotionMap map = endSystolic(settings);
  // The viewer below the apex looks up along z, with x to the right and y towards the bottom: from x to −y.
  EXPECT_LT((map.displacement({0.03, 0, -0.1}) - Vector3d(0, -0.03 * 0.175, 0)).norm(), 1e-15);
  EXPECT_LT((map.displacement({0.03, 0, 0.0}) - Vector3d(0, 0.03 * 0.052, 0)).norm(), 1e-15);
  EXPECT_LT((map.displacement({0.03, 0, -0.05}) - Vector3d(0, -0.03 * 0.5 * (0.175 - 0.052), 0)).norm(), 1e-15);
}

TEST(MotionOfAPatient, IsZeroAtEndDiastoleAndEndExpiration)
{
  const PatientMotion motion(naturalHeart(), adultMotion());
  EXPECT_TRUE(motion.map(motion.at(0.0, 1.2, 0.0, 0.25)).resting());
  EXPECT_FALSE(motion.map(motion.at(0.1, 1.2, 0.0, 0.25)).resting());
  EXPECT_FALSE(motion.map(motion.at(0.0, 1.2, 0.1, 0.25)).resting());
}

TEST(MotionOfAPatient, RestsAtEndSystoleInDiastoleAndAtEndExpirationAsInPatients)
{
  // Shechter et al. 2005, left coronary tree: less than 1 mm for 80 ± 25 ms at end-systole and 112 ± 42 ms in diastole,
  // less than 0.5 mm for 27 ± 17 % of a breath at end-expiration. Accepted: two standard deviations, and one for the
  // breath.
  const MotionSettings settings = adultMotion();
  const HeartFrame frame = naturalHeart();
  const PatientMotion motion(frame, settings);
  const Vector3d bifurcation = branchNamed(naturalCentreline(), "left_anterior_descending").points.front();
  const auto restAround = [&](double from, double to)
  {
    double longest = 0.0;
    for (double begin = from; begin < to; begin += 0.005)
    {
      const Vector3d first = motion.map(motion.at(begin, settings.heart.rate, 0.0, 0.0)).position(bifurcation);
      double end = begin;
      while (end < 0.999 &&
             (motion.map(motion.at(end, settings.heart.rate, 0.0, 0.0)).position(bifurcation) - first).norm() < 1e-3)
        end += 0.002;
      longest = std::max(longest, (end - begin) / settings.heart.rate);
    }
    return longest;
  };
  const double systolic = restAround(endSystole() - 0.15, endSystole() + 0.05), diastolic = restAround(0.6, 0.9);
  EXPECT_GT(systolic, 0.03);
  EXPECT_LT(systolic, 0.14);
  EXPECT_GT(diastolic, 0.028);
  EXPECT_LT(diastolic, 0.196);
  int resting = 0;
  for (int k = 0; k < 1000; ++k)
    resting +=
        motion.map(motion.at(0.0, settings.heart.rate, 1e-3 * k, 0.25)).displacement(frame.fade.centre).norm() < 5e-4;
  EXPECT_GT(resting, 100);
  EXPECT_LT(resting, 440);
}

}  // namespace
}  // namespace endovascular_sim::motion
