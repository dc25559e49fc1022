#include "benchmark/reference/reference_shapes.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "benchmark/harness/bench_run.h"
#include "benchmark/reference/equilibrium.h"

namespace endovascular_sim::benchmark
{

Buckled buckle(int nodes)
{
  const double length = 0.1;
  const double stiffness = 1e-4;
  const double edge = length / (nodes - 2);
  std::ostringstream out;
  out.precision(17);
  out << "name: buckling\nduration: 1.0e6\nvessel: none\nintroducer: false\nproximal_end: clamped\n"
      << "distal_end: {hold: clamped, displacement: {points: [[0, 0], [1, " << -0.1 * length << "]]}}\n"
      << "entry: {position: [" << -0.5 * edge << ", 0, 0], direction: [1, 0, 0], up: [0, 1, 0]}\n"
      << "instrument:\n  name: wire\n  sections:\n    - {length: " << length + edge
      << ", radius: 1.8e-4, material: steel, density: 7900, bending_stiffness: " << stiffness
      << ", poisson_ratio: 0.3}\n"
      << "loads:\n  damping: 0.0\n  point_loads:\n    - {position: " << 0.5 * (length + edge)
      << ", force: [0, 1.0e-7, 0]}\n"
      << "sampling: {kind: uniform, nodes: " << nodes << "}\n"
      << "solver: {scheme: kkt, time_step: 5.0e-3, strain_tolerance: 1.0e-7, max_newton: 30}\n";
  BenchRun run(out.str());
  const RunSummary summary = run.advance(4.0);
  const rod::State& state = run.simulation().state();
  const double scale = stiffness / (length * length);
  return {state.distal_force.x() / scale, std::abs(state.position[nodes / 2].y()) / length, summary.median_us};
}

double criticalTwist(int nodes)
{
  rod::Section section;
  section.length = 2.0 * M_PI;
  section.bending_stiffness = section.torsional_stiffness = section.density = 1.0;
  section.axial_stiffness = 1e6;
  section.radius = 1e-3;
  EquilibriumProblem problem;
  problem.rod = discretiseRing(section, nodes);
  problem.held.assign(static_cast<std::size_t>(nodes), false);
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
  for (int k = 0; k < 22; ++k)
  {
    solver.problem().twist = 0.5 * (stable + unstable);
    Equilibrium rest = ring;
    if (!solver.solve(rest))
      return NAN;
    (solver.stiffness(rest)[0] < 0.0 ? unstable : stable) = solver.problem().twist;
  }
  return 0.5 * (stable + unstable);
}

namespace
{

// Van der Heijden & Thompson: B = 1.345, C = 0.789, L = 9.29, D = 0.3, R = 27 turns, second solution.
constexpr double kB = 1.345;
constexpr double kC = 0.789;
constexpr double kSpan = 9.29;
constexpr double kShortening = 0.3;
constexpr double kTwist = 169.64600329384882;
constexpr double kCosine = 0.6069735112218482;
constexpr double kScale = 0.38165366529447636;
constexpr double kTorque = 14.252015654739456;
constexpr double kWrithe = 1.837099070110517;

double helixCosine(double s)
{
  return kCosine + (1.0 - kCosine) * std::pow(std::tanh(s / kScale), 2.0);
}

/** Analytical helix with the prescribed positions of the ends. */
std::vector<Eigen::Vector3d> helixGuess(int nodes)
{
  const double edge = kSpan / (nodes - 2);
  const int middle = nodes / 2;
  std::vector<Eigen::Vector3d> x(static_cast<std::size_t>(nodes), Eigen::Vector3d::Zero());
  // ψ' = M/(B (1 + cos φ)), integrated from the centre, where the tangent is inclined towards y.
  double azimuth = 0.0;
  for (int j = middle; j + 1 < nodes; ++j)
  {
    const double u = helixCosine((j - middle + 0.5) * edge);
    azimuth += (j == middle ? 0.5 : 1.0) * edge * kTorque / (kB * (1.0 + u));
    const double across = std::sqrt(1.0 - u * u);
    x[j + 1] = x[j] + edge * Eigen::Vector3d(u, across * std::cos(azimuth), across * std::sin(azimuth));
    // A rotation by π about z gives the other half.
    x[2 * middle - j - 1] = Eigen::Vector3d(-x[j + 1].x(), -x[j + 1].y(), x[j + 1].z());
  }
  // The ends lie on the asymptotic axis of both tails, at their prescribed distance.
  const double height = x.back().z();
  const double half = 0.5 * (kSpan - kShortening);
  const int ends[4] = {0, 1, nodes - 2, nodes - 1};
  const double positions[4] = {-half - 0.5 * edge, -half + 0.5 * edge, half - 0.5 * edge, half + 0.5 * edge};
  for (int k = 0; k < 4; ++k)
    x[ends[k]] = Eigen::Vector3d(positions[k], 0.0, height);
  return x;
}

double envelopeError(const std::vector<Eigen::Vector3d>& x)
{
  const int nodes = static_cast<int>(x.size());
  const int middle = nodes / 2;
  double worst = 0.0;
  for (int j = 0; j + 1 < nodes; ++j)
  {
    const double s = (j - middle + 0.5) * kSpan / (nodes - 2);
    const double u = (x[j + 1] - x[j]).normalized().x();
    worst = std::max(worst, std::abs(u - helixCosine(s)) / (1.0 - kCosine));
  }
  return worst;
}

}  // namespace

LocalisedHelix localisedHelix(int nodes)
{
  rod::Section section;
  section.length = kSpan * (nodes - 1) / (nodes - 2);
  section.bending_stiffness = kB;
  section.torsional_stiffness = kC;
  section.axial_stiffness = 1e6;
  section.radius = 1e-3;
  section.density = 1.0;
  rod::Wire wire;
  wire.sections = {section};
  EquilibriumProblem problem;
  problem.rod = rod::discretiseUniformly(wire, nodes);
  problem.held.assign(static_cast<std::size_t>(nodes), false);
  problem.held[0] = problem.held[1] = problem.held[nodes - 2] = problem.held[nodes - 1] = true;
  problem.twist_held = true;
  problem.twist = kTwist;
  // Fixing the centre removes the rotation about the axis and the nearly free translation along it.
  problem.supports.push_back({nodes / 2, Eigen::Vector3d::UnitY()});
  problem.supports.push_back({nodes / 2, Eigen::Vector3d::UnitX()});
  Equilibrium rest;
  rest.position = helixGuess(nodes);
  rest.transport = -kWrithe;
  rest.torque = kTorque;
  LocalisedHelix helix;
  // The reactions of these supports must vanish.
  helix.converged =
      EquilibriumSolver(problem).solve(rest) && std::abs(rest.reaction[0]) < 1e-9 && std::abs(rest.reaction[1]) < 1e-9;
  helix.envelope_error = envelopeError(rest.position);
  helix.torque_error = std::abs(rest.torque / kTorque - 1.0);
  return helix;
}

LocalisedHelix localisedHelixInSteps(int nodes)
{
  const double edge = kSpan / (nodes - 2);
  ReferenceRod rod;
  rod.length = kSpan + edge;
  rod.bending_stiffness = kB;
  rod.torsional_stiffness = kC;
  rod.radius = 1e-3;
  rod.density = 1.0 / (M_PI * rod.radius * rod.radius);
  rod.nodes = nodes;
  const std::vector<Eigen::Vector3d> guess = helixGuess(nodes);
  rod::Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = boundary.distal = rod::EndHold::kClamped;
  boundary.distal_twist_held = true;
  boundary.origin = guess[0];
  rod::StepperSettings settings;
  settings.strain_tolerance = 1e-7;
  settings.corrected_strain_ratio = 0.0;
  settings.max_iterations = 12;
  ReferenceWire wire("kkt", rod, boundary, rod::Environment(), settings);
  wire.state.position = guess;
  wire.input.distal.displacement.x() = -kShortening;
  wire.input.distal.rotation = kTwist;
  wire.state.distal = wire.input.distal;
  LocalisedHelix helix;
  helix.converged = wire.settle(0.02, true, 1e-8, 6000);
  helix.envelope_error = envelopeError(wire.state.position);
  helix.torque_error = std::abs(std::abs(wire.state.hand_torque) / kTorque - 1.0);
  helix.step_us = wire.stepTime();
  return helix;
}

}  // namespace endovascular_sim::benchmark
