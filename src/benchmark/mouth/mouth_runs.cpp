#include "benchmark/mouth/mouth_runs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "benchmark/harness/bench_run.h"
#include "benchmark/mouth/mouth_reference.h"
#include "common/text/format.h"
#include "simulation/stepper_factory.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kTube = 4e-3;         // radius of the tube [m]
constexpr double kStraight = 0.02;     // length of the tube before its bend [m]
constexpr double kBegin = 2e-3;        // first inserted length [m]
constexpr double kFollowed = 0.25e-3;  // longest distance between equilibria of the reference [m]
constexpr double kRamp = 0.1;          // time in which the hand changes its speed: inertia is no force of the mouth [s]
constexpr double kAbsolute = 0.02;     // tolerated deviation [N]
constexpr double kRelative = 0.03;
constexpr double kPlane = 0.05e-3;  // lateral offset of a wire that has left its plane [m]

std::string sceneOf(const MouthMotion& motion)
{
  const std::string pieces = motion.bend_curvature != 0.0
                                 ? formatted("{length: %g}, {length: %g, curvature: %g, plane_angle: %g}", kStraight,
                                             motion.travel, motion.bend_curvature, -M_PI / 2.0)
                                 : formatted("{length: %g}", motion.travel + 0.05);
  const std::string sampling =
      motion.nodes > 0 ? formatted("{kind: uniform, nodes: %d}", motion.nodes) : "{kind: adaptive}";
  return formatted(R"(
name: mouth
duration: 1000.0
vessel:
  tube: {radius: %g, facet_length: 1.0e-3, facets_around: 64, pieces: [%s]}
  friction: 0.0
entry: {position: [0, 0, 0], direction: [1, 0, 0], up: [0, 1, 0]}
instrument: {use: %s}
drive: {source: script, initial_insertion: %g, speed: %g, travel: %g, force_limit: 100.0}
sampling: %s
)",
                   kTube, pieces.c_str(), motion.instrument.c_str(), kBegin, motion.speed, motion.travel,
                   sampling.c_str());
}

MouthProblem problemOf(const scene::Scene& scene, const MouthMotion& motion)
{
  MouthProblem problem;
  problem.wire = scene.instruments.front().instrument.wire;
  scene::EntryPose entry;
  entry.wall_distance = kTube;
  const rod::Boundary boundary = simulation::boundaryOf(scene, entry);
  problem.guide_length = boundary.guide_length;
  problem.guide_decay = std::min(boundary.guide_decay, 0.25 * boundary.guide_length);
  problem.sheath_clearance = boundary.sheath_clearance;
  problem.clearance = kTube - problem.wire.sections.back().radius;
  problem.bend_begin = kStraight;
  problem.bend_curvature = motion.bend_curvature;
  return problem;
}

/** Time at full speed in which the hand would move as far as at a time, with ramps of its speed at both ends [s]. */
double travelled(double time, double duration)
{
  const double up = std::min(time, kRamp);
  const double down = std::max(0.0, time - (duration - kRamp));
  return 0.5 * up * up / kRamp + std::max(0.0, time - kRamp) - 0.5 * down * down / kRamp;
}

/** True while all nodes lie in the plane of the axis and the rest curvature. */
bool isPlane(const rod::State& state)
{
  return std::all_of(state.position.begin() + state.first_node, state.position.end(),
                     [](const Eigen::Vector3d& at) { return std::abs(at.y()) < kPlane; });
}

/** Force of the reference at an inserted length, by linear interpolation. */
double interpolated(const std::vector<MouthForce>& reference, double insertion)
{
  const auto after = std::upper_bound(reference.begin() + 1, reference.end() - 1, insertion,
                                      [](double length, const MouthForce& at) { return length < at.insertion; });
  const MouthForce& a = *(after - 1);
  const MouthForce& b = *after;
  return a.force + (b.force - a.force) * (insertion - a.insertion) / (b.insertion - a.insertion);
}

}  // namespace

MouthCurves runMouth(const MouthMotion& motion)
{
  BenchRun run(sceneOf(motion));
  simulation::Simulation& simulation = run.simulation();
  const double dt = run.scene().solver.time_step;
  const double duration = motion.travel / motion.speed + kRamp;
  const int steps = static_cast<int>(std::lround(duration / dt));
  MouthCurves curves;
  for (int k = 1; k <= 2 * steps; ++k)
  {
    simulation.step({kBegin + motion.speed * travelled((k <= steps ? k : 2 * steps - k) * dt, duration), 0.0});
    if (!simulation.report().solved)
      throw std::runtime_error("mouth: a step was rejected");
    (k <= steps ? curves.in : curves.out)
        .push_back({simulation.state().inserted_length, simulation.state().hand_force, isPlane(simulation.state())});
  }
  MouthReference reference(problemOf(run.scene(), motion));
  const int between = std::max(1, static_cast<int>(std::ceil(motion.reference_step / kFollowed)));
  const int points = static_cast<int>(std::floor(motion.travel / motion.reference_step));
  for (int k = 0; k <= points * between; ++k)
  {
    const double insertion = kBegin + k * motion.reference_step / between;
    const double force = reference.force(insertion);
    if (k % between == 0)
      curves.reference.push_back({insertion, force});
  }
  return curves;
}

std::optional<PlaneLeft> planeLeft(const std::vector<MouthForce>& way)
{
  const auto begin = std::find_if(way.begin(), way.end(), [](const MouthForce& at) { return !at.plane; });
  if (begin == way.end())
    return std::nullopt;
  const auto end = std::find_if(begin, way.end(), [](const MouthForce& at) { return at.plane; });
  return PlaneLeft{begin->insertion, (end == way.end() ? way.back() : *end).insertion};
}

MouthDeviation deviationOf(const std::vector<MouthForce>& way, const std::vector<MouthForce>& reference)
{
  MouthDeviation found;
  for (std::size_t k = 0; k < way.size(); ++k)
  {
    const MouthForce& at = way[k];
    if (at.insertion > reference.back().insertion || !at.plane)
      continue;
    const double exact = interpolated(reference, at.insertion);
    const double deviation = std::abs(at.force - exact);
    if (deviation > found.largest)
    {
      found.largest = deviation;
      found.at = at.insertion;
    }
    found.of_tolerance = std::max(found.of_tolerance, deviation / (kAbsolute + kRelative * std::abs(exact)));
    if (k > 0 && way[k - 1].plane && way[k - 1].insertion <= reference.back().insertion)
      found.change = std::max(found.change, std::abs(at.force - way[k - 1].force) -
                                                std::abs(exact - interpolated(reference, way[k - 1].insertion)));
  }
  return found;
}

}  // namespace endovascular_sim::benchmark
