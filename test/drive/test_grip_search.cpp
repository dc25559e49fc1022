#include "drive/grip_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace endovascular_sim::drive
{
namespace
{

using Forces = std::function<std::vector<double>(const std::vector<double>&)>;

struct Found
{
  std::vector<double> position;
  std::vector<double> force;
  int trials = 0;
};

Found searched(const std::vector<GrippingHand>& hands, std::vector<double> position, const Forces& forces)
{
  GripSearch search(hands);
  Found found;
  do
  {
    found.force = forces(position);
    found.position = position;
    ++found.trials;
  } while (search.improve(found.force, position));
  return found;
}

constexpr double kFar = 1.0;  // m

TEST(GripSearch, LeavesAHandWithinItsLimitWhereItIs)
{
  const Found found = searched({{5.0, -kFar, kFar, 0.0, 0.0}}, {1e-5}, [](const auto&) { return std::vector{4.9}; });
  EXPECT_EQ(found.trials, 1);
  EXPECT_EQ(found.position.front(), 1e-5);
}

TEST(GripSearch, AHandThatPushesAgainstAStopSlipsToItsLimit)
{
  for (const double stiffness : {1e3, 1e5, 1e7})
    for (const double sign : {1.0, -1.0})
    {
      const Found found = searched({{5.0, -kFar, kFar, 0.0, 0.0}}, {sign * 32e-6 * 1e6 / stiffness},
                                   [&](const auto& x) { return std::vector{stiffness * x[0]}; });
      EXPECT_GE(sign * found.force.front(), 4.9);
      EXPECT_LE(sign * found.force.front(), 5.05);
      EXPECT_LE(found.trials, 6);
    }
}

TEST(GripSearch, AHandAtRestThatIsPushedBackSlips)
{
  const Found found = searched({{5.0, -kFar, kFar, 0.2, 4.0}}, {0.2},
                               [](const auto& x) { return std::vector{9.0 + 1e5 * (x[0] - 0.2)}; });
  EXPECT_NEAR(found.force.front(), 5.0, 0.1);
  EXPECT_NEAR(found.position.front(), 0.2 - 40e-6, 1e-6);
}

TEST(GripSearch, FindsTheLimitBeforeAPoleOfTheForce)
{
  const Found found = searched({{5.0, -kFar, kFar, 0.0, 0.1}}, {30e-6},
                               [](const auto& x) { return std::vector{x[0] < 20e-6 ? 1e-6 / (20e-6 - x[0]) : 1e4}; });
  EXPECT_GE(found.force.front(), 4.9);
  EXPECT_LE(found.force.front(), 5.05);
}

TEST(GripSearch, WhereTheForceJumpsOverTheLimitTheHandStaysBeforeTheJump)
{
  const Found found = searched({{0.43, -kFar, kFar, 0.0, 0.4}}, {50e-6},
                               [](const auto& x) { return std::vector{x[0] > 1e-9 ? 0.47 + 400.0 * x[0] : 0.33}; });
  EXPECT_EQ(found.force.front(), 0.33);
  EXPECT_NEAR(found.position.front(), 0.0, 1e-6);
  EXPECT_LE(found.trials, 10);
}

TEST(GripSearch, OfTwoHandsThatFrictionCouplesNeitherBearsMoreThanItsLimit)
{
  // The wire pushes against a stop, and by its friction takes the catheter along.
  const Forces forces = [](const std::vector<double>& x)
  {
    const double friction = std::clamp(5e6 * (x[0] - x[1]), -30.0, 30.0);
    return std::vector{1e5 * x[0] + friction, 2e4 * x[1] - friction};
  };
  const Found found = searched({{5.0, -kFar, kFar, 0.0, 0.0}, {2.0, -kFar, kFar, 0.0, 0.0}}, {32e-6, 0.0}, forces);
  EXPECT_LE(std::abs(found.force[0]), 5.05);
  EXPECT_LE(std::abs(found.force[1]), 2.02);
}

TEST(GripSearch, AHandDoesNotSlipBeyondItsStop)
{
  const Found found =
      searched({{5.0, -1e-5, kFar, 0.0, 0.0}}, {0.0}, [](const auto& x) { return std::vector{9.0 + 1e5 * x[0]}; });
  EXPECT_EQ(found.position.front(), -1e-5);
}

}  // namespace
}  // namespace endovascular_sim::drive
