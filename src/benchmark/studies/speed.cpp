#include "benchmark/studies/speed.h"

#include <chrono>
#include <cmath>
#include <sstream>

#include "benchmark/harness/bench_run.h"
#include "benchmark/reference/static_cases.h"
#include "benchmark/studies/shared_wall.h"
#include "fluoroscopy/fluoroscope.h"
#include "visualization/tube_mesh.h"

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace endovascular_sim::benchmark
{
namespace
{

using Clock = std::chrono::steady_clock;

/** Counter of the processor's clock; 0 where there is none. */
std::uint64_t cycles()
{
#if defined(__x86_64__)
  return __rdtsc();
#else
  return 0;
#endif
}

/** A 0.45 m wire, all of it inside a channel with two bends, pushed back and forth and turned. */
std::string channelScene(const std::string& scheme, int nodes)
{
  std::ostringstream out;
  out << R"(name: channel
duration: 10
vessel:
  tube:
    radius: 3.0e-3
    facet_length: 1.0e-3
    facets_around: 48
    pieces:
      - length: 0.10
      - {length: 0.0942477796076938, curvature: 16.666666666666668, plane_angle: 0.0}
      - length: 0.10
      - {length: 0.0942477796076938, curvature: 16.666666666666668, plane_angle: 2.0}
      - length: 0.10
  friction: 0.1
entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}
instrument:
  name: wire
  sections:
    - {length: 0.44, radius: 4.45e-4, material: nitinol, density: 6450, bending_stiffness: 3.0e-4, poisson_ratio: 0.3}
    - {length: 0.01, radius: 3.5e-4, material: nitinol, density: 6450, bending_stiffness: 2.0e-5, poisson_ratio: 0.3,
       rest_curvature: {radius: 0.0121, direction: 0}}
drive:
  source: script
  initial_insertion: 0.02
  insertion: {points: [[0, 0], [4.0, 0.38], [6.0, 0.39], [8.0, 0.38]]}
  rotation: {amplitude: 1.0, frequency: 0.25}
  force_limit: 20
)";
  out << "sampling: {kind: uniform, nodes: " << nodes << "}\nsolver: {scheme: " << scheme << "}\n";
  return out.str();
}

double microsecondsOf(const std::function<void()>& work, int times)
{
  double best = 1e300;
  for (int k = 0; k < times; ++k)
  {
    const Clock::time_point start = Clock::now();
    work();
    best = std::min(best, 1e6 * std::chrono::duration<double>(Clock::now() - start).count());
  }
  return best;
}

/** Time of the wire's surface for a 3D view and of one 512² fluoroscopy frame [µs]. */
struct RenderingTime
{
  double surface = 0.0;
  double frame = 0.0;
};

RenderingTime renderingTime(BenchRun& run)
{
  const rod::State& state = run.simulation().state();
  const std::vector<double>& radius = run.simulation().discretisation().radius;
  RenderingTime time;
  time.surface = microsecondsOf([&] { visualization::tubeMesh(state.position, radius, 8); }, 5);
  fluoroscopy::CArmPose pose;
  pose.isocentre = state.position[state.position.size() / 2];
  fluoroscopy::XRayScene scene;
  scene.tissue_attenuation = 20.6;
  scene.vessel_attenuation = 60.0;
  scene.tissue_thickness = 0.2;
  fluoroscopy::Fluoroscope fluoroscope(pose, scene);
  fluoroscopy::XRayWire wire;
  wire.nodes = state.position;
  wire.radius = radius;
  wire.attenuation.assign(radius.size() - 1, 800.0);
  fluoroscope.render({wire});
  time.frame = microsecondsOf([&] { fluoroscope.render({wire}); }, 3);
  return time;
}

Section paperTable(const StudyOptions& options, const Progress& progress)
{
  Section section{"speed_table", "The paper's Table 1", "",
                  Table({"scheme", "nodes", "collision", "assembly", "solve", "twist", "step, median", "step, p99",
                         "wire's surface", "fluoroscopy frame", "whole frame", "frames per second",
                         "paper: physics + constraints + collision"}),
                  ""};
  section.text =
      "All in µs, medians, one core; the wire lies in a channel with two bends, pushed and turned, all nodes in the "
      "solver. The paper's phases were measured on its own machine (Xeon E3-1230 v2, 3.3 GHz) and do not add up to its "
      "totals, so they are compared phase by phase; inextensibility is part of `kkt`'s solve, and of `paper`'s it is "
      "the projection. The whole frame is one step, the wire's surface as a mesh and one 512² fluoroscopy frame; the "
      "paper reaches 75 frames per second at 380 nodes.";
  const std::vector<std::pair<int, int>> paper = {
      {100, 680 + 260 + 1020}, {200, 920 + 520 + 2130}, {300, 1160 + 790 + 3140}, {380, 1270 + 990 + 3980}};
  const std::vector<std::string> compared = {"kkt", "paper"};
  double done = 0.0;
  for (const std::string& scheme : compared)
    for (const auto& [nodes, reference] : paper)
    {
      progress(0.5 * done / 8.0, "table, " + scheme + ", " + std::to_string(nodes) + " nodes");
      done += 1.0;
      BenchRun run(channelScene(scheme, nodes));
      run.advance(options.quick ? 4.0 : 6.0);
      const RunSummary summary = run.advance(options.quick ? 0.5 : 2.0);
      const RenderingTime rendering = renderingTime(run);
      const double whole = summary.median_us + rendering.surface + rendering.frame;
      const auto phase = [&summary](Phase p) { return number(summary.phase_us[static_cast<std::size_t>(p)]); };
      section.table.add({scheme, std::to_string(nodes), phase(Phase::kCollision), phase(Phase::kAssembly),
                         phase(Phase::kSolve), phase(Phase::kTwist), number(summary.median_us), number(summary.p99_us),
                         number(rendering.surface), number(rendering.frame), number(whole), number(1e6 / whole),
                         std::to_string(reference)});
    }
  return section;
}

Section growth(const StudyOptions& options, const Progress& progress, const std::function<std::uint64_t()>& allocations)
{
  Section section{"speed_growth", "Growth with the number of nodes", "",
                  Table({"scheme", "nodes", "µs per step", "µs per node", "cycles per node", "allocations per step",
                         "growth exponent"}),
                  "speed.png"};
  section.text =
      "The clamped wire that falls under gravity (no contact), Δt = 1 ms, medians. The exponent is that between a row "
      "and the one above it; 1 is linear. Cycles are those of the processor's time stamp counter, means.";
  const std::vector<int> counts =
      options.quick ? std::vector<int>{100, 380, 1000} : std::vector<int>{100, 200, 380, 1000, 2000, 5000};
  const StaticCase problem = heavyCantilever();
  double done = 0.0;
  for (const std::string& scheme : schemes())
  {
    double previous = NAN;
    double previous_nodes = NAN;
    for (int nodes : counts)
    {
      progress(0.5 + 0.5 * done++ / static_cast<double>(counts.size() * schemes().size()),
               "growth, " + scheme + ", " + std::to_string(nodes) + " nodes");
      BenchWire wire = problem.wire;
      wire.scheme = scheme;
      wire.nodes = nodes;
      wire.strain_tolerance = 5e-5;
      BenchRun run(sceneText(wire));
      run.advance(0.02);
      const std::vector<simulation::HandCommand> at_rest(1);
      const std::uint64_t allocated = allocations ? allocations() : 0;
      const std::uint64_t begin = cycles();
      const int steps = std::max(20, 100000 / nodes);
      for (int k = 0; k < steps; ++k)
        run.simulation().stepAll(at_rest);
      const double cycles_per_step = static_cast<double>(cycles() - begin) / steps;
      const double allocations_per_step = allocations ? static_cast<double>(allocations() - allocated) / steps : NAN;
      const RunSummary summary = run.advance(steps * 1e-3);
      const double exponent = std::log(summary.median_us / previous) / std::log(nodes / previous_nodes);
      section.table.add({scheme, std::to_string(nodes), number(summary.median_us), number(summary.median_us / nodes),
                         number(cycles_per_step / nodes), number(allocations_per_step), number(exponent)});
      previous = summary.median_us;
      previous_nodes = nodes;
    }
  }
  return section;
}

}  // namespace

std::vector<Section> speedStudy(const StudyOptions& options, const Progress& progress,
                                const std::function<std::uint64_t()>& allocations)
{
  std::vector<Section> sections;
  sections.push_back(paperTable(options, progress));
  sections.push_back(growth(options, progress, allocations));
  sections.push_back(sharedWallCost(progress));
  return sections;
}

}  // namespace endovascular_sim::benchmark
