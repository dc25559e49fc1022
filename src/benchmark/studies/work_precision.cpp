#include "benchmark/studies/work_precision.h"

#include <cmath>
#include <sstream>

#include "benchmark/harness/bench_run.h"
#include "benchmark/reference/static_cases.h"
#include "common/error.h"

namespace endovascular_sim::benchmark
{
namespace
{

std::vector<int> nodeCounts(const std::string& scheme, bool quick)
{
  if (scheme == "mixed")
    return quick ? std::vector<int>{9, 17, 25} : std::vector<int>{5, 7, 9, 13, 17, 25, 50, 100};
  return quick ? std::vector<int>{25, 100} : std::vector<int>{25, 50, 100, 200, 380, 800, 1400};
}

/** Adds points of other systems, measured on one core: time per step and static error over L. */
void addPeers(Table& table)
{
  const auto add = [&table](const char* name, int nodes, double milliseconds, double error)
  {
    table.add(
        {"heavy cantilever", name, std::to_string(nodes), "1", number(error), number(1e3 * milliseconds), "measured"});
  };
  add("SOFA BeamAdapter", 100, 0.285, 7.1e-6);
  add("SOFA BeamAdapter", 200, 0.582, 1.8e-6);
  add("SOFA BeamAdapter", 380, 2.01, 6.0e-7);
  add("PositionBasedDynamics", 100, 0.157, 9.1e-5);
  add("PositionBasedDynamics", 200, 0.317, 2.3e-5);
  add("PositionBasedDynamics", 380, 0.612, 6.3e-6);
  add("DisMech", 100, 0.975, 1.1e-4);
}

/** Adds the error of the rest shape and the time of a 1 ms step of the falling wire. */
void addStatics(Table& table, const std::string& name, const StaticCase& problem, const std::string& scheme, bool quick)
{
  for (int nodes : nodeCounts(scheme, quick))
  {
    try
    {
      const RestResult rest = runToRest(sceneText(atRest(problem, scheme, nodes)), 1e-12, restSteps(scheme));
      BenchWire moving = problem.wire;
      moving.scheme = scheme;
      moving.nodes = nodes;
      moving.strain_tolerance = 5e-5;
      const double time = medianStepTime(sceneText(moving), 400);
      table.add({name, scheme, std::to_string(nodes), "1", number(tipError(problem, rest)), number(time),
                 rest.settled ? "" : "not at rest"});
    }
    catch (const InputError& error)
    {
      table.add({name, scheme, std::to_string(nodes), "1", "", "", std::string("rejected: ") + error.what()});
      return;
    }
  }
}

Section statics(const StudyOptions& options, const Progress& progress)
{
  Section section(workPrecisionTables(), "work_precision_static");
  section.text =
      "The time is that of a step of 1 ms of the moving wire; the error is that of its rest shape. Points marked "
      "`measured` belong to other systems with the same wire, measured separately on a similar machine: differences "
      "of some percent are not significant.";
  addPeers(section.table);
  double done = 0.0;
  for (const std::string& scheme : schemes())
  {
    progress(0.3 * done / 3.0, "heavy cantilever, " + scheme);
    addStatics(section.table, "heavy cantilever", heavyCantilever(), scheme, options.quick);
    progress(0.3 * (done + 0.5) / 3.0, "pre-curved wire, " + scheme);
    addStatics(section.table, "45° arc, out of plane", staticCases().back(), scheme, options.quick);
    done += 1.0;
  }
  return section;
}

/** Position of the tip of the falling wire. */
struct Fall
{
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  double seconds = 0.0;  ///< computing time [s]
};

Fall fall(const std::string& scheme, int nodes, double time_step, double duration)
{
  BenchWire wire = heavyCantilever().wire;
  wire.scheme = scheme;
  wire.nodes = nodes;
  wire.time_step = time_step;
  wire.strain_tolerance = 5e-5;
  BenchRun run(sceneText(wire));
  const RunSummary summary = run.advance(duration);
  return {run.simulation().state().position.back(), 1e-6 * summary.mean_us * summary.steps};
}

Section dynamics(const StudyOptions& options, const Progress& progress)
{
  constexpr double kDuration = 0.2;
  Section section(workPrecisionTables(), "work_precision_dynamic");
  section.text =
      "The heavy cantilever 0.2 s after its release. The reference is `kkt` with 200 nodes, extrapolated to Δt = 0 "
      "from 20 and 10 µs. Backward Euler is of first order in Δt, which limits every scheme at steps of 1 ms and "
      "longer.";
  progress(0.3, "reference of the motion");
  const double fine = options.quick ? 1e-4 : 2e-5;
  const Fall coarse = fall("kkt", 200, fine, kDuration);
  const Fall half = fall("kkt", 200, 0.5 * fine, kDuration);
  const Eigen::Vector3d reference = 2.0 * half.tip - coarse.tip;
  double done = 0.0;
  for (const std::string& scheme : schemes())
    for (int nodes : scheme == "mixed" ? std::vector<int>{9, 17, 33} : std::vector<int>{25, 50, 100})
      for (double time_step : {4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4})
      {
        progress(0.35 + 0.25 * done++ / 45.0, "motion, " + scheme + ", " + std::to_string(nodes) + " nodes");
        try
        {
          const Fall run = fall(scheme, nodes, time_step, kDuration);
          section.table.add({scheme, std::to_string(nodes), number(1e3 * time_step),
                             number((run.tip - reference).norm() / heavyCantilever().wire.length),
                             number(1e3 * run.seconds), number(kDuration / run.seconds)});
        }
        catch (const InputError&)
        {
          section.table.add({scheme, std::to_string(nodes), number(1e3 * time_step), "", "", "rejected"});
        }
      }
  return section;
}

std::string vesselScene(const std::string& scheme, const std::string& sampling, double time_step,
                        const std::string& mesh)
{
  std::ostringstream out;
  out << "name: wire_in_vessel\nduration: 11.5\nvessel: {mesh: '" << mesh << "', unit: 0.001, friction: 0.1}\n"
      << R"(entry: {position: [-0.035, 0.065, 0.005], direction: [-1, -1, 0], up: [1, -1, 0]}
instrument: instruments/peer_j_wire.yaml
drive:
  source: script
  initial_insertion: 0.0042
  speed: 0.035
  travel: 0.400
  rotation: {amplitude: 2.0, frequency: 0.15915494309189535}
  force_limit: 8.0
)"
      << "sampling: " << sampling << "\nsolver: {scheme: " << scheme << ", time_step: " << time_step << "}\n";
  return out.str();
}

struct VesselRun
{
  std::vector<Eigen::Vector3d> line;
  RunSummary summary;
};

VesselRun runVessel(const std::string& text, double duration, const std::vector<std::string>& overrides = {})
{
  BenchRun run(text, overrides);
  VesselRun result;
  result.summary = run.advance(duration);
  result.line = centreline(run.simulation(), 1e-3);
  return result;
}

Section vessel(const StudyOptions& options, const Progress& progress)
{
  // The push ends before the first bifurcation, beyond which runs differ by the branch that the tip enters.
  const double duration = options.quick ? 1.0 : 2.5;
  Section section(workPrecisionTables(), "work_precision_vessel");
  if (options.vessel_mesh.empty())
  {
    section.text = "Omitted: aortic_arch_tree.obj was not given (`--vessel-mesh FILE`, or ENDOVASCULAR_DATA_DIR).";
    return section;
  }
  const double fine_step = options.quick ? 2e-4 : 5e-5;
  const std::string fine = options.quick ? "{kind: uniform, nodes: 901}" : "{kind: uniform, nodes: 3601}";
  progress(0.6, "reference in the vessel");
  const std::string text = vesselScene("kkt", fine, fine_step, options.vessel_mesh);
  const VesselRun reference = runVessel(text, duration);
  progress(0.75, "reference in the vessel, perturbed by 1e-9 rad");
  const VesselRun perturbed = runVessel(text, duration, {"drive.initial_rotation=1.0e-9"});
  const CurveDistance sensitivity = distanceBetween(reference.line, perturbed.line);
  std::ostringstream about;
  about << "The wire and motion of the published comparison in `aortic_arch_tree.obj`, " << number(duration)
        << " s of pushing, ending before the first bifurcation. "
        << "Distances refer to points at equal arc length from the tip of a reference with "
        << (options.quick ? "0.5 mm edges and Δt 0.2 ms" : "0.125 mm edges and Δt 0.05 ms") << " (mean hand force "
        << number(1e3 * reference.summary.mean_hand_force)
        << " mN). An initial rotation by 1e-9 rad displaces the reference by " << number(1e3 * sensitivity.rms)
        << " mm RMS, " << number(1e3 * sensitivity.largest) << " mm at most; smaller errors are not significant.";
  section.text = about.str();
  double done = 0.0;
  for (const std::string& scheme : schemes())
    for (const std::string sampling : {"{kind: uniform, nodes: 121}", "{kind: uniform, nodes: 241}",
                                       "{kind: uniform, nodes: 451}", "{kind: adaptive}"})
      for (double time_step : options.quick ? std::vector<double>{1e-3} : std::vector<double>{2e-3, 1e-3, 5e-4})
      {
        progress(0.85 + 0.15 * done++ / 36.0, std::string("vessel, ").append(scheme).append(", ").append(sampling));
        try
        {
          const VesselRun run = runVessel(vesselScene(scheme, sampling, time_step, options.vessel_mesh), duration);
          const CurveDistance distance = distanceBetween(run.line, reference.line);
          section.table.add({scheme, sampling, number(1e3 * time_step), number(1e3 * distance.rms),
                             number(1e3 * distance.largest), number(1e3 * run.summary.mean_hand_force),
                             number(run.summary.mean_us), number(1e6 * time_step / run.summary.mean_us),
                             number(1e3 * run.summary.worst_penetration),
                             run.summary.rejected > 0 ? std::to_string(run.summary.rejected) + " steps rejected" : ""});
        }
        catch (const InputError& error)
        {
          section.table.add({scheme, sampling, number(1e3 * time_step), "", "", "", "", "", "",
                             std::string("rejected: ") + error.what()});
        }
      }
  return section;
}

}  // namespace

std::vector<TableSpec> workPrecisionTables()
{
  return {{"work_precision_static",
           "Static error over time per step",
           {"problem", "scheme", "nodes", "Δt [ms]", "tip error / L", "µs per step", "note"},
           "work_precision_static.png"},
          {"work_precision_dynamic",
           "Error of a motion over run time",
           {"scheme", "nodes", "Δt [ms]", "tip error / L", "ms for 0.2 s", "real-time factor"},
           "work_precision_dynamic.png"},
          {"work_precision_vessel",
           "Wire in a vessel: error over run time",
           {"scheme", "sampling", "Δt [ms]", "RMS distance [mm]", "largest [mm]", "hand force, mean [mN]",
            "µs per step", "real-time factor", "worst penetration [mm]", "note"},
           "work_precision_vessel.png"}};
}

std::vector<Section> workPrecisionStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections;
  sections.push_back(statics(options, progress));
  sections.push_back(dynamics(options, progress));
  sections.push_back(vessel(options, progress));
  return sections;
}

}  // namespace endovascular_sim::benchmark
