#include "results/smoothness.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::results
{
namespace
{

/** Speed of a minimum-jerk movement, divided into @p parts with a stop after each. */
std::vector<double> movement(int parts)
{
  std::vector<double> speed;
  for (int k = 0; k < 200; ++k)
  {
    const double t = std::fmod(static_cast<double>(k) / 200.0 * parts, 1.0);
    speed.push_back(30.0 * t * t * (1.0 - t) * (1.0 - t));
  }
  return speed;
}

TEST(SpectralArcLength, MatchesTheReferenceImplementation)
{
  // Example of the authors' sparc(): exp(-5 t²), t from -1 to 1 in steps of 0.01.
  std::vector<double> speed;
  for (int k = 0; k < 200; ++k)
    speed.push_back(std::exp(-5.0 * std::pow(-1.0 + 0.01 * k, 2)));
  EXPECT_NEAR(spectralArcLength(speed, 100.0), -1.41403, 1e-5);
}

TEST(SpectralArcLength, DecreasesWithEachStop)
{
  EXPECT_GT(spectralArcLength(movement(1), 200.0), spectralArcLength(movement(2), 200.0) + 0.2);
  EXPECT_GT(spectralArcLength(movement(2), 200.0), spectralArcLength(movement(4), 200.0) + 0.2);
}

TEST(SpectralArcLength, DoesNotDependOnTheSizeOfTheMovement)
{
  std::vector<double> larger = movement(2);
  for (double& speed : larger)
    speed *= 7.0;
  EXPECT_NEAR(spectralArcLength(larger, 200.0), spectralArcLength(movement(2), 200.0), 1e-12);
}

TEST(SpectralArcLength, IsZeroWithoutMotion)
{
  EXPECT_EQ(spectralArcLength({}, 20.0), 0.0);
  EXPECT_EQ(spectralArcLength(std::vector<double>(50, 0.0), 20.0), 0.0);
}

}  // namespace
}  // namespace endovascular_sim::results
