#include "benchmark/studies/sampling_sections.h"

#include "benchmark/studies/sampling_study.h"

namespace endovascular_sim::benchmark
{

std::vector<TableSpec> samplingTables()
{
  return {{"sampling_runs",
           "Runs",
           {"case", "sampling", "nodes inside, mean", "nodes simulated, mean", "µs per step", "of it sampling",
            "RMS distance [mm]", "largest [mm]", "tip, RMS [mm]", "tip, largest [mm]", "bending energy error",
            "hand force error", "force peak [mN]", "penetration [mm]", "resamplings"},
           "sampling.png"},
          {"sampling_measures",
           "Acceptance measures of adaptive sampling",
           {"case", "measure", "adaptive", "limit", "uniform 0.5 mm", "holds"},
           ""}};
}

std::vector<Section> samplingSections(const StudyOptions& options, const Progress& progress)
{
  Section runs(samplingTables(), "sampling_runs");
  runs.text =
      "Each wire is pushed, withdrawn and rotated, and compared over the whole motion with uniform edges of 0.125 mm. "
      "Force error: RMS difference of 20 ms means over the peak of the reference. For comparison, Fig. 8 of the paper "
      "has 142 nodes at 0.5 mm, 88 at 0.8 mm and about 75 with adaptive sampling.";
  Section verdicts(samplingTables(), "sampling_measures");
  const std::vector<SamplingCase> cases = samplingCases(options.vessel_mesh, options.quick);
  int held = 0;
  int total = 0;
  for (std::size_t k = 0; k < cases.size(); ++k)
  {
    const double begin = static_cast<double>(k) / static_cast<double>(cases.size());
    const auto part = [&](double done, const std::string& what)
    { progress(begin + done / static_cast<double>(cases.size()), cases[k].name + ", " + what); };
    const std::vector<SamplingResult> results = studySampling(cases[k], options.quick ? 3 : 20, part);
    for (const SamplingResult& r : results)
      runs.table.add({r.case_name, r.sampling, number(r.mean_inserted_nodes), number(r.mean_simulated_nodes),
                      number(1e6 * r.step_time), number(1e6 * r.sampling_time), number(1e3 * r.rms_distance),
                      number(1e3 * r.max_distance), number(1e3 * r.rms_tip_error), number(1e3 * r.max_tip_error),
                      number(r.energy_error), number(r.force_error), number(1e3 * r.force_peak),
                      number(1e3 * r.penetration), std::to_string(r.resamplings)});
    for (const SamplingVerdict& v : judgeSampling(results))
    {
      verdicts.table.add(
          {cases[k].name, v.measure, number(v.value), number(v.limit), number(v.uniform), v.holds() ? "yes" : "no"});
      held += v.holds() ? 1 : 0;
      ++total;
    }
  }
  verdicts.text = std::to_string(held) + " of " + std::to_string(total) + " measures are within their limits.";
  if (options.vessel_mesh.empty())
    verdicts.text += " Omitted: the case in aortic_arch_tree.obj, whose mesh was not given.";
  return {runs, verdicts};
}

}  // namespace endovascular_sim::benchmark
