#include "benchmark/reference/equilibrium.h"

#include <random>

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kEi = 4.9469e-5;  // bending stiffness [N·m²]
constexpr double kLength = 0.38;
constexpr double kRadius = 1.8e-4;
constexpr double kDensity = 7900.0;

/** Straight clamped wire along x; the clamp acts at the origin. */
EquilibriumProblem cantilever(int nodes)
{
  EquilibriumProblem problem;
  problem.rod =
      rod::discretiseUniformly(rod::uniformWire(rod::clampedLength(kLength, nodes), kEi, kRadius, kDensity), nodes);
  problem.held.assign(static_cast<std::size_t>(nodes), false);
  problem.held[0] = problem.held[1] = true;
  problem.force.assign(static_cast<std::size_t>(nodes), Eigen::Vector3d::Zero());
  return problem;
}

Equilibrium straightGuess(const EquilibriumProblem& problem, const Eigen::Vector3d& origin)
{
  Equilibrium guess;
  for (const double s : problem.rod.position)
    guess.position.push_back(origin + s * Eigen::Vector3d::UnitX());
  return guess;
}

rod::Section unitSection(double length, double bending_stiffness, double torsional_stiffness)
{
  rod::Section section;
  section.length = length;
  section.bending_stiffness = bending_stiffness;
  section.torsional_stiffness = torsional_stiffness;
  section.axial_stiffness = 1e6;
  section.radius = 1e-3;
  section.density = 1.0;
  return section;
}

/** Largest distance between the nodes of the time-stepping scheme at rest and those of the solver, over the length. */
double distanceToStepper(const EquilibriumProblem& problem, const rod::Wire& wire, const rod::Environment& environment,
                         const rod::StepInput& input)
{
  const int nodes = problem.nodes();
  rod::StepperSettings settings;
  settings.max_iterations = 40;
  settings.strain_tolerance = 1e-12;
  const rod::Boundary boundary = rod::clampAtOrigin(kLength, nodes);
  rod::KktStepper stepper(rod::discretiseUniformly(wire, nodes), boundary, environment, settings);
  rod::State state = stepper.initialState(0.0, 0.0);
  EXPECT_GE(rod::settle(stepper, state, input, 0.02, 1e-11, 40000), 0);
  Equilibrium rest = straightGuess(problem, boundary.origin);
  EXPECT_TRUE(EquilibriumSolver(problem).solve(rest));
  double worst = 0.0;
  for (int i = 0; i < nodes; ++i)
    worst = std::max(worst, (rest.position[i] - state.position[i]).norm());
  return worst / kLength;
}

TEST(Equilibrium, EqualsTheTimeSteppingSchemeAtRestUnderGravity)
{
  EquilibriumProblem problem = cantilever(100);
  rod::Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
  environment.damping = 30.0;
  for (int i = 0; i < 100; ++i)
    problem.force[i] = problem.rod.mass[i] * environment.gravity;
  EXPECT_LT(distanceToStepper(problem, rod::uniformWire(rod::clampedLength(kLength, 100), kEi, kRadius, kDensity),
                              environment, rod::StepInput()),
            1e-8);
}

TEST(Equilibrium, EqualsTheTimeSteppingSchemeAtRestUnderSpatialForces)
{
  EquilibriumProblem problem = cantilever(60);
  rod::Environment environment;
  environment.damping = 30.0;
  rod::StepInput input;
  const double unit = kEi / (kLength * kLength);
  input.forces = {{30, Eigen::Vector3d(0.0, 4.0 * unit, 2.0 * unit)}, {59, Eigen::Vector3d(0.0, -unit, -3.0 * unit)}};
  for (const rod::NodalForce& load : input.forces)
    problem.force[load.node] = load.force;
  EXPECT_LT(distanceToStepper(problem, rod::uniformWire(rod::clampedLength(kLength, 60), kEi, kRadius, kDensity),
                              environment, input),
            1e-8);
}

TEST(Equilibrium, EqualsTheTimeSteppingSchemeAtRestWithAPlanarPreCurvedTip)
{
  const int nodes = 60;
  rod::Wire wire = rod::uniformWire(0.7 * rod::clampedLength(kLength, nodes), kEi, kRadius, kDensity);
  wire.sections.push_back(wire.sections[0]);
  wire.sections[1].length = 0.3 * rod::clampedLength(kLength, nodes);
  wire.sections[1].rest_curvature = Eigen::Vector2d(8.0, 0.0);
  EquilibriumProblem problem = cantilever(nodes);
  problem.rod = rod::discretiseUniformly(wire, nodes);
  rod::Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
  environment.damping = 30.0;
  for (int i = 0; i < nodes; ++i)
  {
    problem.force[i] = problem.rod.mass[i] * environment.gravity;
    // ω̄1 d2 with d1 = y and a planar tangent points along z.
    problem.rest_binormal.emplace_back(0.0, 0.0, problem.rod.rest_curvature[i].x());
  }
  EXPECT_LT(distanceToStepper(problem, wire, environment, rod::StepInput()), 1e-8);
}

class TwistedRod : public testing::Test
{
protected:
  /** Open wire with both ends fixed, or a ring, far from equilibrium, with arbitrary tensions and torque. */
  void prepare(bool closed)
  {
    const int nodes = 9;
    const rod::Section section = unitSection(closed ? 9.0 : 8.0, 1.3, 0.7);
    rod::Wire wire;
    wire.sections = {section};
    problem.rod = closed ? discretiseRing(section, nodes) : rod::discretiseUniformly(wire, nodes);
    problem.held.assign(nodes, false);
    if (!closed)
      for (const int i : {0, 1, nodes - 2, nodes - 1})
        problem.held[i] = true;
    problem.twist_held = true;
    problem.twist = 1.7;
    problem.force.assign(nodes, Eigen::Vector3d(0.1, -0.2, 0.05));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-0.2, 0.2);
    for (int i = 0; i < nodes; ++i)
    {
      const double angle = 2.0 * M_PI * i / nodes;
      const Eigen::Vector3d regular =
          closed ? Eigen::Vector3d(1.43 * std::cos(angle), 1.43 * std::sin(angle), 0.0) : Eigen::Vector3d(i, 0.0, 0.0);
      e.position.push_back(regular + Eigen::Vector3d(uniform(random), uniform(random), uniform(random)));
    }
    for (int j = 0; j < problem.edges(); ++j)
      e.tension.push_back(uniform(random));
  }

  void expectDerivatives()
  {
    const EquilibriumSolver solver(problem);
    e.transport = solver.transport(e);
    e.torque = (problem.twist + e.transport) / solver.torsionalCompliance();
    const Eigen::VectorXd gradient = solver.forces(e);
    const Eigen::MatrixXd hessian(solver.hessian(e));
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 3 * problem.nodes(); ++k)
    {
      if (problem.held[k / 3])
        continue;
      Equilibrium up = e;
      Equilibrium down = e;
      up.position[k / 3][k % 3] += kStep;
      down.position[k / 3][k % 3] -= kStep;
      EXPECT_NEAR((lagrangian(solver, up) - lagrangian(solver, down)) / (2.0 * kStep), gradient[k], 1e-8) << k;
      EXPECT_NEAR((solver.transport(up) - solver.transport(down)) / (2.0 * kStep), solver.transportGradient(e)[k], 1e-8)
          << k;
      const Eigen::VectorXd column = (solver.forces(up) - solver.forces(down)) / (2.0 * kStep);
      for (int row = 0; row < 3 * problem.nodes(); ++row)
        if (!problem.held[row / 3])
        {
          EXPECT_NEAR(column[row], hessian(row, k), 1e-7) << row << ", " << k;
        }
    }
  }

  double lagrangian(const EquilibriumSolver& solver, const Equilibrium& x) const
  {
    double sum = solver.potential(x);
    for (int j = 0; j < problem.edges(); ++j)
      sum += x.tension[j] * (x.position[(j + 1) % problem.nodes()] - x.position[j]).norm();
    return sum;
  }

  EquilibriumProblem problem;
  Equilibrium e;
};

TEST_F(TwistedRod, DerivativesOfAnOpenWireFixedAtBothEndsEqualFiniteDifferences)
{
  prepare(false);
  expectDerivatives();
}

TEST_F(TwistedRod, DerivativesOfARingEqualFiniteDifferences)
{
  prepare(true);
  expectDerivatives();
}

/** Critical twist of a ring of unit stiffnesses and length 2π. */
double criticalTwist(int nodes)
{
  EquilibriumProblem problem;
  problem.rod = discretiseRing(unitSection(2.0 * M_PI, 1.0, 1.0), nodes);
  problem.twist_held = true;
  const double radius = problem.rod.rest_length[0] / (2.0 * std::sin(M_PI / nodes));
  Equilibrium ring;
  for (int i = 0; i < nodes; ++i)
    ring.position.emplace_back(radius * std::cos(2.0 * M_PI * i / nodes), radius * std::sin(2.0 * M_PI * i / nodes),
                               0.0);
  for (int axis = 0; axis < 3; ++axis)
    problem.supports.push_back({0, Eigen::Vector3d::Unit(axis)});
  problem.supports.push_back({nodes / 2, Eigen::Vector3d::UnitY()});
  problem.supports.push_back({nodes / 2, Eigen::Vector3d::UnitZ()});
  problem.supports.push_back({nodes / 4, Eigen::Vector3d::UnitZ()});
  EquilibriumSolver solver(problem);
  double stable = 8.0;
  double unstable = 14.0;
  for (int k = 0; k < 20; ++k)
  {
    solver.problem().twist = 0.5 * (stable + unstable);
    Equilibrium rest = ring;
    EXPECT_TRUE(solver.solve(rest));
    EXPECT_NEAR(rest.torque, solver.problem().twist / (2.0 * M_PI), 1e-9);
    for (const double reaction : rest.reaction)
      EXPECT_NEAR(reaction, 0.0, 1e-9);
    (solver.stiffness(rest)[0] < 0.0 ? unstable : stable) = solver.problem().twist;
  }
  return 0.5 * (stable + unstable);
}

// Michell: Θc = 2π√3·EI/GJ = 10.8827961854; discrete rods of 32 and 64 nodes.
TEST(Equilibrium, CriticalTwistOfARingConvergesToMichellsWithSecondOrder)
{
  const double exact = 2.0 * M_PI * std::sqrt(3.0);
  const double coarse = criticalTwist(32) / exact;
  const double fine = criticalTwist(64) / exact;
  EXPECT_NEAR(coarse, 1.0309891404762368, 1e-5);
  EXPECT_NEAR(fine, 1.0076591830433923, 1e-5);
  EXPECT_NEAR(std::log2((coarse - 1.0) / (fine - 1.0)), 2.0, 0.05);
}

/** Deflection and axial force (PL²/EI) of a unit wire shortened by a tenth of its length; the clamps act at the centres
 * of the end edges. */
Eigen::Vector2d clampedPostBuckling(int nodes)
{
  constexpr double kShortening = 0.1;
  const double edge = 1.0 / (nodes - 2);
  rod::Wire wire;
  wire.sections = {unitSection(edge * (nodes - 1), 1.0, 1.0)};
  EquilibriumProblem problem;
  problem.rod = rod::discretiseUniformly(wire, nodes);
  problem.held.assign(static_cast<std::size_t>(nodes), false);
  problem.held[0] = problem.held[1] = problem.held[nodes - 2] = problem.held[nodes - 1] = true;
  // Fixing the centre selects one of the equivalent buckling planes of an isotropic wire.
  problem.supports.push_back({nodes / 2, Eigen::Vector3d::UnitZ()});
  Equilibrium guess;
  for (int i = 0; i < nodes; ++i)
  {
    const double s = std::min(1.0, std::max(0.0, (i - 0.5) * edge));
    guess.position.emplace_back((1.0 - kShortening) * s, 0.1 * (1.0 - std::cos(2.0 * M_PI * s)), 0.0);
  }
  guess.position.front().x() = -0.5 * edge;
  guess.position[1].x() = 0.5 * edge;
  guess.position[nodes - 2].x() = 1.0 - kShortening - 0.5 * edge;
  guess.position.back().x() = 1.0 - kShortening + 0.5 * edge;
  for (const int i : {0, 1, nodes - 2, nodes - 1})
    guess.position[i].y() = 0.0;
  const EquilibriumSolver solver(problem);
  EXPECT_TRUE(solver.solve(guess));
  EXPECT_NEAR(guess.reaction[0], 0.0, 1e-9);
  EXPECT_GT(solver.stiffness(guess)[0], 0.0);
  const Eigen::VectorXd forces = solver.forces(guess);
  return {guess.position[nodes / 2].y(), forces[0] + forces[3]};
}

// Elastica, clamped ends, end shortening 0.1.
TEST(Equilibrium, PostBucklingOfAClampedWireConvergesWithSecondOrder)
{
  const Eigen::Vector2d exact(0.19492431137557378, 41.57025579315579);
  const Eigen::Vector2d coarse = clampedPostBuckling(41) - exact;
  const Eigen::Vector2d fine = clampedPostBuckling(81) - exact;
  const double order = std::log(79.0 / 39.0) / std::log(2.0);
  EXPECT_NEAR(std::log2(coarse[0] / fine[0]) / order, 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse[1] / fine[1]) / order, 2.0, 0.1);
  EXPECT_LT(std::abs(fine[0]), 1e-3);
  EXPECT_LT(std::abs(fine[1]), 0.1);
}

/** Deflection and axial force (PL²/EI) of a unit wire with pinned ends, shortened by a tenth of its length. */
Eigen::Vector2d pinnedPostBuckling(int nodes)
{
  rod::Wire wire;
  wire.sections = {unitSection(1.0, 1.0, 1.0)};
  EquilibriumProblem problem;
  problem.rod = rod::discretiseUniformly(wire, nodes);
  problem.held.assign(static_cast<std::size_t>(nodes), false);
  problem.held[0] = problem.held[nodes - 1] = true;
  problem.supports.push_back({nodes / 2, Eigen::Vector3d::UnitZ()});
  Equilibrium guess;
  for (const double s : problem.rod.position)
    guess.position.emplace_back(0.9 * s, 0.2 * std::sin(M_PI * s), 0.0);
  guess.position.back().y() = 0.0;
  const EquilibriumSolver solver(problem);
  EXPECT_TRUE(solver.solve(guess));
  EXPECT_NEAR(guess.reaction[0], 0.0, 1e-9);
  return {guess.position[nodes / 2].y(), solver.forces(guess)[0]};
}

// Elastica, pinned ends, end shortening 0.1.
TEST(Equilibrium, PostBucklingOfAPinnedWireConvergesWithSecondOrder)
{
  const Eigen::Vector2d exact(0.19492431137557378, 10.392563948288947);
  const Eigen::Vector2d coarse = pinnedPostBuckling(41) - exact;
  const Eigen::Vector2d fine = pinnedPostBuckling(81) - exact;
  EXPECT_NEAR(std::log2(coarse[0] / fine[0]), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse[1] / fine[1]), 2.0, 0.1);
  EXPECT_LT(std::abs(fine[0]), 1e-3);
  EXPECT_LT(std::abs(fine[1]), 0.02);
}

TEST(Equilibrium, RejectsInconsistentProblems)
{
  EquilibriumProblem problem = cantilever(10);
  problem.twist_held = true;
  EXPECT_THROW(EquilibriumSolver{problem}, InputError);
  problem.twist_held = false;
  problem.force.resize(3);
  EXPECT_THROW(EquilibriumSolver{problem}, InputError);
}

TEST(Equilibrium, ReportsAProblemWithoutSolution)
{
  EquilibriumProblem problem = cantilever(10);
  problem.held[8] = problem.held[9] = true;
  Equilibrium guess = straightGuess(problem, Eigen::Vector3d::Zero());
  for (const int i : {8, 9})
    guess.position[i].x() += 0.2 * kLength;  // beyond the length of the wire
  EXPECT_FALSE(EquilibriumSolver(problem).solve(guess));
}

}  // namespace
}  // namespace endovascular_sim::benchmark
