#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

/** Force of the hand that withdraws a wire with a force F across its tip from a straight catheter [N], in ten parts of
 * an edge. */
std::vector<double> forcesOfAPressedMouth(double friction, double edge)
{
  CoaxialCase at;
  at.angle = 0.0;
  at.tip_tension = 0.0;
  at.tip_across = 0.1;
  at.friction = friction;
  at.edge = edge;
  CoaxialPair pair(at);
  pair.move(-2e-3);
  std::vector<double> forces;
  for (int part = 0; part < 10; ++part)
    forces.push_back(-pair.move(-0.1 * edge));
  return forces;
}

// The moment M at the mouth is borne by a pair of forces at the distance d at which the wire crosses the bore:
// 2 c = M d²/(6 B). The part of a node's cell that the catheter covers changes while the wire slides; the load does
// not.
TEST(CoaxialFriction, TheMouthOfTheCatheterHasTheFrictionOfAPairOfForcesWhereverItLiesBetweenTwoNodes)
{
  const CoaxialCase at;
  for (const double edge : {1e-3, 2e-3})
  {
    const std::vector<double> rough = forcesOfAPressedMouth(0.2, edge);
    const std::vector<double> smooth = forcesOfAPressedMouth(1e-9, edge);
    for (std::size_t part = 0; part < rough.size(); ++part)
    {
      const double beyond = 0.018 - 0.1 * edge * static_cast<double>(part + 1);
      const double moment = 0.1 * beyond;
      const double distance = std::sqrt(12.0 * at.clearance * at.bending_stiffness / moment);
      const double friction = 0.2 * (0.1 + 2.0 * moment / distance);
      EXPECT_NEAR(rough[part] - smooth[part], friction, 0.2 * friction) << edge << " " << part;
    }
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
