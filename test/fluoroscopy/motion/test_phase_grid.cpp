#include "fluoroscopy/motion/phase_grid.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

motion::PatientMotion adult()
{
  return {motion::naturalHeart(), motion::adultMotion()};
}

TEST(PhaseGrid, HasAMotionWithinItsToleranceOfEveryOne)
{
  const PhaseGrid grid(adult());
  double worst = 0.0;
  for (int beat = 0; beat < 97; ++beat)
    for (int breath = 0; breath < 41; ++breath)
    {
      const BodyMotion motion = motionAt(beat / 97.0, breath / 41.0);
      worst = std::max(worst, distanceBetween(motion, grid.nearest(motion)));
    }
  std::printf("%zu motions, none farther than %.3f mm\n", grid.size(), 1e3 * worst);
  EXPECT_LE(worst, PhaseGrid::kTolerance);
  EXPECT_LT(grid.size(), 1536U);  // as many fit into the memory of ProgressiveProjection
}

TEST(PhaseGrid, HoldsAtOtherHeartRates)
{
  const PhaseGrid grid(adult());
  const motion::PatientMotion patient = adult();
  for (const double rate : {0.6, 2.5})
    for (int beat = 0; beat < 97; ++beat)
    {
      const motion::PatientMotion::Instant instant = patient.at(beat / 97.0, rate, 0.2, 0.25);
      const BodyMotion motion(patient.map(instant), instant.shares.breath * patient.settings().breathing.diaphragm);
      EXPECT_LE(distanceBetween(motion, grid.nearest(motion)), PhaseGrid::kTolerance) << rate << " " << beat;
    }
}

TEST(PhaseGrid, ReturnsItsOwnMotionsAndRest)
{
  const PhaseGrid grid(adult());
  EXPECT_TRUE(grid.nearest(motionAt(0.0, 0.0)).resting());
  const BodyMotion near = grid.nearest(largestMotion());
  EXPECT_EQ(grid.nearest(near), near);
}

TEST(PhaseGrid, LeavesTheMotionOfAnotherHeartAsItIs)
{
  const PhaseGrid grid(adult());
  motion::HeartFrame other = motion::naturalHeart();
  other.base.x() += 1e-3;
  const motion::PatientMotion patient(other, motion::adultMotion());
  const BodyMotion motion(patient.map(patient.at(0.3, 1.2, 0.1, 0.25)), 0.003);
  EXPECT_EQ(grid.nearest(motion), motion);
}

TEST(PhaseGrid, BoundsTheDistanceOfThePlacesOfEveryPoint)
{
  for (const auto& [a, b] :
       {std::pair{motionAt(0.1, 0.1), motionAt(0.14, 0.1)}, std::pair{motionAt(0.5, 0.7), motionAt(0.45, 0.72)},
        std::pair{motionAt(0.0, 0.0), motionAt(0.0, 0.12)}, std::pair{motionAt(0.2, 0.2), largestMotion()}})
  {
    double largest = 0.0;
    for (const Eigen::Vector3d& point : motion::pointsAround(a.map().frame(), 12))
      largest = std::max(largest, (a.map().position(point) - b.map().position(point)).norm());
    EXPECT_LT(largest, 1.3 * distanceBetween(a, b));
    EXPECT_GE(distanceBetween(a, b), std::abs(a.diaphragm() - b.diaphragm()) - 1e-15);
  }
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
