#include <gtest/gtest.h>

#include <cmath>

#include "benchmark/coaxial/coaxial_runs.h"

// Friction of a wire in a catheter around a bend.

namespace endovascular_sim::benchmark
{
namespace
{

TEST(CoaxialFriction, ASoftWireUnderTensionFollowsTheCapstanFormula)
{
  for (const bool pull : {true, false})
  {
    CoaxialCase at;
    at.bending_stiffness = 1e-6;
    at.tip_tension = 0.5;
    at.pull = pull;
    const double sign = pull ? 1.0 : -1.0;
    const double expected = sign * at.tip_tension * std::exp(sign * at.friction * at.angle);
    EXPECT_NEAR(forceInCatheter(at), expected, 0.02 * std::abs(expected)) << pull;
  }
}

TEST(CoaxialFriction, TheHandForceInACatheterIsThatInARigidTube)
{
  for (const double tension : {0.0, 0.375})
    for (const bool pull : {true, false})
    {
      CoaxialCase at;
      at.angle = M_PI / 3.0;
      at.friction = 0.3;
      at.tip_tension = tension;
      at.pull = pull;
      at.edge = 1.5e-3;
      const double reference = forceInTube(at);
      EXPECT_NEAR(forceInCatheter(at), reference, 0.03 * std::abs(reference) + 2e-3) << tension << " " << pull;
    }
}

TEST(CoaxialFriction, AReversalOverTheElasticDisplacementTurnsTheFrictionAround)
{
  CoaxialCase at;
  CoaxialPair pair(at);
  pair.move(-1e-3);
  const double pulled = -pair.move(-1e-4);
  pair.move(20e-6);  // half of the way over which the friction reverses
  const double middle = -pair.move(1e-9);
  pair.move(1e-3);
  const double pushed = -pair.move(1e-4);
  EXPECT_GT(pulled, at.tip_tension * std::exp(at.friction * at.angle));
  EXPECT_LT(pushed, at.tip_tension * std::exp(-at.friction * at.angle));
  EXPECT_GT(middle, pushed + 0.3 * (pulled - pushed));
  EXPECT_LT(middle, pushed + 0.7 * (pulled - pushed));
  pair.move(-1e-3);
  EXPECT_NEAR(-pair.move(-1e-4), pulled, 0.01 * pulled);
}

TEST(CoaxialFriction, CyclesOfAnyAmplitudeTakeEnergyFromTheHands)
{
  CoaxialCase at;
  CoaxialPair pair(at);
  pair.move(-1e-3);
  for (const double amplitude : {5e-6, 15e-6, 40e-6, 3e-4})
  {
    const double before = pair.work();
    for (int cycle = 0; cycle < 3; ++cycle)
    {
      pair.move(amplitude);
      pair.move(-amplitude);
    }
    EXPECT_GT(pair.work() - before, -1e-8) << amplitude;
  }
}

}  // namespace
}  // namespace endovascular_sim::benchmark
