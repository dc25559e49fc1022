#include "benchmark/harness/bench_wire.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "simulation/simulation.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values)
{
  if (values.empty())
    return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/** @param stiffness ratio of EI to bending_stiffness */
void writeSection(std::ostream& out, const BenchWire& wire, double length, double stiffness, bool curved)
{
  out << "    - length: " << length << "\n      radius: " << wire.radius
      << "\n      material: steel\n      density: " << wire.density
      << "\n      bending_stiffness: " << stiffness * wire.bending_stiffness
      << "\n      torsional_stiffness: " << wire.torsion_ratio * stiffness * wire.bending_stiffness << "\n";
  if (curved && wire.rest_curvature != 0.0)
    out << "      rest_curvature: [" << wire.rest_curvature << ", 0]\n";
}

simulation::Simulation benchSimulation(const std::string& scene_text)
{
  const scene::Scene scene = scene::parseScene(scene_text, "benchmark");
  scene::EntryPose entry;
  entry.position = scene.entry.position;
  entry.direction = scene.entry.direction;
  entry.d1 = scene.entry.up;
  return simulation::Simulation(scene, entry, nullptr);
}

}  // namespace

std::string sceneText(const BenchWire& wire)
{
  const bool node_clamp = wire.scheme == "mixed";
  const bool both_clamped = wire.distal_shift != 0.0;
  const double edges = wire.nodes - 1 - (node_clamp ? 0.0 : both_clamped ? 1.0 : 0.5);
  const double half_edge = node_clamp ? 0.0 : 0.5 * wire.length / edges;
  std::ostringstream out;
  out << std::setprecision(17);
  out << "name: bench\nduration: 1.0e6\nvessel: none\n"
      << "entry: {position: [" << -half_edge << ", 0, 0], direction: [1, 0, 0], up: [0, 1, 0]}\n"
      << "introducer: false\nproximal_end: clamped\ndistal_end: " << (both_clamped ? "clamped" : "free") << "\n"
      << "instrument:\n  name: wire\n  sections:\n";
  if (half_edge > 0.0)
    writeSection(out, wire, half_edge, wire.near_stiffness, false);
  const bool stepped = wire.near_stiffness != 1.0;
  if (stepped)
    writeSection(out, wire, 0.5 * wire.length, wire.near_stiffness, true);
  writeSection(out, wire, (stepped ? 0.5 : 1.0) * wire.length + (both_clamped ? half_edge : 0.0), 1.0, true);
  out << "loads:\n  gravity: [0, " << -wire.gravity << ", 0]\n  damping: " << wire.damping << "\n";
  if (!wire.tip_force.isZero(0.0))
    out << "  point_loads:\n    - force: [" << wire.tip_force.x() << ", " << wire.tip_force.y() << ", "
        << wire.tip_force.z() << "]\n";
  out << "sampling: {kind: uniform, nodes: " << wire.nodes << "}\n"
      << "solver: {scheme: " << wire.scheme << ", time_step: " << wire.time_step
      << ", strain_tolerance: " << wire.strain_tolerance << ", max_newton: 30}\n";
  return out.str();
}

RestResult runToRest(const std::string& scene_text, double tolerance, int max_steps)
{
  simulation::Simulation simulation = benchSimulation(scene_text);
  RestResult result;
  std::vector<double> times;
  std::vector<Eigen::Vector3d> before;
  while (result.steps < max_steps && !result.settled)
  {
    before = simulation.state().position;
    const Clock::time_point start = Clock::now();
    simulation.step({});
    times.push_back(1e6 * std::chrono::duration<double>(Clock::now() - start).count());
    ++result.steps;
    if (!simulation.report().solved)
      break;
    double motion = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i)
      motion = std::max(motion, (simulation.state().position[i] - before[i]).norm());
    result.settled = motion < tolerance;
  }
  result.state = simulation.state();
  result.tip = result.state.position.back();
  result.energy = simulation.energy();
  result.step_us = median(times);
  return result;
}

double medianStepTime(const std::string& scene_text, int steps)
{
  simulation::Simulation simulation = benchSimulation(scene_text);
  std::vector<double> times;
  for (int step = 0; step < steps; ++step)
  {
    const Clock::time_point start = Clock::now();
    simulation.step({});
    times.push_back(1e6 * std::chrono::duration<double>(Clock::now() - start).count());
  }
  return median(times);
}

}  // namespace endovascular_sim::benchmark
