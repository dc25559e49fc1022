#include "flow/measurement/pressure_line.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;

TEST(PressureLine, OvershootsAStepAsItsDampingSays)
{
  for (const double damping : {0.2, 0.4, 0.7})
  {
    PressureLine line(15.0, damping, 0.0);
    double highest = 0.0;
    for (int k = 0; k < 20000; ++k)
      highest = std::max(highest, line.step(1000.0, 1e-4));
    EXPECT_NEAR(highest, 1000.0 * (1.0 + std::exp(-kPi * damping / std::sqrt(1.0 - damping * damping))), 1.0);
    EXPECT_NEAR(line.reading(), 1000.0, 1e-3);
  }
}

TEST(PressureLine, HasTheGainOfASecondOrderSystemAtEveryFrequency)
{
  for (const double frequency : {1.2, 6.0, 15.0, 30.0})
  {
    PressureLine line(15.0, 0.3, 0.0);
    double highest = 0.0;
    for (int k = 1; k <= 40000; ++k)
    {
      const double found = line.step(std::sin(2.0 * kPi * frequency * k * 1e-4), 1e-4);
      if (k > 20000)
        highest = std::max(highest, found);
    }
    const double ratio = frequency / 15.0;
    const double gain = 1.0 / std::hypot(1.0 - ratio * ratio, 2.0 * 0.3 * ratio);
    EXPECT_NEAR(highest / gain, 1.0, 0.002) << frequency;
  }
}

TEST(PressureLine, ConvergesWithTheSquareOfTheStep)
{
  const auto readingAfter = [](double step)
  {
    PressureLine line(10.0, 0.25, 0.0);
    for (int k = 1; k <= static_cast<int>(std::lround(0.1 / step)); ++k)
      line.step(std::sin(20.0 * k * step), step);
    return line.reading();
  };
  const double exact = readingAfter(1e-6);
  const double order = std::log2(std::abs(readingAfter(2e-3) - exact) / std::abs(readingAfter(1e-3) - exact));
  EXPECT_NEAR(order, 2.0, 0.1);
}

TEST(PressureLine, RefusesALineWithoutDamping)
{
  EXPECT_THROW(PressureLine(15.0, 0.0, 0.0), std::invalid_argument);
  EXPECT_THROW(PressureLine(-1.0, 0.3, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::flow
