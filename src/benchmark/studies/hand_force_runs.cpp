#include "benchmark/studies/hand_force_runs.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "benchmark/harness/bench_run.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kTip = 5e-3;          // length of the tip [m]
constexpr double kOmitted = 0.5;       // omitted time at both ends of a noise measurement [s]
constexpr double kShaftSpeed = 0.035;  // speed of the push [m/s]

double tipForce(const simulation::Simulation& simulation)
{
  const std::vector<double>& position = simulation.discretisation().position;
  double force = 0.0;
  for (int i = simulation.discretisation().nodes() - 1; position.back() - position[i] < kTip; --i)
    force += simulation.state().wall_force[i].norm();
  return force;
}

double sumOfWallForces(const simulation::Simulation& simulation)
{
  double sum = 0.0;
  for (int i = simulation.state().first_node; i < simulation.discretisation().nodes(); ++i)
    sum += simulation.state().wall_force[i].norm();
  return sum;
}

void writeSection(std::ostream& out, const CoronaryPush& push, double length, double stiffness, double density)
{
  const double bending = push.stiffness * stiffness;
  out << "    - {length: " << length << ", radius: 1.778e-4, material: steel, density: " << density
      << ", bending_stiffness: " << bending << ", torsional_stiffness: " << push.shear * stiffness / 1.3 << "}\n";
}

}  // namespace

std::vector<HandSample> pushThrough(const std::string& scene_text, const std::vector<std::string>& overrides,
                                    Rejection rejection)
{
  BenchRun run(scene_text, overrides);
  const scene::Scene& scene = run.scene();
  simulation::Simulation& simulation = run.simulation();
  const auto steps = static_cast<int>(std::lround(scene.instruments.front().drive.travel /
                                                  scene.instruments.front().drive.speed / scene.solver.time_step));
  std::vector<HandSample> samples;
  samples.reserve(static_cast<std::size_t>(steps));
  for (int k = 1; k <= steps; ++k)
  {
    const double end_time = k * scene.solver.time_step;
    simulation.step(
        {scene.instruments.front().drive.insertionAt(end_time), scene.instruments.front().drive.rotationAt(end_time)});
    if (!simulation.report().solved && rejection == Rejection::kEnds)
      break;
    if (!simulation.report().solved)
      throw std::runtime_error("hand_force: a step was rejected in scene " + scene.name);
    const rod::State& state = simulation.state();
    samples.push_back({state.inserted_length, state.hand_force, state.hand_torque, tipForce(simulation),
                       sumOfWallForces(simulation), simulation.surfacePenetration(), state.hand_parts});
  }
  return samples;
}

double meanOf(const std::vector<HandSample>& samples, double HandSample::*value, double from, double to)
{
  double sum = 0.0;
  int count = 0;
  for (const HandSample& sample : samples)
    if (sample.insertion >= from && sample.insertion <= to)
    {
      sum += sample.*value;
      ++count;
    }
  return count > 0 ? sum / count : NAN;
}

double noiseOf(const std::vector<HandSample>& samples, double time_step, double frequency)
{
  // A Gaussian of deviation σ passes exp(−(2πfσ)²/2) of an amplitude; the remainder is high-pass.
  const double sigma = std::sqrt(-2.0 * std::log(1.0 - std::sqrt(0.5))) / (2.0 * M_PI * frequency);
  const int reach = static_cast<int>(std::ceil(4.0 * sigma / time_step));
  const int edge = std::max(reach, static_cast<int>(std::lround(kOmitted / time_step)));
  const int n = static_cast<int>(samples.size());
  double square = 0.0;
  double mean = 0.0;
  for (int k = edge; k < n - edge; ++k)
  {
    double slow = 0.0;
    double weights = 0.0;
    for (int j = -reach; j <= reach; ++j)
    {
      const double weight = std::exp(-0.5 * std::pow(j * time_step / sigma, 2));
      slow += weight * samples[k + j].force;
      weights += weight;
    }
    square += std::pow(samples[k].force - slow / weights, 2);
    mean += samples[k].force;
  }
  const int count = n - 2 * edge;
  return count > 0 ? std::sqrt(square / count) / (mean / count) : NAN;
}

std::string sceneText(const CoronaryPush& push)
{
  std::ostringstream out;
  out.precision(12);
  out << "name: coronary\nduration: 100\nvessel: {anatomy: anatomies/plain.yaml, friction: " << push.friction
      << ", smoothing: 1}\nentry: {position: [0.004, -0.0165, 0.1988], direction: [0.85, 0.26, 0.45], up: [0, 0, 1]}\n"
      << "instrument:\n  name: guidewire\n  sections:\n";
  writeSection(out, push, 0.05, 50e-6, 7900);
  writeSection(out, push, 0.02, 25e-6, 7000);
  writeSection(out, push, 0.02, 6e-6, 7000);
  writeSection(out, push, 0.03, 1.6e-6, 12000);
  if (!push.tip.empty())
    out << "  tip: " << push.tip << "\n";
  const double seconds = push.travel / push.speed;
  out << "drive: {source: script, initial_insertion: 0.002, speed: " << push.speed << ", travel: " << push.travel
      << ", rotation: {points: [[0, 0], [" << seconds << ", " << push.turn << "]]}}\n"
      << "sampling: {kind: uniform, nodes: 240}\n"
      << "solver: {scheme: " << push.scheme << ", time_step: " << push.time_step << "}\n";
  return out.str();
}

std::string shaftScene(bool anatomy, int nodes, int smoothing, double travel)
{
  std::ostringstream out;
  out << "name: shaft\nduration: 100\n"
      << (anatomy ? "vessel: {anatomy: anatomies/plain.yaml, friction: 0.1, smoothing: "
                  : "vessel: {tube: {radius: 4.0e-3, facet_length: 2.2e-3, facets_around: 20, pieces: [{length: 0.05}, "
                    "{length: 0.05, curvature: 20}, {length: 0.03}, {length: 0.05, curvature: 25, plane_angle: 1.5}, "
                    "{length: 0.05}]}, friction: 0.1, smoothing: ")
      << smoothing << "}\n"
      << (anatomy ? "entry: {centreline_end: right_common_femoral, offset: 0.005}\n"
                  : "entry: {direction: [1, 0, 0], up: [0, 1, 0]}\n")
      << "instrument:\n  name: guidewire\n  sections:\n    - {length: 0.3, radius: 4.445e-4, material: steel, density: "
         "6450, bending_stiffness: 291.0e-6, poisson_ratio: 0.3}\n"
      << "drive: {source: script, initial_insertion: 0.01, speed: " << kShaftSpeed << ", travel: " << travel
      << "}\nsampling: {kind: uniform, nodes: " << nodes << "}\n";
  return out.str();
}

}  // namespace endovascular_sim::benchmark
