#include <cmath>

#include <gtest/gtest.h>

#include "benchmark/sleeve/sleeve_elastica.h"
#include "benchmark/sleeve/sleeve_runs.h"

namespace endovascular_sim::benchmark
{
namespace
{

// Figures of an independent program.
TEST(SleeveElastica, ForceIsTheDerivativeOfTheEnergyAndChangesItsSign)
{
  SleeveElastica elastica;
  for (const auto& [length, force] :
       {std::pair(1.1, 14.15), std::pair(1.5, 3.52), std::pair(2.0, 0.12), std::pair(2.4, -0.64)})
  {
    elastica.moveTo(length - 1e-3);
    const double before = elastica.energy();
    elastica.moveTo(length + 1e-3);
    const double slope = (elastica.energy() - before) / 2e-3;
    elastica.moveTo(length);
    EXPECT_NEAR(elastica.handForce(), slope, 1e-4 * std::abs(slope) + 1e-5) << length;
    EXPECT_NEAR(elastica.handForce(), force, 0.006) << length;
  }
}

/** Expects the exact forces within 0.15 EI/L² + 3 %. */
void expectExact(const std::vector<SleeveForce>& found)
{
  SleeveElastica elastica;
  for (const SleeveForce& at : found)
  {
    elastica.moveTo(at.length);
    EXPECT_NEAR(at.force, elastica.handForce(), 0.15 + 0.03 * std::abs(elastica.handForce())) << at.length;
    EXPECT_LT(at.configurational, 0.0);
  }
}

SleeveMotion quickMotion()
{
  SleeveMotion motion;
  motion.time_step = 2e-3;
  motion.speed = 0.02;
  motion.lengths = {1.05, 1.1, 1.5, 1.95, 2.1, 2.4, 2.98};
  return motion;
}

TEST(Sleeve, ForceOnTheHandIsExactOnTheWayInAndOut)
{
  const SleeveCurve curve = runSleeve(quickMotion());
  expectExact(curve.in);
  expectExact(curve.out);
  for (const auto* forces : {&curve.in, &curve.out})
  {
    EXPECT_GT((*forces)[3].force, 0.0);  // at 1.95 L
    EXPECT_LT((*forces)[4].force, 0.0);  // at 2.1 L
  }
}

TEST(Sleeve, ForceOnTheHandIsExactWithShortAndLongGuides)
{
  SleeveMotion motion = quickMotion();
  motion.lengths = {1.1, 1.5, 2.0};
  for (const double guide : {12e-3, 30e-3})
  {
    motion.guide_length = guide;
    expectExact(runSleeve(motion).in);
  }
}

}  // namespace
}  // namespace endovascular_sim::benchmark
