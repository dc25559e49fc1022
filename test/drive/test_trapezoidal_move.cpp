#include "drive/trapezoidal_move.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::drive
{
namespace
{

TEST(TrapezoidalMove, TakesTheTimeOfTheClosedFormBetweenTwoRests)
{
  const double speed = 0.1;
  const double acceleration = 2.0;
  const double ramps = speed * speed / acceleration;  // distance of the two ramps
  const TrapezoidalMove far(0.2, 0.0, 0.05, speed, acceleration);
  EXPECT_NEAR(far.duration(), 0.15 / speed + speed / acceleration, 1e-12);
  const TrapezoidalMove near(0.2, 0.0, 0.2 + 0.3 * ramps, speed, acceleration);
  EXPECT_NEAR(near.duration(), 2.0 * std::sqrt(0.3 * ramps / acceleration), 1e-12);
  EXPECT_EQ(near.position(0.0), 0.2);
  EXPECT_EQ(near.position(near.duration()), near.goal());
}

TEST(TrapezoidalMove, KeepsItsLimitsAndEndsAtTheGoalFromAnyStart)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 300; ++trial)
  {
    const double speed = 0.1 + 0.09 * uniform(random);
    const double acceleration = 1.0 + 0.9 * uniform(random);
    const double start = 0.3 * uniform(random);
    const double initial = 1.5 * speed * uniform(random);
    const double goal = trial % 10 == 0 ? start : 0.3 * uniform(random);
    const TrapezoidalMove move(start, initial, goal, speed, acceleration);
    const int steps = 4000;
    const double dt = move.duration() / steps;
    double position = start;
    EXPECT_EQ(move.position(0.0), start);
    EXPECT_NEAR(move.velocity(0.0), dt > 0.0 ? initial : 0.0, 1e-12);
    for (int k = 1; k <= steps; ++k)
    {
      const double before = move.velocity((k - 1) * dt);
      const double now = move.velocity(k * dt);
      EXPECT_LE(std::abs(now), std::max(speed, std::abs(initial)) * (1.0 + 1e-9));
      EXPECT_LE(std::abs(now - before), acceleration * dt * (1.0 + 1e-6) + 1e-12);
      position += 0.5 * (before + now) * dt;  // the velocity is piecewise linear
      EXPECT_NEAR(move.position(k * dt), position, acceleration * dt * dt + 1e-9);
    }
    EXPECT_EQ(move.position(move.duration()), goal);
    EXPECT_EQ(move.velocity(move.duration()), 0.0);
  }
}

TEST(TrapezoidalMove, TurnsBackWhereItCannotStopBeforeTheGoal)
{
  const TrapezoidalMove move(0.0, 0.1, 0.001, 0.1, 1.0);  // needs 5 mm to stop
  double furthest = 0.0;
  for (double t = 0.0; t < move.duration(); t += 1e-4)
    furthest = std::max(furthest, move.position(t));
  EXPECT_NEAR(furthest, 0.005, 1e-7);
}

TEST(TrapezoidalMove, OfNoDistanceIsOverAtOnce)
{
  EXPECT_EQ(TrapezoidalMove(0.2, 0.0, 0.2, 0.1, 1.0).duration(), 0.0);
  EXPECT_EQ(TrapezoidalMove(0.2).position(0.0), 0.2);
}

}  // namespace
}  // namespace endovascular_sim::drive
