#include "fluoroscopy/gantry/gantry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "common/error.h"
#include "common/units.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kDegree;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

CArmPose start()
{
  CArmPose pose;
  pose.isocentre = {0.01, -0.02, 0.3};
  return pose;
}

Gantry gantry()
{
  return {GantryLimits(), start()};
}

/** Message of the refusal of a target; empty when it is accepted. */
template <typename Change>
std::string refusal(Change change)
{
  Gantry moved = gantry();
  CArmPose before = start();
  before.primary_angle = 0.2;
  moved.moveTo(before);
  CArmPose target = start();
  change(target);
  try
  {
    moved.moveTo(target);
  }
  catch (const InputError& error)
  {
    EXPECT_EQ(moved.target(), before) << "a refused command changes the target";
    return error.what();
  }
  return "";
}

void expectParts(const std::string& text, std::initializer_list<const char*> parts)
{
  for (const char* part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is missing in: " << text;
}

TEST(Gantry, RotatesAt25DegreesPerSecondAndStopsExactlyAtTheTarget)
{
  Gantry moved = gantry();
  CArmPose target = start();
  target.primary_angle = 40.0 * kDegree;
  target.secondary_angle = -20.0 * kDegree;
  moved.moveTo(target);
  EXPECT_EQ(moved.pose(), start());
  EXPECT_TRUE(moved.advance(0.4));
  EXPECT_NEAR(moved.pose().primary_angle, 10.0 * kDegree, 1e-12);
  EXPECT_NEAR(moved.pose().secondary_angle, -10.0 * kDegree, 1e-12);
  EXPECT_TRUE(moved.advance(0.6));
  EXPECT_NEAR(moved.pose().primary_angle, 25.0 * kDegree, 1e-12);
  EXPECT_DOUBLE_EQ(moved.pose().secondary_angle, target.secondary_angle);
  EXPECT_TRUE(moved.advance(10.0));
  EXPECT_EQ(moved.pose(), target);
  EXPECT_FALSE(moved.isMoving());
  EXPECT_FALSE(moved.advance(1.0));
}

TEST(Gantry, MovesDetectorAndTableAtTheirSpeeds)
{
  Gantry moved = gantry();
  CArmPose target = start();
  target.source_to_detector = 1.0;
  target.isocentre += Eigen::Vector3d(0.1, -0.05, 0.5);
  moved.moveTo(target);
  moved.advance(0.5);
  EXPECT_NEAR(moved.pose().source_to_detector, 1.15, 1e-12);
  EXPECT_TRUE(moved.pose().isocentre.isApprox(start().isocentre + Eigen::Vector3d(0.075, -0.05, 0.075), 1e-12));
  moved.advance(3.0);
  EXPECT_EQ(moved.pose(), target);
}

TEST(Gantry, DependsOnTheDurationsOnly)
{
  CArmPose target = start();
  target.primary_angle = 1.0;
  target.isocentre.z() += 0.4;
  Gantry one = gantry(), two = gantry(), fine = gantry();
  for (Gantry* moved : {&one, &two, &fine})
    moved->moveTo(target);
  for (int k = 0; k < 20; ++k)
  {
    one.advance(1.0 / 15.0);
    two.advance(1.0 / 15.0);
    EXPECT_EQ(one.pose(), two.pose());
  }
  for (int k = 0; k < 200; ++k)
    fine.advance(0.1 / 15.0);
  EXPECT_NEAR(fine.pose().primary_angle, one.pose().primary_angle, 1e-12);
  EXPECT_TRUE(fine.pose().isocentre.isApprox(one.pose().isocentre, 1e-12));
}

TEST(Gantry, DoesNotMoveForADurationThatIsNegativeOrNotANumber)
{
  Gantry moved = gantry();
  CArmPose target = start();
  target.primary_angle = 1.0;
  moved.moveTo(target);
  for (const double duration : {0.0, -1.0, kNan})
    EXPECT_FALSE(moved.advance(duration));
  EXPECT_EQ(moved.pose(), start());
}

TEST(Gantry, ChangesTheDetectorWidthAtOnce)
{
  Gantry moved = gantry();
  CArmPose target = start();
  target.detector_width = 0.2;
  moved.moveTo(target);
  EXPECT_TRUE(moved.advance(1e-6));
  EXPECT_EQ(moved.pose(), target);
}

TEST(Gantry, RefusesAnglesBeyondItsLimitsWithFieldAndRange)
{
  expectParts(refusal([](CArmPose& pose) { pose.primary_angle = 121.0 * kDegree; }),
              {"positioner_primary_angle", "121°", "-120°", "120°", "2.094"});
  expectParts(refusal([](CArmPose& pose) { pose.secondary_angle = -56.0 * kDegree; }),
              {"positioner_secondary_angle", "-56°", "55°"});
  EXPECT_EQ(refusal([](CArmPose& pose) { pose.primary_angle = -120.0 * kDegree; }), "");
  EXPECT_EQ(refusal([](CArmPose& pose) { pose.secondary_angle = 55.0 * kDegree; }), "");
}

TEST(Gantry, RefusesDistancesBeyondItsLimitsWithFieldAndRange)
{
  expectParts(refusal([](CArmPose& pose) { pose.source_to_detector = 1.31; }),
              {"distance_source_to_detector", "1.31 m", "0.9 and 1.3 m"});
  expectParts(refusal([](CArmPose& pose) { pose.source_to_patient = 0.5; }),
              {"distance_source_to_patient", "0.6 and 0.9 m"});
}

TEST(Gantry, KeepsTheDetectorOutOfThePatient)
{
  expectParts(refusal(
                  [](CArmPose& pose)
                  {
                    pose.source_to_detector = 0.95;
                    pose.source_to_patient = 0.85;
                  }),
              {"distance_source_to_patient", "touches the patient", "at most 0.8 m"});
}

TEST(Gantry, KeepsTheClearanceOfTheDetectorOnTheWay)
{
  const GantryLimits limits;
  for (const auto& [from, to] :
       {std::pair(std::pair(1.3, 0.9), std::pair(0.9, 0.75)), std::pair(std::pair(0.9, 0.75), std::pair(1.3, 0.9)),
        std::pair(std::pair(1.05, 0.9), std::pair(0.9, 0.6)), std::pair(std::pair(0.9, 0.6), std::pair(1.05, 0.9))})
  {
    CArmPose pose = start();
    pose.source_to_detector = from.first;
    pose.source_to_patient = from.second;
    Gantry moved(limits, pose);
    pose.source_to_detector = to.first;
    pose.source_to_patient = to.second;
    moved.moveTo(pose);
    while (moved.advance(0.05))
      EXPECT_GE(moved.pose().source_to_detector - moved.pose().source_to_patient, limits.clearance - 1e-9);
    EXPECT_EQ(moved.pose(), pose);
  }
}

TEST(Gantry, RefusesAnIsocentreBeyondTheStrokeOfTheTable)
{
  EXPECT_EQ(refusal([](CArmPose& pose) { pose.isocentre.z() += 0.62; }), "");
  expectParts(refusal([](CArmPose& pose) { pose.isocentre.z() += 0.63; }),
              {"isocentre", "z is 0.93 m", "-0.325 and 0.925 m"});
  expectParts(refusal([](CArmPose& pose) { pose.isocentre.x() -= 0.2; }), {"isocentre", "x is -0.19 m"});
}

TEST(Gantry, RefusesNumbersThatAreNotFinite)
{
  for (const double value : {kNan, kInfinity, -kInfinity})
  {
    expectParts(refusal([value](CArmPose& pose) { pose.primary_angle = value; }), {"positioner_primary_angle"});
    expectParts(refusal([value](CArmPose& pose) { pose.secondary_angle = value; }), {"positioner_secondary_angle"});
    expectParts(refusal([value](CArmPose& pose) { pose.source_to_detector = value; }), {"distance_source_to_detector"});
    expectParts(refusal([value](CArmPose& pose) { pose.source_to_patient = value; }), {"distance_source_to_patient"});
    expectParts(refusal([value](CArmPose& pose) { pose.isocentre.y() = value; }), {"isocentre"});
    expectParts(refusal([value](CArmPose& pose) { pose.detector_width = value; }), {"detector_width"});
  }
  expectParts(refusal([](CArmPose& pose) { pose.detector_width = -0.3; }), {"detector_width"});
}

TEST(Gantry, RefusesAStartBeyondItsLimits)
{
  CArmPose pose = start();
  pose.secondary_angle = 60.0 * kDegree;
  EXPECT_THROW(Gantry(GantryLimits(), pose), InputError);
}

TEST(Gantry, PansTheTableNoFartherThanItsStroke)
{
  Gantry moved = gantry();
  moved.panTo({0.05, -0.02, 2.0});
  EXPECT_TRUE(moved.target().isocentre.isApprox(Eigen::Vector3d(0.05, -0.02, 0.3 + 0.625), 1e-12));
  moved.advance(1.0);
  EXPECT_TRUE(moved.pose().isocentre.isApprox(Eigen::Vector3d(0.05, -0.02, 0.45), 1e-12));
  const CArmPose target = moved.target();
  moved.panTo({kNan, 0.0, 0.0});
  EXPECT_EQ(moved.target(), target);
}

TEST(Gantry, PlacesThePatientWithoutMotionAndAtTheMiddleOfTheStroke)
{
  Gantry moved = gantry();
  CArmPose target = start();
  target.primary_angle = 0.5;
  moved.moveTo(target);
  moved.placePatient({0.0, 0.0, 2.0});
  EXPECT_EQ(moved.pose().isocentre, Eigen::Vector3d(0.0, 0.0, 2.0));
  EXPECT_EQ(moved.target().primary_angle, 0.5);
  target.isocentre = {0.0, 0.0, 2.6};
  moved.moveTo(target);
  EXPECT_EQ(moved.target(), target);
}

TEST(Gantry, RetainsThePoseWhereItIsStopped)
{
  Gantry moved = gantry();
  CArmPose target = start();
  target.primary_angle = 1.0;
  moved.moveTo(target);
  moved.advance(0.5);
  const CArmPose before = moved.pose();
  moved.advance(0.1);
  moved.stopAt(before);
  EXPECT_EQ(moved.pose(), before);
  EXPECT_FALSE(moved.isMoving());
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
