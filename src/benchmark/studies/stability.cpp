#include "benchmark/studies/stability.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <sstream>
#include <thread>

#include "benchmark/studies/hard_case.h"

namespace endovascular_sim::benchmark
{
namespace
{

const std::vector<std::string> kColumns = {
    "case",  "scheme", "verdict",         "reason", "strain",    "penetration [mm]", "energy excess",
    "steps", "turned", "solves per step", "halved", "cut short", "refused"};
const std::vector<std::string> kCompared = {"kkt", "paper"};
constexpr int kSampleSteps = 600;  // largest number of steps of a sample of the hypercube

void addRow(Table& table, const HardCase& hard, const Verdict& verdict)
{
  table.add({hard.label, hard.scheme, verdict.word, verdict.reason, number(verdict.max_strain),
             number(1e3 * verdict.penetration), number(std::max(0.0, verdict.energy_excess), 2),
             std::to_string(verdict.steps), number(verdict.turned, 2), number(verdict.solves),
             std::to_string(verdict.bisections), std::to_string(verdict.truncated), std::to_string(verdict.rejected)});
}

template <typename Value, typename Set>
void vary(std::vector<HardCase>& cases, const std::string& name, const std::string& unit, double scale,
          const std::vector<Value>& values, Set set)
{
  for (const Value& value : values)
  {
    HardCase hard;
    hard.label = name + " " + number(scale * static_cast<double>(value)) + (unit.empty() ? "" : " " + unit);
    set(hard, value);
    cases.push_back(hard);
  }
}

std::vector<HardCase> oneAtATime(bool quick)
{
  std::vector<HardCase> cases(1);
  cases[0].label = "baseline";
  vary<double>(cases, "EI", "N·mm²", 1e6, {1.6e-6, 20e-6, 2463e-6, 5000e-6},
               [](HardCase& h, double v) { h.bending_stiffness = v; });
  vary<double>(cases, "Δt", "ms", 1e3, {5e-5, 5e-4, 2e-3, 5e-3, 1e-2, 2e-2},
               [](HardCase& h, double v) { h.time_step = v; });
  vary<double>(cases, "speed", "mm/s", 1e3, {1e-3, 0.1, 0.5}, [](HardCase& h, double v) { h.speed = v; });
  vary<double>(cases, "twist", "turns", 1.0, {5.0, 20.0, 100.0},
               [](HardCase& h, double v)
               {
                 h.turns = v;
                 h.whole = true;
               });
  vary<double>(cases, "bend radius", "mm", 1e3, {2e-3, 5e-3, 1e-2},
               [](HardCase& h, double v)
               {
                 h.bend_radius = v;
                 h.bending_stiffness = 20e-6;
                 h.nodes = 400;
               });
  vary<double>(cases, "tip radius", "mm", 1e3, {2e-3, 5e-3},
               [](HardCase& h, double v)
               {
                 h.tip_radius = v;
                 h.nodes = 400;
               });
  vary<int>(cases, "nodes", "", 1.0,
            quick ? std::vector<int>{3, 20, 600} : std::vector<int>{3, 10, 20, 50, 600, 2000, 5000},
            [](HardCase& h, int v) { h.nodes = v; });
  vary<double>(cases, "stiffness jump at the tip, 1 :", "", 1.0, {100.0, 1000.0},
               [](HardCase& h, double v) { h.stiffness_jump = v; });
  vary<double>(cases, "random displacement of every node by", "mm", 1e3, {0.1e-3, 1e-3, 5e-3},
               [](HardCase& h, double v) { h.perturbation = v; });
  vary<double>(cases, "two edges folded to", "°", 180.0 / M_PI, {0.5, 0.1, 0.01},
               [](HardCase& h, double v) { h.fold_angle = v; });
  HardCase hard;
  hard.label = "edges from 0.2 to 6 mm";
  hard.sampling = "{kind: adaptive, min_edge: 0.2e-3, max_edge: 6.0e-3, turn_per_edge: 0.02}";
  cases.push_back(hard);
  hard.label = "edges from 0.06 to 6 mm";
  hard.sampling = "{kind: adaptive, min_edge: 0.06e-3, max_edge: 6.0e-3, turn_per_edge: 0.02}";
  cases.push_back(hard);
  hard = HardCase();
  hard.label = "no motion";
  hard.speed = 0.0;
  hard.turns = 0.0;
  cases.push_back(hard);
  hard = HardCase();
  hard.label = "sudden reversals at 500 mm/s";
  hard.speed = 0.5;
  hard.reverses = true;
  cases.push_back(hard);
  return cases;
}

/** Latin hypercube over EI, Δt, speed, turns, bend radius, tip radius and nodes, on logarithmic scales except for the
 *  turns. */
std::vector<HardCase> latinHypercube(int samples)
{
  constexpr int kFactors = 7;
  std::mt19937 random(20260101);
  std::vector<std::vector<double>> share(kFactors, std::vector<double>(static_cast<std::size_t>(samples)));
  for (std::vector<double>& column : share)
  {
    std::vector<int> order(static_cast<std::size_t>(samples));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    for (int k = 0; k < samples; ++k)
      column[k] = (order[k] + std::uniform_real_distribution<double>(0.0, 1.0)(random)) / samples;
  }
  const auto scaled = [](double low, double high, double t) { return low * std::pow(high / low, t); };
  std::vector<HardCase> cases;
  for (int k = 0; k < samples; ++k)
  {
    HardCase hard;
    hard.label = "sample " + std::to_string(k + 1);
    hard.bending_stiffness = scaled(1.6e-6, 5000e-6, share[0][k]);
    hard.time_step = scaled(5e-5, 2e-2, share[1][k]);
    hard.speed = scaled(1e-3, 0.5, share[2][k]);
    hard.turns = 100.0 * share[3][k] * share[3][k] * share[3][k];
    hard.bend_radius = scaled(2e-3, 0.06, share[4][k]);
    hard.tip_radius = scaled(2e-3, 0.02, share[5][k]);
    // At least two edges per radius of the bend; coarser wires cannot follow it.
    hard.nodes = static_cast<int>(scaled(std::max(20.0, 2.0 * 0.15 / hard.bend_radius), 1000.0, share[6][k]));
    cases.push_back(hard);
  }
  return cases;
}

/** Label of a sample with its factors. */
std::string describe(const HardCase& hard)
{
  return hard.label + ": EI " + number(1e6 * hard.bending_stiffness) + " N·mm², Δt " + number(1e3 * hard.time_step) +
         " ms, " + number(1e3 * hard.speed) + " mm/s, " + number(hard.turns) + " turns, bend " +
         number(1e3 * hard.bend_radius) + " mm, tip " + number(1e3 * hard.tip_radius) + " mm, " +
         std::to_string(hard.nodes) + " nodes";
}

/** Runs all cases with all compared schemes in parallel on all processors.
 *  @return number of cases by scheme and verdict */
std::map<std::string, std::map<std::string, int>> run(const std::vector<HardCase>& cases, Table& table, int max_steps,
                                                      const Progress& progress, double begin, double end)
{
  std::vector<HardCase> jobs;
  for (const std::string& scheme : kCompared)
    for (HardCase hard : cases)
    {
      hard.scheme = scheme;
      jobs.push_back(hard);
    }
  // Longest cases first, so that no processor idles at the end.
  std::vector<std::size_t> order(jobs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b)
                   { return expectedWork(jobs[a], max_steps) > expectedWork(jobs[b], max_steps); });
  std::vector<Verdict> verdicts(jobs.size());
  std::size_t next = 0;
  std::mutex mutex;
  const auto work = [&]()
  {
    while (true)
    {
      std::unique_lock<std::mutex> lock(mutex);
      if (next == jobs.size())
        return;
      const std::size_t job = order[next];
      progress(begin + (end - begin) * static_cast<double>(next++) / static_cast<double>(jobs.size()),
               jobs[job].scheme + ", " + jobs[job].label);
      lock.unlock();
      verdicts[job] = judge(jobs[job], max_steps);
    }
  };
  std::vector<std::thread> workers;
  for (unsigned k = 1; k < std::thread::hardware_concurrency(); ++k)
    workers.emplace_back(work);
  work();
  for (std::thread& worker : workers)
    worker.join();
  std::map<std::string, std::map<std::string, int>> counts;
  for (std::size_t job = 0; job < jobs.size(); ++job)
  {
    ++counts[jobs[job].scheme][verdicts[job].word];
    addRow(table, jobs[job], verdicts[job]);
  }
  return counts;
}

std::string counted(std::map<std::string, std::map<std::string, int>>& counts)
{
  std::string text;
  for (const std::string& scheme : kCompared)
    text += "`" + scheme + "`: " + std::to_string(counts[scheme]["good"]) + " good, " +
            std::to_string(counts[scheme]["rejected"]) + " rejected, " + std::to_string(counts[scheme]["bad"]) +
            " bad. ";
  return text;
}

}  // namespace

std::vector<TableSpec> stabilityTables()
{
  return {{"stability_factors", "Hard cases, one factor at a time", kColumns, ""},
          {"stability_samples", "Hard cases, Latin hypercube", kColumns, ""}};
}

std::vector<Section> stabilityStudy(const StudyOptions& options, const Progress& progress)
{
  const int max_steps = options.quick ? 600 : 1200;
  Section single(stabilityTables(), "stability_factors");
  auto counts = run(oneAtATime(options.quick), single.table, max_steps, progress, 0.0, 0.4);
  single.text =
      "Baseline: a J wire (EI 300 N·mm², 150 nodes) pushed 60 mm at 35 mm/s through a 90° bend of 30 mm radius, Δt 1 "
      "ms, half a turn. Each further case changes one factor. Good: no NaN, strain ≤ 1e-3, penetration of the surface "
      "≤ 0.1 mm, no node outside, no more energy than the applied work. Rejected: rejected steps, in which the wire "
      "is held, or "
      "a rejected scene. Self-contact of the wire is out of scope. " +
      counted(counts);
  Section cube(stabilityTables(), "stability_samples");
  std::vector<HardCase> samples = latinHypercube(options.quick ? 20 : 200);
  for (HardCase& hard : samples)
    hard.label = describe(hard);
  counts = run(samples, cube.table, kSampleSteps, progress, 0.4, 1.0);
  cube.text = "All factors vary at once, with at least two edges per radius of the bend. " + counted(counts);
  return {single, cube};
}

}  // namespace endovascular_sim::benchmark
