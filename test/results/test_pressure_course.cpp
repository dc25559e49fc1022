#include "results/pressure_course.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace endovascular_sim::results
{
namespace
{

/** Beat of 1 s with one lesion and two lines. */
flow::BeatMeans beat(std::uint64_t step, double behind, bool hyperaemia)
{
  flow::BeatMeans means;
  means.root = 12e3;
  means.lesions = {behind};
  means.readings = {behind + 100.0, 12e3};
  means.hyperaemia = hyperaemia;
  means.step = step;
  return means;
}

/** Rest, hyperaemia, rest, hyperaemia after a treatment, rest. */
PressureCourse course()
{
  PressureCourse pressures;
  std::uint64_t step = 0;
  const auto add = [&](int beats, double from, double to, bool hyperaemia)
  {
    for (int k = 0; k < beats; ++k)
    {
      ++step;
      pressures.add(static_cast<double>(step), beat(step, from + (to - from) * k / beats, hyperaemia));
    }
  };
  add(5, 11.4e3, 11.4e3, false);
  add(10, 10e3, 8e3, true);
  add(5, 11.4e3, 11.4e3, false);
  add(3, 11.5e3, 11.5e3, true);
  add(5, 11.9e3, 11.9e3, false);
  return pressures;
}

TEST(PressureCourse, ReadsTheReserveOfEachHyperaemiaAsSoonAsItHasSettled)
{
  const PressureCourse::Reserve reserve = course().ofLesion(0);
  EXPECT_NEAR(*reserve.rest_before, 11.4 / 12.0, 1e-12);
  EXPECT_NEAR(*reserve.rest_after, 11.4 / 12.0, 1e-12);
  EXPECT_NEAR(*reserve.before, (10.0 - 0.2 * 6) / 12.0, 1e-12) << "after six beats";
  EXPECT_NEAR(*reserve.after, 11.5 / 12.0, 1e-12) << "the last beat of a short one";
}

TEST(PressureCourse, DividesTheReadingsOfTwoLines)
{
  EXPECT_NEAR(*course().ofLines(0, 1).rest_before, 11.5 / 12.0, 1e-12);
  PressureCourse outside;
  flow::BeatMeans means = beat(1, 0.0, false);
  means.readings = {0.0, 12e3};
  outside.add(1.0, means);
  EXPECT_FALSE(outside.ofLines(0, 1).rest_before.has_value()) << "the wire is outside";
}

TEST(PressureCourse, CountsEachBeatOnceAndCanBeCut)
{
  PressureCourse pressures;
  pressures.add(1.0, flow::BeatMeans());
  EXPECT_TRUE(pressures.empty()) << "no beat yet";
  for (int k = 0; k < 5; ++k)
    pressures.add(1.0, beat(7, 11e3, false));
  EXPECT_EQ(pressures.times().size(), 1U);
  pressures.add(2.0, beat(8, 10e3, false));
  EXPECT_EQ(pressures.until(1.5).times().size(), 1U);
  EXPECT_EQ(pressures.until(2.0).times().size(), 2U);
}

TEST(PressureCourse, HasNoReserveWithoutHyperaemia)
{
  PressureCourse pressures;
  pressures.add(1.0, beat(1, 11e3, false));
  EXPECT_FALSE(pressures.ofLesion(0).before.has_value());
  EXPECT_FALSE(pressures.ofLesion(0).after.has_value());
}

}  // namespace
}  // namespace endovascular_sim::results
