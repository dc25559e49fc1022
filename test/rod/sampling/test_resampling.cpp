#include "rod/sampling/resampling.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "rod/energy/energy_audit.h"
#include "rod/model/node_curvature.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLength = 0.060;

Wire twoSections()
{
  Wire wire = uniformWire(0.4 * kLength + 0.3e-3, 2e-4, 4e-4, 6450.0);
  wire.sections.push_back(uniformWire(0.6 * kLength - 0.3e-3, 5e-5, 4e-4, 12000.0).sections.front());
  return wire;
}

std::vector<double> coarsePositions(int edges)
{
  std::vector<double> position;
  for (int i = 0; i <= edges; ++i)
    position.push_back(kLength * (static_cast<double>(i) / edges));
  return position;
}

/** Positions with the edges of the given indices split. */
std::vector<double> halved(const std::vector<double>& position, const std::vector<int>& edges)
{
  std::vector<double> result;
  for (std::size_t i = 0; i < position.size(); ++i)
  {
    result.push_back(position[i]);
    if (std::find(edges.begin(), edges.end(), static_cast<int>(i)) != edges.end())
      result.push_back(0.5 * (position[i] + position[i + 1]));
  }
  return result;
}

/** A helix-like curve, parametrised nearly by arc length. */
Eigen::Vector3d curve(double s)
{
  const double radius = 0.015;
  const double angle = s / std::hypot(radius, 4e-3);
  return {radius * std::cos(angle), radius * std::sin(angle), 4e-3 * angle};
}

/** State whose members differ from node to node. */
State wildState(const Discretisation& rod)
{
  State state;
  for (int i = 0; i < rod.nodes(); ++i)
  {
    const double s = rod.position[i];
    state.position.push_back(curve(s));
    state.velocity.emplace_back(0.03 * std::cos(70.0 * s), 0.02 * std::sin(90.0 * s), 0.01 + s);
    state.wall_force.push_back(i % 4 == 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                          : Eigen::Vector3d(0.1 * std::sin(200.0 * s), 0.05, 0.3 * s));
    state.friction_coefficient.push_back(0.1);
    state.wall_offset.push_back(0.0);
    state.curvature_offset.emplace_back(Eigen::Vector3d::Zero());
    state.friction_stretch.push_back(Eigen::Vector3d(1e-7 * i, 0.0, 0.0));
  }
  for (int j = 0; j + 1 < rod.nodes(); ++j)
  {
    state.tension.push_back(0.5 * std::cos(100.0 * rod.position[j]));
    state.twist_angle.push_back(0.3 * std::sin(60.0 * rod.position[j]));
  }
  return state;
}

Eigen::Vector3d momentum(const Discretisation& rod, const State& state)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < rod.nodes(); ++i)
    sum += rod.mass[i] * state.velocity[i];
  return sum;
}

double bendingEnergy(const Discretisation& rod, const State& state)
{
  double sum = 0.0;
  for (int i = 1; i + 1 < rod.nodes(); ++i)
    sum += 0.5 * rod.bending_stiffness[i] / rod.cell_length[i] * binormalAt(rod, state, i).value.squaredNorm();
  return sum;
}

Eigen::Vector3d sumOf(const std::vector<Eigen::Vector3d>& vectors)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vector : vectors)
    sum += vector;
  return sum;
}

/** Wire in two samplings, and a state of the first. */
struct Bench
{
  explicit Bench(const std::vector<int>& split)
    : coarse(discretise(wire, coarsePositions(40))), fine(discretise(wire, halved(coarse.position, split)))
  {
  }
  Wire wire = twoSections();
  Discretisation coarse;
  Discretisation fine;
  Resampling resampling;
};

TEST(Resampling, AMergeRestoresTheStateBeforeTheSplit)
{
  for (const std::vector<int>& split : {std::vector<int>{7}, {0, 1, 16, 17, 18, 39}, {15, 16, 17}})
  {
    Bench bench(split);
    const State before = wildState(bench.coarse);
    State state = before;
    bench.resampling.carry(bench.wire, bench.coarse, bench.fine, state);
    ASSERT_EQ(static_cast<int>(state.position.size()), bench.fine.nodes());
    ASSERT_EQ(static_cast<int>(state.tension.size()), bench.fine.nodes() - 1);
    bench.resampling.carry(bench.wire, bench.fine, bench.coarse, state);
    ASSERT_EQ(state.position.size(), before.position.size());
    for (std::size_t i = 0; i < before.position.size(); ++i)
    {
      EXPECT_EQ(state.position[i], before.position[i]);
      EXPECT_LT((state.velocity[i] - before.velocity[i]).norm(), 1e-16) << i;
      EXPECT_LT((state.wall_force[i] - before.wall_force[i]).norm(), 1e-15) << i;
      EXPECT_EQ(state.friction_coefficient[i], before.friction_coefficient[i]);
    }
    for (std::size_t j = 0; j < before.tension.size(); ++j)
    {
      EXPECT_EQ(state.tension[j], before.tension[j]);
      EXPECT_NEAR(state.twist_angle[j], before.twist_angle[j], 1e-15);
    }
  }
}

TEST(Resampling, ConservesMassMomentumAndWallForceInSplitsAndMerges)
{
  Bench bench({0, 3, 4, 16, 17, 30, 39});
  State state = wildState(bench.coarse);
  const Eigen::Vector3d first_momentum = momentum(bench.coarse, state);
  const Eigen::Vector3d first_force = sumOf(state.wall_force);
  double coarse_mass = 0.0;
  double fine_mass = 0.0;
  for (const double mass : bench.coarse.mass)
    coarse_mass += mass;
  for (const double mass : bench.fine.mass)
    fine_mass += mass;
  EXPECT_NEAR(fine_mass, coarse_mass, 1e-15 * coarse_mass);
  bench.resampling.carry(bench.wire, bench.coarse, bench.fine, state);
  EXPECT_LT((momentum(bench.fine, state) - first_momentum).norm(), 1e-14 * first_momentum.norm());
  EXPECT_LT((sumOf(state.wall_force) - first_force).norm(), 1e-14);
  // A state whose fine nodes have other velocities than their neighbours.
  for (std::size_t i = 0; i < state.velocity.size(); ++i)
  {
    state.velocity[i] += 0.02 * Eigen::Vector3d(std::sin(5.0 * i), std::cos(3.0 * i), 0.3);
    state.wall_force[i] += 0.1 * Eigen::Vector3d(std::cos(7.0 * i), 0.2, std::sin(2.0 * i));
  }
  const Eigen::Vector3d second_momentum = momentum(bench.fine, state);
  const Eigen::Vector3d second_force = sumOf(state.wall_force);
  bench.resampling.carry(bench.wire, bench.fine, bench.coarse, state);
  EXPECT_LT((momentum(bench.coarse, state) - second_momentum).norm(), 1e-14 * second_momentum.norm());
  EXPECT_LT((sumOf(state.wall_force) - second_force).norm(), 1e-14);
}

Eigen::Vector3d bentCurvature(const Discretisation& rod, const State& state, int node)
{
  return (binormalAt(rod, state, node).value - state.curvature_offset[node]) / rod.cell_length[node];
}

TEST(Resampling, KeepsTheMomentOfEveryNodeAndGivesANewNodeTheMeanOfItsNeighbours)
{
  Bench bench({2, 9, 16, 17, 25});
  State state = wildState(bench.coarse);
  // A kink, as at a contact: the arc through it has another curvature.
  state.position[10] += Eigen::Vector3d(2e-5, 1e-5, 0.0);
  const State before = state;
  bench.resampling.carry(bench.wire, bench.coarse, bench.fine, state);
  int k = 0;
  double offsets = 0.0;
  for (int i = 1; i + 1 < bench.coarse.nodes(); ++i)
  {
    while (bench.fine.position[k] < bench.coarse.position[i])
      ++k;
    const Eigen::Vector3d here = bentCurvature(bench.coarse, before, i);
    EXPECT_LT((bentCurvature(bench.fine, state, k) - here).norm(), 1e-9 * here.norm()) << i;
    offsets += state.curvature_offset[k].norm();
    if (k == 0 || bench.fine.position[k - 1] == bench.coarse.position[i - 1] || i == 1)
      continue;
    const Eigen::Vector3d mean = 0.5 * (bentCurvature(bench.coarse, before, i - 1) + here);
    EXPECT_LT((bentCurvature(bench.fine, state, k - 1) - mean).norm(), 1e-9 * mean.norm()) << i;
  }
  EXPECT_GT(offsets, 1e-3);
  State merged = state;
  bench.resampling.carry(bench.wire, bench.fine, bench.coarse, merged);
  for (int i = 1; i + 1 < bench.coarse.nodes(); ++i)
    EXPECT_LT(merged.curvature_offset[i].norm(), 1e-12) << i;
}

TEST(Resampling, KineticEnergyDoesNotGrowInSplitsAndGrowsInMergesByTheirLossOnly)
{
  Bench bench({2, 9, 16, 25});
  State state = wildState(bench.coarse);
  const double before = kineticEnergy(bench.coarse, state);
  bench.resampling.carry(bench.wire, bench.coarse, bench.fine, state);
  EXPECT_LE(kineticEnergy(bench.fine, state), before);
  bench.resampling.carry(bench.wire, bench.fine, bench.coarse, state);
  EXPECT_LE(kineticEnergy(bench.coarse, state), before * (1.0 + 1e-14));
}

TEST(Resampling, ChangesTheBendingEnergyOfAResolvedCurveByLessThanOnePercent)
{
  // κh = 0.1: an edge close to a split.
  for (const std::vector<int>& split : {std::vector<int>{20}, {19, 20, 21}, {10, 20, 30}})
  {
    Bench bench(split);
    bench.wire = uniformWire(kLength, 2e-4, 4e-4, 6450.0);
    bench.coarse = discretise(bench.wire, bench.coarse.position);
    bench.fine = discretise(bench.wire, bench.fine.position);
    State state = wildState(bench.coarse);
    const double before = bendingEnergy(bench.coarse, state);
    bench.resampling.carry(bench.wire, bench.coarse, bench.fine, state);
    // Energy of the changed cells. A node on the chord would raise it by a third.
    const double share = 3.0 * static_cast<double>(split.size()) / bench.coarse.nodes();
    EXPECT_LT(std::abs(bendingEnergy(bench.fine, state) - before), 0.01 * share * before);
  }
}

TEST(Resampling, PlacesANewNodeOnTheCurveToFourthOrder)
{
  double previous = 0.0;
  for (const int edges : {20, 40, 80})
  {
    const Wire wire = uniformWire(kLength, 2e-4, 4e-4, 6450.0);
    const Discretisation coarse = discretise(wire, coarsePositions(edges));
    const Discretisation fine = discretise(wire, halved(coarse.position, {edges / 2}));
    State state = wildState(coarse);
    Resampling().carry(wire, coarse, fine, state);
    const double error = (state.position[edges / 2 + 1] - curve(fine.position[edges / 2 + 1])).norm();
    if (previous > 0.0)
    {
      EXPECT_NEAR(std::log2(previous / error), 4.0, 0.2);
    }
    previous = error;
  }
}

TEST(Resampling, RejectsUnrelatedSamplings)
{
  const Wire wire = twoSections();
  const Discretisation forty = discretise(wire, coarsePositions(40));
  State state = wildState(forty);
  EXPECT_THROW(Resampling().carry(wire, forty, discretise(wire, coarsePositions(30)), state), std::logic_error);
}

TEST(KktStepper, ContinuesAfterResamplingAsWithoutIt)
{
  // A heavy cantilever at rest: its tip stays at rest after a split and after the merge.
  const Wire wire = uniformWire(0.1, 2e-4, 4e-4, 6450.0);
  std::vector<double> position;
  for (int i = 0; i <= 80; ++i)
    position.push_back(0.1 * i / 80.0);
  const Discretisation coarse = discretise(wire, position);
  std::vector<double> with_halves;
  for (int i = 0; i < 80; ++i)
  {
    with_halves.push_back(position[i]);
    if (i >= 20 && i < 50)
      with_halves.push_back(0.5 * (position[i] + position[i + 1]));
  }
  with_halves.push_back(position.back());
  const Discretisation fine = discretise(wire, with_halves);
  Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, 0.0, -300.0);
  environment.damping = 40.0;
  KktStepper stepper(coarse, clampAtOrigin(0.1, 81), environment, StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  ASSERT_GT(settle(stepper, state, StepInput(), 5e-3, 1e-8, 4000), 0);
  const Eigen::Vector3d tip = state.position.back();
  const double energy = stepper.energy(state).bending;
  Resampling resampling;
  PhaseTimer timer;
  const Discretisation* rods[] = {&coarse, &fine, &coarse};
  for (int change = 1; change < 3; ++change)
  {
    resampling.carry(wire, *rods[change - 1], *rods[change], state);
    ASSERT_TRUE(stepper.resample(*rods[change]));
    for (int k = 0; k < 200; ++k)
    {
      std::uint32_t pass = 0;
      const StepReport report = stepper.step(state, StepInput(), 5e-3, pass, nullptr, timer);
      ASSERT_TRUE(report.solved);
      EXPECT_LT(report.max_strain, 5e-5);
      EXPECT_LT((state.position.back() - tip).norm(), 2e-5);
    }
    EXPECT_NEAR(stepper.energy(state).bending, energy, 2e-3 * energy);
  }
  EXPECT_LT((state.position.back() - tip).norm(), 1e-7);
}

}  // namespace
}  // namespace endovascular_sim::rod
