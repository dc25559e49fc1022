#include <vector>

#include <gtest/gtest.h>

#include "results/pressure_course.h"

namespace endovascular_sim::results
{
namespace
{

constexpr double kAorta = 12000.0;  // mean pressure [Pa]

/** Adds beats of a wire behind a lesion and of a catheter before it.
 *  @param ratio of their mean pressures [1] */
void addBeats(PressureCourse& course, int count, double ratio, bool hyperaemia)
{
  for (int k = 0; k < count; ++k)
  {
    flow::BeatMeans means;
    means.step = course.empty() ? 1 : course.beats().back().step + 1;
    means.root = kAorta;
    means.readings = {ratio * kAorta, kAorta};
    means.hyperaemia = hyperaemia;
    course.add(static_cast<double>(means.step), means);
  }
}

TEST(RestBeforeHyperaemia, ReadsTheRestBeforeEachHyperaemiaAndTheReserveInIt)
{
  PressureCourse course;
  addBeats(course, 5, 0.0, false);   // wire outside
  addBeats(course, 1, 0.6, false);   // it enters within a beat
  addBeats(course, 5, 1.0, false);   // before the stenosis
  addBeats(course, 5, 0.93, false);  // behind it
  addBeats(course, 1, 0.9, false);   // hyperaemia begins within this beat
  addBeats(course, 8, 0.78, true);
  addBeats(course, 5, 0.99, false);  // with a stent
  addBeats(course, 1, 0.975, false);
  addBeats(course, 8, 0.96, true);
  addBeats(course, 5, 1.0, false);  // wire withdrawn
  const PressureCourse::Reserve reserve = course.ofLines(0, 1);
  EXPECT_NEAR(reserve.rest_before.value(), 0.93, 1e-12);
  EXPECT_NEAR(reserve.before.value(), 0.78, 1e-12);
  EXPECT_NEAR(reserve.rest_after.value(), 0.99, 1e-12);
  EXPECT_NEAR(reserve.after.value(), 0.96, 1e-12);
}

TEST(RestBeforeHyperaemia, WithoutHyperaemiaReadsTheFirstAndTheLastBeat)
{
  PressureCourse course;
  addBeats(course, 5, 0.0, false);
  addBeats(course, 3, 0.9, false);
  addBeats(course, 3, 0.95, false);
  const PressureCourse::Reserve reserve = course.ofLines(0, 1);
  EXPECT_NEAR(reserve.rest_before.value(), 0.9, 1e-12);
  EXPECT_NEAR(reserve.rest_after.value(), 0.95, 1e-12);
  EXPECT_FALSE(reserve.before.has_value());
  EXPECT_FALSE(reserve.after.has_value());
}

}  // namespace
}  // namespace endovascular_sim::results
