#include "motion/cycle/time_course.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "test/motion/motion_fixtures.h"

namespace endovascular_sim::motion
{
namespace
{

const CoursePoints kRise{{0.0, 0.5, 0.8, 1.0}, {0.0, 0.6, 0.95, 1.0}};
const CoursePoints kFall{{0.0, 0.3, 0.7, 1.0}, {1.0, 0.3, 0.3, 0.0}};

TEST(TimeCourse, PassesThroughItsPointsAndIsLevelWhereItsPartsMeet)
{
  const TimeCourse course(kRise, kFall);
  const double share = 0.4;
  for (std::size_t k = 0; k < 4; ++k)
  {
    EXPECT_NEAR(course.at(share * kRise.times[k], share).value, kRise.values[k], 1e-15);
    EXPECT_NEAR(course.at(share + (1.0 - share) * kFall.times[k], share).value, kFall.values[k], 1e-15);
  }
  for (const double phase : {0.0, share, 1.0})
    EXPECT_NEAR(course.at(phase, share).slope, 0.0, 1e-12);
  EXPECT_EQ(course.at(0.0, share).value, 0.0);
  EXPECT_EQ(course.at(share, share).value, 1.0);
}

TEST(TimeCourse, HasTheSlopeOfDifferencesAndNoOvershoot)
{
  const TimeCourse course(kRise, kFall);
  for (const double share : {0.2, 0.4, 0.6})
    for (int k = 1; k < 1000; ++k)
    {
      const double phase = 1e-3 * k, step = 1e-6;
      const TimeCourse::Sample sample = course.at(phase, share);
      const double difference =
          (course.at(phase + step, share).value - course.at(phase - step, share).value) / (2 * step);
      EXPECT_NEAR(sample.slope, difference, 2e-3) << phase;
      EXPECT_GE(sample.value, 0.0);
      EXPECT_LE(sample.value, 1.0);
      EXPECT_TRUE(phase < share ? sample.slope >= 0.0 : sample.slope <= 1e-12) << phase;
    }
}

TEST(TimeCourse, IsRefusedForPointsThatAreNoRiseAndFall)
{
  EXPECT_THROW(TimeCourse({{0.0, 1.0}, {0.0, 0.9}}, kFall), std::invalid_argument);
  EXPECT_THROW(TimeCourse({{0.0, 0.5, 0.5, 1.0}, {0.0, 0.1, 0.2, 1.0}}, kFall), std::invalid_argument);
  EXPECT_THROW(TimeCourse({{0.0, 0.9}, {0.0, 1.0}}, kFall), std::invalid_argument);
  EXPECT_THROW(TimeCourse({{0.0}, {0.0}}, kFall), std::invalid_argument);
  EXPECT_THROW(TimeCourse(kRise, kRise), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::motion
