#include "benchmark/reference_rows.h"

#include <cmath>
#include <sstream>

#include <Eigen/Dense>

#include "benchmark/bench_run.h"
#include "benchmark/static_cases.h"
#include "common/error.h"
#include "rod/equilibrium.h"
#include "rod/twist.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kDegree = M_PI / 180.0;

/** One quantity over the number of nodes. */
struct Row
{
  std::string quantity;
  std::string scheme;
  double exact;
};

void addRow(Table& table, const Row& row, int nodes, double value, double& previous_error, double& previous_nodes)
{
  const double error = std::abs(value - row.exact);
  const double order = std::log(previous_error / error) / std::log(nodes / previous_nodes);
  table.add({row.quantity, row.scheme, std::to_string(nodes), number(value, 8), number(row.exact, 8),
             number(error / std::abs(row.exact), 2), number(order, 2)});
  previous_error = error;
  previous_nodes = nodes;
}

template <typename Value>
void addRows(Table& table, const Row& row, const std::vector<int>& counts, Value value)
{
  double previous_error = NAN;
  double previous_nodes = NAN;
  for (int nodes : counts)
    addRow(table, row, nodes, value(nodes), previous_error, previous_nodes);
}

// ---------------------------------------------------------------------------------------------- held at both ends

/** A clamped wire whose ends are brought together by a tenth of its length; references 03. */
struct Buckled
{
  double force = NAN;       ///< PL²/EI
  double deflection = NAN;  ///< of the middle, over L
};

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
  run.advance(4.0);
  const rod::State& state = run.simulation().state();
  const double scale = stiffness / (length * length);
  return {state.distal_force.x() / scale, std::abs(state.position[nodes / 2].y()) / length};
}

// ---------------------------------------------------------------------------------------------------------- ring

/** Twist at which a ring of EI = GJ loses stability; references 04. */
double criticalTwist(int nodes)
{
  rod::Section section;
  section.length = 2.0 * M_PI;
  section.bending_stiffness = section.torsional_stiffness = section.density = 1.0;
  section.axial_stiffness = 1e6;
  section.radius = 1e-3;
  rod::EquilibriumProblem problem;
  problem.rod = rod::discretiseRing(section, nodes);
  problem.held.assign(static_cast<std::size_t>(nodes), false);
  problem.twist_held = true;
  const double radius = problem.rod.rest_length[0] / (2.0 * std::sin(M_PI / nodes));
  rod::Equilibrium ring;
  for (int i = 0; i < nodes; ++i)
    ring.position.emplace_back(radius * std::cos(2.0 * M_PI * i / nodes), radius * std::sin(2.0 * M_PI * i / nodes),
                               0.0);
  for (int axis = 0; axis < 3; ++axis)
    problem.supports.push_back({0, Eigen::Vector3d::Unit(axis)});
  problem.supports.push_back({nodes / 2, Eigen::Vector3d::UnitY()});
  problem.supports.push_back({nodes / 2, Eigen::Vector3d::UnitZ()});
  problem.supports.push_back({nodes / 4, Eigen::Vector3d::UnitZ()});
  rod::EquilibriumSolver solver(problem);
  double stable = 8.0;
  double unstable = 14.0;
  for (int k = 0; k < 22; ++k)
  {
    solver.problem().twist = 0.5 * (stable + unstable);
    rod::Equilibrium rest = ring;
    if (!solver.solve(rest))
      return NAN;
    (solver.stiffness(rest)[0] < 0.0 ? unstable : stable) = solver.problem().twist;
  }
  return 0.5 * (stable + unstable);
}

// ------------------------------------------------------------------------------------------- torque transmission

/** A pre-curved wire on a planar bend of the same curvature, √(EI κ κ0/GJ)·L = lambda, held at its first edge. */
class Transmission
{
public:
  Transmission(double lambda, int nodes)
  {
    const double length = 0.1;
    const double edge = length / (nodes - 2);
    const double curvature = lambda / length;
    rod::Section section;
    section.length = edge * (nodes - 1);
    section.bending_stiffness = section.torsional_stiffness = 1e-3;
    section.axial_stiffness = 1e4;
    section.radius = 4e-4;
    section.density = 7000.0;
    section.rest_curvature = Eigen::Vector2d(0.0, -curvature);
    rod::Wire wire;
    wire.sections = {section};
    rod_ = rod::discretiseUniformly(wire, nodes);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    double angle = 0.0;
    state_.position.push_back(x);
    for (int j = 0; j + 1 < nodes; ++j)
    {
      angle += j > 0 ? 2.0 * std::atan(0.5 * curvature * edge) : 0.0;
      x += rod_.rest_length[j] * Eigen::Vector3d(std::cos(angle), 0.0, -std::sin(angle));
      state_.position.push_back(x);
    }
    state_.twist_angle.assign(static_cast<std::size_t>(nodes - 1), 0.0);
    hold_.position = 0.5 * rod_.rest_length[0];
  }

  /** Turns the hand [rad]; returns the tip's angle. */
  double turnTo(double angle)
  {
    hold_.rotation = angle;
    twist_.solve(rod_, hold_, state_);
    return state_.twist_angle.back();
  }

  /** Hand angle at which the tip first reaches an angle [rad]. */
  double handAngleFor(double tip)
  {
    const double step = 0.25 * kDegree;
    double before = turnTo(0.0);
    for (double hand = step; hand < 7.0; hand += step)
    {
      const double now = turnTo(hand);
      if (now >= tip)
        return hand - step * (now - tip) / (now - before);
      before = now;
    }
    return NAN;
  }

  /** Hand angle at which the tip jumps [rad]. */
  double snap()
  {
    const double step = 0.01 * kDegree;
    double before = turnTo(0.0);
    for (double hand = step; hand < 7.0; hand += step)
    {
      const double now = turnTo(hand);
      if (now - before > 0.5)
        return hand - step;
      before = now;
    }
    return NAN;
  }

private:
  rod::Discretisation rod_;
  rod::State state_;
  rod::TwistBoundary hold_;
  rod::QuasiStaticTwist twist_;
};

// ------------------------------------------------------------------------------------------------------ vibration

/** What a step does to the first mode of a clamped wire: growth·exp(±i·angle). */
struct Propagation
{
  double growth = NAN;
  double angle = NAN;  ///< [rad]
};

/** Shape of the first mode of a clamped wire at x/L. */
double firstMode(double x)
{
  constexpr double kBeta = 1.875104068711961;
  const double s = (std::cosh(kBeta) + std::cos(kBeta)) / (std::sinh(kBeta) + std::sin(kBeta));
  return std::cosh(kBeta * x) - std::cos(kBeta * x) - s * (std::sinh(kBeta * x) - std::sin(kBeta * x));
}

/** Lets the wire swing with a tiny amplitude and fits q(k+1) = a q(k) − b q(k−1) to the tip. */
Propagation swing(const std::string& scheme, int nodes, double turn, double& frequency)
{
  BenchWire wire;
  wire.scheme = scheme;
  wire.nodes = nodes;
  wire.strain_tolerance = 5e-5;
  const double line_density = wire.density * M_PI * wire.radius * wire.radius;
  frequency = 1.875104068711961 * 1.875104068711961 * std::sqrt(wire.bending_stiffness / line_density) /
              (wire.length * wire.length);
  wire.time_step = turn / frequency;
  BenchRun run(sceneText(wire));
  rod::State state = run.simulation().state();
  const std::size_t first_free = scheme == "mixed" ? 1 : 2;
  for (std::size_t i = first_free; i < state.position.size(); ++i)
    state.position[i].y() = 1e-5 * wire.length * firstMode(state.position[i].x() / wire.length);
  run.simulation().setState(state);
  constexpr int kSteps = 160;
  std::vector<double> amplitude;
  for (int k = 0; k < kSteps; ++k)
  {
    run.simulation().step({});
    amplitude.push_back(run.simulation().state().position.back().y());
  }
  // The first steps carry what the continuum's mode has of the discrete rod's higher ones; they die out first.
  constexpr int kSkip = 60;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int k = kSkip; k + 2 < kSteps; ++k)
  {
    const Eigen::Vector2d past(amplitude[k + 1], -amplitude[k]);
    normal += past * past.transpose();
    right += amplitude[k + 2] * past;
  }
  const Eigen::Vector2d fit = normal.inverse() * right;
  const double growth = std::sqrt(fit[1]);
  return {growth, std::acos(0.5 * fit[0] / growth)};
}

void addVibration(Table& table, bool quick)
{
  for (const std::string& scheme : schemes())
  {
    const std::vector<int> counts = scheme == "mixed" ? std::vector<int>{9, 17}
                                    : quick           ? std::vector<int>{26, 51}
                                                      : std::vector<int>{26, 51, 101};
    double frequency = 0.0;
    addRows(table, {"first frequency of the cantilever over the beam's", scheme, 1.0}, counts,
            [&](int nodes)
            {
              const double turn = 0.1;
              return std::tan(swing(scheme, nodes, turn, frequency).angle) / turn;
            });
    addRows(table, {"backward Euler's growth per step at ωΔt = 0.1", scheme, 0.9950371902}, {counts.back()},
            [&](int nodes) { return swing(scheme, nodes, 0.1, frequency).growth; });
  }
}

}  // namespace

Section referenceRows(const StudyOptions& options, const Progress& progress)
{
  Section section{"accuracy_references", "Buckling, torque, vibration", "",
                  Table({"quantity", "scheme", "nodes", "value", "exact", "relative error", "order"}), ""};
  section.text =
      "`statics` is the independent solver of the same discrete rod (Newton with the exact Hessian, KLU), `twist` the "
      "quasi-static "
      "twist that `kkt` and `paper` share, on a prescribed planar centreline. Frequencies are taken from the turn of a "
      "swinging "
      "wire's tip per step at ωΔt = 0.1.";
  progress(0.0, "post-buckling");
  const std::vector<int> counts = options.quick ? std::vector<int>{27, 51} : std::vector<int>{27, 51, 101};
  addRows(section.table, {"post-buckling at 10 % end shortening: PL²/EI", "kkt", 41.57025579315579}, counts,
          [](int nodes) { return buckle(nodes).force; });
  addRows(section.table, {"the same: deflection / L", "kkt", 0.19492431137557378}, counts,
          [](int nodes) { return buckle(nodes).deflection; });
  progress(0.4, "ring");
  addRows(section.table, {"critical twist of a ring, 2π√3 EI/GJ", "statics", 2.0 * M_PI * std::sqrt(3.0)},
          options.quick ? std::vector<int>{32, 64} : std::vector<int>{32, 64, 128}, criticalTwist);
  progress(0.6, "torque transmission");
  const std::vector<int> twist_counts = {22, 42, 82};
  addRows(section.table, {"hand angle for 60° at the tip, √(EIκκ0/GJ)L = 1 [°]", "twist", 85.69151950722886},
          twist_counts, [](int nodes) { return Transmission(1.0, nodes).handAngleFor(60.0 * kDegree) / kDegree; });
  addRows(section.table, {"hand angle for 90° at the tip, √(EIκκ0/GJ)L = 2 [°]", "twist", 191.78227469332728},
          twist_counts, [](int nodes) { return Transmission(2.0, nodes).handAngleFor(90.0 * kDegree) / kDegree; });
  addRows(section.table, {"hand angle of the snap, √(EIκκ0/GJ)L = 2 [°]", "twist", 197.7856142522825}, twist_counts,
          [](int nodes) { return Transmission(2.0, nodes).snap() / kDegree; });
  progress(0.8, "vibration");
  addVibration(section.table, options.quick);
  return section;
}

}  // namespace endovascular_sim::benchmark
