#include "benchmark/facets/facets_study.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "benchmark/force_quality/force_quality_study.h"
#include "benchmark/harness/bench_run.h"
#include "common/text/format.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kRate = 1.0;       // rad/s
constexpr double kInsertion = 0.5;  // s: inserts the wire
constexpr double kRest = 0.1;       // s: before it turns
constexpr double kTurning = 90.0;   // s: longer than any average
constexpr double kArchBegin = 0.2;  // s: in the arch, after the wire has come to rest
constexpr double kArchEnd = 8.0;    // s
constexpr double kQuickArch = 2.0;  // s
constexpr double kArchStep = 1e-3;  // s: time step of peer_wire.yaml

/** A soft wire of 100 mm with a 3 mm J, 60 mm of it in a straight tube of 6 mm. */
std::string sceneOf(int facets_around, bool smooth, double friction, double time_step)
{
  return formatted(R"(
name: j_tip
duration: 100.0
vessel:
  tube: {radius: 3.0e-3, facet_length: 1.0e-3, facets_around: %d, pieces: [{length: 0.1}]}
  wall: %s
  friction: %g
entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}
instrument:
  name: soft_j
  sections:
    - {length: 0.060, radius: 4.445e-4, material: steel, density: 6450, bending_stiffness: 40.0e-6, poisson_ratio: 0.3}
    - {length: 0.040, radius: 4.445e-4, material: steel, density: 6450, bending_stiffness: 5.0e-6, poisson_ratio: 0.3}
  tip: {shape: j, radius: 3.0e-3, angle: 3.141592653589793}
drive:
  source: script
  initial_insertion: 0.005
  insertion: {points: [[0, 0], [%g, 0.055]]}
  rotation: {points: [[0, 0], [%g, 0], [%g, %g]]}
sampling: {kind: uniform, nodes: 100}
solver: {time_step: %g}
)",
                   facets_around, smooth ? "smooth" : "facets", friction, kInsertion, kInsertion + kRest,
                   kInsertion + kRest + kTurning, kTurning * kRate, time_step);
}

/** The push of peer_wire.yaml, turned the other way, between facets, on them after smoothing, and on a smooth wall. */
void addArch(const StudyOptions& options, const Progress& progress, Section& section)
{
  section.text =
      "`peer_wire.yaml` in `aortic_arch_tree.obj` with `drive.rotation.amplitude=-2`, 0.2 to 8 s. The trend is that of "
      "windows of 0.25 s, as in `benchmark force_quality`.";
  if (options.vessel_mesh.empty())
  {
    section.text += " Omitted for lack of `aortic_arch_tree.obj`.";
    return;
  }
  const std::vector<std::pair<std::string, std::string>> walls = {{"facets", "vessel.wall=facets"},
                                                                  {"facets, smoothing: 2", "vessel.smoothing=2"},
                                                                  {"smooth", "vessel.wall=smooth"}};
  for (const auto& [name, wall] : walls)
  {
    progress(0.9, "arch, " + name);
    std::vector<HandReaction> reactions =
        reactionsIn("peer_wire", {"vessel.mesh=" + options.vessel_mesh, "drive.rotation.amplitude=-2", wall},
                    options.quick ? kQuickArch : kArchEnd)[0];
    reactions.erase(reactions.begin(), reactions.begin() + static_cast<int>(kArchBegin / kArchStep));
    const ReactionQuality quality = handQuality(reactions, kArchStep).force;
    const auto n = static_cast<double>(reactions.size());
    double mean = 0.0;
    double squares = 0.0;
    double largest = 0.0;
    for (const HandReaction& reaction : reactions)
    {
      mean += reaction.force / n;
      squares += reaction.force * reaction.force / n;
      largest = std::max(largest, std::abs(reaction.force));
    }
    section.table.add({name, number(1e3 * mean), number(1e3 * std::sqrt(std::max(0.0, squares - mean * mean))),
                       number(1e3 * quality.deviation), number(1e3 * quality.largest_change), number(1e3 * largest)});
  }
}

}  // namespace

JTipTorque turnJTip(int facets_around, bool smooth, double friction, double turns, double time_step)
{
  BenchRun run(sceneOf(facets_around, smooth, friction, time_step));
  const double turn = 2.0 * M_PI / kRate;
  run.advance(kInsertion + kRest + turn);
  const int steps = static_cast<int>(std::lround(turns * turn / time_step));
  double torque = 0.0;
  double torque_squares = 0.0;
  double force = 0.0;
  double force_squares = 0.0;
  JTipTorque result;
  for (int k = 0; k < steps; ++k)
  {
    run.advance(time_step);
    const rod::State& state = run.simulation().state();
    torque += state.hand_torque / steps;
    torque_squares += state.hand_torque * state.hand_torque / steps;
    force += state.hand_force / steps;
    force_squares += state.hand_force * state.hand_force / steps;
  }
  result.mean_torque = torque;
  result.torque_deviation = std::sqrt(std::max(0.0, torque_squares - torque * torque));
  result.force_deviation = std::sqrt(std::max(0.0, force_squares - force * force));
  return result;
}

std::vector<TableSpec> facetsTables()
{
  return {{"facets_torque",
           "Torque of a J tip over the facets around the lumen",
           {"facets around", "wall", "friction", "mean torque [µN·m]", "deviation of the torque [µN·m]",
            "deviation of the hand force [mN]"},
           ""},
          {"facets_arch",
           "Hand force of a J wire in the aortic arch over the wall",
           {"wall", "mean force [mN]", "standard deviation [mN]", "deviation about the trend [mN]",
            "largest change [mN/ms]", "largest force [mN]"},
           ""}};
}

std::vector<Section> facetsStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections = {Section(facetsTables(), "facets_torque"), Section(facetsTables(), "facets_arch")};
  sections[0].text =
      "A soft wire (EI 5 N·mm²) with a 3 mm J is turned at 1 rad/s in a straight tube of 6 mm. Means are over the "
      "second turn, with steps of 1 ms. Without friction nothing dissipates energy in a round tube: 0 is right.";
  const std::vector<int> facets =
      options.quick ? std::vector<int>{16, 48} : std::vector<int>{8, 12, 16, 24, 48, 96, 192, 384};
  double done = 0.0;
  const double share = 0.9 / (4.0 * static_cast<double>(facets.size()));
  for (double friction : {0.0, 0.1})
    for (bool smooth : {false, true})
      for (int count : facets)
      {
        const std::string wall = smooth ? "smooth" : "facets";
        progress(done, wall + " " + std::to_string(count) + " μ " + number(friction));
        const JTipTorque result = turnJTip(count, smooth, friction, 1.0, 1e-3);
        sections[0].table.add({std::to_string(count), wall, number(friction), number(1e6 * result.mean_torque),
                               number(1e6 * result.torque_deviation), number(1e3 * result.force_deviation)});
        done += share;
      }
  addArch(options, progress, sections[1]);
  return sections;
}

}  // namespace endovascular_sim::benchmark
