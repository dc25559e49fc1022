#include "benchmark/reference/static_cases.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kAtRest = 1e-12;  // largest motion per step at rest [m]

double errorOf(const StaticCase& problem, const std::string& scheme, int nodes)
{
  const RestResult result = runToRest(sceneText(atRest(problem, scheme, nodes)), kAtRest, restSteps(scheme));
  EXPECT_TRUE(result.settled) << problem.name << ", " << scheme;
  return tipError(problem, result);
}

TEST(StaticCases, OfTheDiscreteRodConvergeWithSecondOrder)
{
  for (const StaticCase& problem : staticCases())
  {
    const double coarse = errorOf(problem, "kkt", 26);
    const double fine = errorOf(problem, "kkt", 51);
    // The free length has 24.5 and 49.5 edges.
    EXPECT_NEAR(std::log(coarse / fine) / std::log(49.5 / 24.5), 2.0, 0.1) << problem.name;
  }
}

TEST(StaticCases, OfTheMixedRodConvergeWithFourthOrder)
{
  for (const StaticCase& problem : staticCases())
  {
    const double coarse = errorOf(problem, "mixed", 13);
    const double fine = errorOf(problem, "mixed", 25);
    EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.2) << problem.name;
  }
}

TEST(StaticCases, OfBothDiscreteSchemesAgree)
{
  const StaticCase problem = heavyCantilever();
  // The error of the discrete rod is 1.15e-4 with 100 edges; here it has 98.5.
  EXPECT_NEAR(errorOf(problem, "kkt", 100), 1.15e-4 * std::pow(100.0 / 98.5, 2), 0.02e-4);
  EXPECT_NEAR(errorOf(problem, "paper", 50), errorOf(problem, "kkt", 50), 1e-6);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
