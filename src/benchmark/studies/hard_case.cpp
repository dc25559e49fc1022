#include "benchmark/studies/hard_case.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include <Eigen/Geometry>

#include "benchmark/harness/bench_run.h"
#include "common/error.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kTravel = 0.06;          // length of the push through the channel [m]
constexpr double kHandTurn = 59.0;        // angular speed of the handle, just below the limit of the hand [rad/s]
constexpr double kMaxStrain = 1e-3;       // largest accepted strain
constexpr double kMaxPenetration = 1e-4;  // largest accepted penetration [m]
constexpr double kEnergyShare = 0.02;     // accepted excess over the largest energy: error of the trapezoidal work
constexpr double kEnergyFloor = 1e-7;     // excess below which the energy is not evaluated [J]

double channelRadius(const HardCase& hard)
{
  return std::clamp(0.1 * hard.bend_radius, 0.8e-3, 3e-3);
}

/** Simulated time for the travel and the turns, limited by @p max_steps [s]. */
double duration(const HardCase& hard, int max_steps)
{
  const double travelling = kTravel / std::max(hard.speed, 1e-9);
  const double turning = 2.0 * M_PI * hard.turns / kHandTurn;
  const double whole = std::max({20.0 * hard.time_step, travelling, turning});
  return hard.whole ? whole : std::min(max_steps * hard.time_step, whole);
}

void writeWire(std::ostream& out, const HardCase& hard, double radius)
{
  const double tip_length = hard.tip_radius > 0.0 ? std::min(0.012, hard.tip_radius) : 0.012;
  const double density = 6450.0;
  out << "instrument:\n  name: wire\n  sections:\n"
      << "    - {length: " << 0.15 - tip_length << ", radius: " << radius << ", material: nitinol, density: " << density
      << ", bending_stiffness: " << hard.bending_stiffness << ", poisson_ratio: 0.3}\n"
      << "    - {length: " << tip_length << ", radius: " << radius << ", material: nitinol, density: " << density
      << ", bending_stiffness: " << hard.bending_stiffness / hard.stiffness_jump << ", poisson_ratio: 0.3";
  if (hard.tip_radius > 0.0)
    out << ", rest_curvature: {radius: " << hard.tip_radius << ", direction: 0}";
  out << "}\n";
}

void writeDrive(std::ostream& out, const HardCase& hard)
{
  const double time = kTravel / std::max(hard.speed, 1e-4);
  out << "drive:\n  source: script\n  initial_insertion: 0.012\n  force_limit: 20\n";
  if (hard.reverses)
    out << "  insertion: {points: [[0, 0], [" << 0.5 * time << ", " << 0.5 * kTravel << "], [" << 0.7 * time << ", "
        << 0.3 * kTravel << "], [" << 1.2 * time << ", " << 0.8 * kTravel << "]]}\n";
  else
    out << "  speed: " << hard.speed << "\n  travel: " << kTravel << "\n";
  out << "  rotation: {points: [[0, 0], [" << time << ", " << 2.0 * M_PI * hard.turns << "]]}\n";
}

/** Perturbs the simulated nodes, or folds two edges at the centre of the free part. */
void perturb(simulation::Simulation& simulation, const HardCase& hard)
{
  rod::State state = simulation.state();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-hard.perturbation, hard.perturbation);
  const int last = simulation.discretisation().nodes() - 1;
  const int inside = std::max(state.first_node + 2, last - static_cast<int>(0.5 * last));
  for (int i = inside; i <= last && hard.perturbation > 0.0; ++i)
    for (int axis = 0; axis < 3; ++axis)
      state.position[i][axis] += uniform(random);
  if (hard.fold_angle > 0.0)
  {
    const int middle = (inside + last) / 2;
    const Eigen::Vector3d before = state.position[middle] - state.position[middle - 1];
    const Eigen::Vector3d across = before.unitOrthogonal();
    const Eigen::AngleAxisd turn(M_PI - hard.fold_angle, across);
    const Eigen::Vector3d pivot = state.position[middle];
    for (int i = middle + 1; i <= last; ++i)
      state.position[i] = pivot + turn * (state.position[i] - pivot);
  }
  simulation.setState(std::move(state));
}

std::string violations(const RunSummary& summary, double energy_excess)
{
  std::string text;
  const auto add = [&text](bool wrong, const char* criterion)
  {
    if (wrong)
      text += (text.empty() ? "" : ", ") + std::string(criterion);
  };
  add(!summary.finite, "not finite");
  add(summary.nodes_outside > 0, "outside");
  add(summary.max_strain > kMaxStrain, "strain");
  add(summary.worst_penetration > kMaxPenetration, "penetration");
  add(energy_excess > kEnergyShare, "energy");
  return text;
}

Verdict verdictOf(const RunSummary& summary)
{
  Verdict verdict;
  verdict.max_strain = summary.max_strain;
  verdict.penetration = summary.worst_penetration;
  verdict.energy_excess = summary.energy_excess / std::max(summary.largest_energy, kEnergyFloor);
  verdict.solves = summary.solves;
  verdict.bisections = summary.bisections;
  verdict.truncated = summary.truncated;
  verdict.rejected = summary.rejected;
  verdict.steps = summary.steps;
  verdict.reason = violations(summary, summary.energy_excess > kEnergyFloor ? verdict.energy_excess : 0.0);
  // A wire that is held in all steps retains its initial strain.
  const bool held = summary.finite && summary.rejected > 0 && summary.rejected == summary.steps;
  verdict.word = !verdict.reason.empty() && !held ? "bad" : summary.rejected > 0 ? "rejected" : "good";
  if (verdict.word == "rejected")
    verdict.reason = std::to_string(summary.rejected) + " steps rejected, wire held";
  return verdict;
}

}  // namespace

std::string sceneText(const HardCase& hard)
{
  const double radius = channelRadius(hard);
  std::ostringstream out;
  out.precision(12);
  out << "name: hard\nduration: 1.0e6\n";
  // Free space, because a perturbed node must not lie beyond a wall.
  if (hard.perturbation > 0.0 || hard.fold_angle > 0.0)
    out << "vessel: none\nloads: {damping: 20.0}\n";
  else
    out << "vessel:\n  tube:\n    radius: " << radius << "\n    facet_length: " << 0.35 * radius
        << "\n    facets_around: 40\n    pieces:\n      - length: 0.03\n"
        << "      - {length: " << std::min(0.5 * M_PI, 0.06 / hard.bend_radius) * hard.bend_radius
        << ", curvature: " << 1.0 / hard.bend_radius << ", plane_angle: 0.3}\n      - length: 0.08\n  friction: 0.1\n";
  out << "entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}\n";
  writeWire(out, hard, std::min(4e-4, radius / 3.0));
  writeDrive(out, hard);
  out << "sampling: "
      << (hard.sampling.empty() ? "{kind: uniform, nodes: " + std::to_string(hard.nodes) + "}" : hard.sampling)
      << "\nsolver: {scheme: " << hard.scheme << ", time_step: " << hard.time_step << "}\n";
  return out.str();
}

double expectedWork(const HardCase& hard, int max_steps)
{
  return hard.nodes * duration(hard, max_steps) / hard.time_step;
}

Verdict judge(const HardCase& hard, int max_steps)
{
  try
  {
    BenchRun run(sceneText(hard));
    const double time = duration(hard, max_steps);
    if (hard.perturbation == 0.0 && hard.fold_angle == 0.0)
    {
      Verdict verdict = verdictOf(run.advance(time));
      verdict.turned = run.simulation().state().rotation / (2.0 * M_PI);
      return verdict;
    }
    run.advance(0.5 * time);
    perturb(run.simulation(), hard);
    run.resetEnergyBalance();
    // The perturbed wire is stretched at first; only the later part is evaluated.
    const RunSummary settling = run.advance(0.25 * time);
    Verdict verdict = verdictOf(run.advance(0.25 * time));
    if (!settling.finite)
      verdict.word = "bad", verdict.reason = "not finite";
    return verdict;
  }
  catch (const InputError& error)
  {
    Verdict verdict;
    verdict.word = "rejected";
    verdict.reason = error.what();
    return verdict;
  }
}

}  // namespace endovascular_sim::benchmark
