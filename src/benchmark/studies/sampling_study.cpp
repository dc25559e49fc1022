#include "benchmark/studies/sampling_study.h"

#include <algorithm>
#include <cmath>

#include "common/time/processor_time.h"
#include "results/run_result.h"
#include "scene/scene_file.h"
#include "session/session.h"
#include "simulation/instrument_tip.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kReferenceEdge = 0.125e-3;  // edge of the reference [m]
constexpr double kFineEdge = 0.5e-3;         // edge of the uniform sampling that adaptive sampling is compared with [m]
constexpr double kCoarseEdge = 0.8e-3;       // edge of the second uniform sampling of the paper [m]
constexpr double kShapeInterval = 50e-3;     // simulated time between comparisons of the shape [s]
constexpr double kPointSpacing = 0.25e-3;    // spacing of the compared points along the wire [m]
constexpr int kTimedRuns = 3;
constexpr double kStart = 50e-3;  // initial transient omitted from forces [s]

/** Shape of the wire at one time, by arc length from the introducer. */
struct Shape
{
  std::vector<double> arc_length;
  std::vector<Eigen::Vector3d> point;

  /** Tangent, of second order in the edge length. */
  Eigen::Vector3d tangent(std::size_t i) const
  {
    const auto slope = [this](std::size_t j)
    { return Eigen::Vector3d((point[j + 1] - point[j]) / (arc_length[j + 1] - arc_length[j])); };
    if (i == 0)
      return slope(0);
    if (i + 1 == point.size())
      return slope(i - 1);
    const double before = arc_length[i] - arc_length[i - 1];
    const double after = arc_length[i + 1] - arc_length[i];
    return (after * slope(i - 1) + before * slope(i)) / (before + after);
  }

  /** Point of the cubic Hermite curve through the nodes. */
  Eigen::Vector3d at(double s) const
  {
    const auto after = std::upper_bound(arc_length.begin() + 1, arc_length.end() - 1, s);
    const auto i = static_cast<std::size_t>(after - arc_length.begin()) - 1;
    const double h = arc_length[i + 1] - arc_length[i];
    const double t = (s - arc_length[i]) / h;
    const double u = 1.0 - t;
    return u * u * (1.0 + 2.0 * t) * point[i] + t * t * (3.0 - 2.0 * t) * point[i + 1] +
           h * t * u * (u * tangent(i) - t * tangent(i + 1));
  }

  double distance(const Eigen::Vector3d& p) const
  {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < point.size(); ++i)
    {
      const Eigen::Vector3d e = point[i + 1] - point[i];
      const double t = std::max(0.0, std::min(1.0, (p - point[i]).dot(e) / e.squaredNorm()));
      nearest = std::min(nearest, (p - point[i] - t * e).squaredNorm());
    }
    return std::sqrt(nearest);
  }
};

/** Records of a run. */
struct Run
{
  SamplingResult result;
  std::vector<Shape> shapes;
  std::vector<double> force, energy;
  std::vector<std::size_t> resampled;  ///< steps preceded by a resampling
};

/** Case with its vessel. */
struct Setting
{
  explicit Setting(const SamplingCase& study) : scene(scene::parseScene(study.scene_yaml, study.name))
  {
    world = session::World::make(
        scene, scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired));
    steps = static_cast<std::size_t>(std::llround(study.duration / scene.solver.time_step));
  }

  /** Session of a scene that differs from the case in its sampling. */
  session::Session open(const scene::Scene& varied) const
  {
    session::Session session(world->with(varied));
    session.setLastStep(steps);
    return session;
  }

  scene::Scene scene;
  std::shared_ptr<const session::World> world;  ///< its vessel and wall are shared by all runs
  std::size_t steps = 0;
};

Shape shapeOf(const simulation::Simulation& simulation)
{
  const rod::Discretisation& wire = simulation.discretisation();
  const rod::State& state = simulation.state();
  Shape shape;
  for (int i = state.first_node; i < wire.nodes(); ++i)
  {
    shape.arc_length.push_back(wire.position[i] - (wire.length() - state.inserted_length));
    shape.point.push_back(state.position[i]);
  }
  return shape;
}

Run runOnce(const Setting& setting, const scene::Scene& scene, const std::string& name)
{
  session::Session session = setting.open(scene);
  const simulation::Simulation& simulation = session.simulation();
  Run run;
  run.result.sampling = name;
  const auto shape_interval = static_cast<std::size_t>(std::llround(kShapeInterval / scene.solver.time_step));
  std::vector<double> before = simulation.discretisation().position;
  for (std::size_t k = 0; k < setting.steps; ++k)
  {
    const double begin = processorSeconds();
    session.step();
    run.result.step_time += processorSeconds() - begin;
    run.result.sampling_time += simulation.timer().seconds(Phase::kSampling);
    const rod::Discretisation& wire = simulation.discretisation();
    if (wire.position != before)
    {
      before = wire.position;
      run.resampled.push_back(k);
    }
    const double inserted = wire.nodes() - simulation::firstInsertedNode(simulation);
    run.result.mean_inserted_nodes += inserted;
    run.result.largest_inserted_nodes = std::max(run.result.largest_inserted_nodes, inserted);
    run.result.mean_simulated_nodes += wire.nodes() - simulation.state().first_node;
    run.result.penetration = std::max(run.result.penetration, simulation.surfacePenetration());
    run.result.unsolved += !simulation.report().solved;
    run.force.push_back(simulation.state().hand_force);
    if ((k + 1) % shape_interval != 0)
      continue;
    run.shapes.push_back(shapeOf(simulation));
    run.energy.push_back(simulation.energy().bending);
  }
  const auto steps = static_cast<double>(setting.steps);
  run.result.step_time /= steps;
  run.result.sampling_time /= steps;
  run.result.mean_inserted_nodes /= steps;
  run.result.mean_simulated_nodes /= steps;
  run.result.resamplings = static_cast<int>(run.resampled.size());
  return run;
}

/** Run with the shortest time per step of several equal runs. */
Run runTimed(const Setting& setting, const scene::Scene& scene, const std::string& name)
{
  Run run = runOnce(setting, scene, name);
  for (int k = 1; k < kTimedRuns; ++k)
  {
    const SamplingResult again = runOnce(setting, scene, name).result;
    if (again.step_time >= run.result.step_time)
      continue;
    run.result.step_time = again.step_time;
    run.result.sampling_time = again.sampling_time;
  }
  return run;
}

scene::Scene uniformScene(const scene::Scene& scene, double edge)
{
  scene::Scene uniform = scene;
  uniform.sampling.kind = scene::SamplingKind::kUniform;
  uniform.sampling.nodes = static_cast<int>(std::lround(scene.instruments.front().instrument.wire.length() / edge)) + 1;
  return uniform;
}

/** Mean force over the window that ends at each step. */
std::vector<double> windowMean(const std::vector<double>& force, double time_step)
{
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(kForceWindow / time_step)));
  std::vector<double> mean(force.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < force.size(); ++k)
  {
    sum += force[k] - (k >= window ? force[k - window] : 0.0);
    mean[k] = sum / static_cast<double>(std::min(window, k + 1));
  }
  return mean;
}

double rmsDifference(const std::vector<double>& a, const std::vector<double>& b, std::size_t from)
{
  double sum = 0.0;
  for (std::size_t k = from; k < a.size(); ++k)
    sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / static_cast<double>(a.size() - from));
}

void compareShapes(const Run& reference, Run& run)
{
  double sum = 0.0;
  double tips = 0.0;
  double points = 0.0;
  double peak = 0.0;
  for (std::size_t k = 0; k < run.shapes.size(); ++k)
  {
    for (double s = 0.0; s <= run.shapes[k].arc_length.back(); s += kPointSpacing)
    {
      const double distance = reference.shapes[k].distance(run.shapes[k].at(s));
      sum += distance * distance;
      points += 1.0;
      run.result.max_distance = std::max(run.result.max_distance, distance);
    }
    const double tip = (run.shapes[k].point.back() - reference.shapes[k].point.back()).norm();
    tips += tip * tip;
    run.result.max_tip_error = std::max(run.result.max_tip_error, tip);
    run.result.energy_error = std::max(run.result.energy_error, std::abs(run.energy[k] - reference.energy[k]));
    peak = std::max(peak, reference.energy[k]);
  }
  run.result.rms_distance = std::sqrt(sum / points);
  run.result.rms_tip_error = std::sqrt(tips / static_cast<double>(run.shapes.size()));
  if (peak > 0.0)
    run.result.energy_error /= peak;
}

void compareForces(const Run& reference, Run& run, double time_step)
{
  const auto start = static_cast<std::size_t>(kStart / time_step);
  const std::vector<double> mean = windowMean(reference.force, time_step);
  double peak = 0.0;
  for (std::size_t k = start; k < mean.size(); ++k)
    peak = std::max(peak, std::abs(mean[k]));
  run.result.force_peak = peak;
  run.result.force_error = rmsDifference(mean, windowMean(run.force, time_step), start) / peak;
  run.result.raw_force_error = rmsDifference(reference.force, run.force, start) / peak;
  for (std::size_t k = start; k < run.force.size(); ++k)
    run.result.largest_jump = std::max(run.result.largest_jump, std::abs(run.force[k] - run.force[k - 1]) / peak);
}

/** Force of a step without the resampling before it. */
double forceWithoutResampling(const Setting& setting, const scene::Scene& scene, std::size_t step)
{
  session::Session session = setting.open(scene);
  session.step(static_cast<int>(step));
  session.simulation().keepSampling();
  session.step();
  return session.simulation().state().hand_force;
}

/** Measures the effect of the resamplings with the largest change of the force. */
void measureJumps(const Setting& setting, const scene::Scene& scene, int samples, Run& run)
{
  const auto start = static_cast<std::size_t>(kStart / scene.solver.time_step);
  std::vector<std::size_t> steps;
  for (const std::size_t step : run.resampled)
    if (step >= start)
      steps.push_back(step);
  const auto change = [&run](std::size_t step) { return std::abs(run.force[step] - run.force[step - 1]); };
  std::stable_sort(steps.begin(), steps.end(),
                   [&change](std::size_t a, std::size_t b) { return change(a) > change(b); });
  steps.resize(std::min(steps.size(), static_cast<std::size_t>(std::max(0, samples))));
  for (const std::size_t step : steps)
  {
    const double difference = std::abs(run.force[step] - forceWithoutResampling(setting, scene, step));
    run.result.resampling_jump = std::max(run.result.resampling_jump, difference / run.result.force_peak);
  }
}

}  // namespace

std::vector<SamplingResult> studySampling(const SamplingCase& study, int jump_samples, const Progress& progress)
{
  const Setting setting(study);
  progress(0.0, study.name + ": reference");
  std::vector<Run> runs;
  runs.push_back(runOnce(setting, uniformScene(setting.scene, kReferenceEdge), "uniform 0.125 mm (reference)"));
  progress(0.5, study.name + ": uniform 0.5 mm");
  runs.push_back(runTimed(setting, uniformScene(setting.scene, kFineEdge), "uniform 0.5 mm"));
  progress(0.6, study.name + ": uniform 0.8 mm");
  runs.push_back(runTimed(setting, uniformScene(setting.scene, kCoarseEdge), "uniform 0.8 mm"));
  progress(0.7, study.name + ": adaptive");
  scene::Scene adaptive = setting.scene;
  adaptive.sampling.kind = scene::SamplingKind::kAdaptive;
  adaptive.sampling.min_edge = study.min_edge;
  adaptive.sampling.max_edge = study.max_edge;
  adaptive.sampling.turn_per_edge = study.turn_per_edge;
  runs.push_back(runTimed(setting, adaptive, "adaptive"));
  progress(0.8, study.name + ": uniform with as many nodes");
  const double share = runs[1].result.mean_simulated_nodes / runs[3].result.mean_simulated_nodes;
  runs.push_back(runTimed(setting, uniformScene(setting.scene, kFineEdge * share), "uniform, as many nodes"));
  std::vector<SamplingResult> results;
  for (Run& run : runs)
  {
    run.result.case_name = study.name;
    compareShapes(runs.front(), run);
    compareForces(runs.front(), run, setting.scene.solver.time_step);
  }
  progress(0.9, study.name + ": jumps of the force");
  measureJumps(setting, adaptive, jump_samples, runs[3]);
  results.reserve(runs.size());
  for (const Run& run : runs)
    results.push_back(run.result);
  return results;
}

std::vector<SamplingVerdict> judgeSampling(const std::vector<SamplingResult>& results)
{
  const SamplingResult& fine = results.at(1);
  const SamplingResult& adaptive = results.at(3);
  const SamplingResult& as_many = results.at(4);
  const double as_many_share = fine.rms_distance / as_many.rms_distance;
  return {
      {"RMS distance / uniform 0.5 mm", adaptive.rms_distance / fine.rms_distance, 1.1, 1.0},
      {"largest distance [m]", adaptive.max_distance, 0.2e-3, fine.max_distance},
      {"largest tip error [m]", adaptive.max_tip_error, 0.2e-3, fine.max_tip_error},
      {"bending energy", adaptive.energy_error, 0.02, fine.energy_error},
      {"hand force, NRMSE", adaptive.force_error, 0.05, fine.force_error},
      {"hand force, jump by resampling", adaptive.resampling_jump, 0.02, 0.0},
      {"time / uniform 0.5 mm", adaptive.step_time / fine.step_time, 0.6, 1.0},
      {"RMS distance / uniform with as many nodes", adaptive.rms_distance / as_many.rms_distance, 1.0, as_many_share}};
}

}  // namespace endovascular_sim::benchmark
