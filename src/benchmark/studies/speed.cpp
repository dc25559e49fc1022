#include "benchmark/studies/speed.h"

#include <chrono>
#include <cmath>
#include <sstream>

#include "benchmark/harness/bench_run.h"
#include "benchmark/reference/static_cases.h"
#include "benchmark/studies/shared_wall.h"
#include "fluoroscopy/fluoroscope.h"
#include "scene/file_search.h"
#include "visualization/tube_surface.h"

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace endovascular_sim::benchmark
{
namespace
{

using Clock = std::chrono::steady_clock;

/** Time stamp counter of the processor; 0 on other architectures. */
std::uint64_t cycles()
{
#if defined(__x86_64__)
  return __rdtsc();
#else
  return 0;
#endif
}

/** Scene text of a 0.45 m wire inside a channel with two bends, pushed back and forth and rotated. */
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

/** Rendering times of a wire. */
struct RenderingTime
{
  double surface = 0.0;  ///< surface mesh for a 3D view [µs]
  double frame = 0.0;    ///< fluoroscopy frame of 512² pixels [µs]
};

RenderingTime renderingTime(BenchRun& run)
{
  const rod::State& state = run.simulation().state();
  const std::vector<double>& radius = run.simulation().discretisation().radius;
  RenderingTime time;
  const visualization::TubeAxis axis{state.position, radius,
                                     std::vector<visualization::TranslucentColour>(state.position.size())};
  visualization::Surface surface;
  time.surface = microsecondsOf(
      [&]
      {
        surface.clear();
        visualization::TubeBuilder(8).append(axis, surface);
      },
      5);
  fluoroscopy::CArmPose pose;
  pose.isocentre = state.position[state.position.size() / 2];
  fluoroscopy::Fluoroscope fluoroscope(
      pose, fluoroscopy::XRayScene(),
      fluoroscopy::MaterialLibrary::load(scene::configFolder() + "/xray/materials.yaml"));
  const fluoroscopy::DeviceDensity nitinol = fluoroscope.materials().solid("nitinol");
  fluoroscopy::XRayWire wire;
  wire.nodes.push_back(state.position.front());
  for (std::size_t j = 0; j + 1 < state.position.size(); ++j)
    fluoroscopy::appendEdge(wire, state.position[j + 1], {{0.5 * (radius[j] + radius[j + 1]), nitinol}});
  fluoroscope.render({wire});
  time.frame = microsecondsOf([&] { fluoroscope.render({wire}); }, 3);
  return time;
}

Section paperTable(const StudyOptions& options, const Progress& progress)
{
  Section section(speedTables(), "speed_table");
  section.text =
      "Medians in µs on one core. The wire lies in a channel with two bends and is pushed and rotated; all nodes are "
      "in the solver. The phases of the paper were measured on its own machine (Xeon E3-1230 v2, 3.3 GHz) and do not "
      "add up to its totals, so the comparison is by phase. Inextensibility is part of the solve of `kkt`, and the "
      "projection of `paper`. A whole frame is one step, the surface mesh of the wire and one fluoroscopy frame of "
      "512² pixels; the paper reaches 75 frames per second at 380 nodes.";
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

Section growth(const StudyOptions& options, const Progress& progress)
{
  const std::function<std::uint64_t()>& allocations = options.allocations;
  Section section(speedTables(), "speed_growth");
  section.text =
      "A clamped wire falling under gravity without contact, Δt = 1 ms; medians. The exponent between consecutive "
      "rows is 1 for linear growth. Cycles are means of the time stamp counter of the processor.";
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
      const std::vector<drive::HandCommand> at_rest(1);
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

std::vector<TableSpec> speedTables()
{
  return {
      {"speed_table",
       "Table 1 of the paper",
       {"scheme", "nodes", "collision", "assembly", "solve", "twist", "step, median", "step, p99", "wire's surface",
        "fluoroscopy frame", "whole frame", "frames per second", "paper: physics + constraints + collision"},
       ""},
      {"speed_growth",
       "Growth with the number of nodes",
       {"scheme", "nodes", "µs per step", "µs per node", "cycles per node", "allocations per step", "growth exponent"},
       "speed.png"},
      sharedWallTable()};
}

std::vector<Section> speedStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections;
  sections.push_back(paperTable(options, progress));
  sections.push_back(growth(options, progress));
  sections.push_back(sharedWallCost(progress));
  return sections;
}

}  // namespace endovascular_sim::benchmark
