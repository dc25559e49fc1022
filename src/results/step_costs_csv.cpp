#include "results/step_costs_csv.h"

#include "common/output_file.h"
#include "common/phase_timer.h"

namespace endovascular_sim::results
{

StepCostsFile::StepCostsFile(const std::string& file) : stream_(file)
{
  if (!stream_)
    throw writeError(file);
  stream_ << "step,us,solves,factorisations,truncations,hit_iteration_limit,contacts,detections";
  for (const char* phase : kPhaseNames)
    stream_ << ',' << phase << "_us";
  stream_ << '\n';
}

void StepCostsFile::add(const simulation::Simulation& simulation, double seconds)
{
  const rod::StepReport& report = simulation.report();
  const PhaseTimer& timer = simulation.timer();
  stream_ << simulation.steps() << ',' << 1e6 * seconds << ',' << report.solves << ',' << report.factorisations << ','
          << report.truncations << ',' << report.hit_iteration_limit << ',' << simulation.contactSet().features.size()
          << ',' << timer.entries(Phase::kCollision);
  for (std::size_t phase = 0; phase < kPhaseCount; ++phase)
    stream_ << ',' << 1e6 * timer.seconds(static_cast<Phase>(phase));
  stream_ << '\n';
}

bool StepCostsFile::flush()
{
  return static_cast<bool>(stream_.flush());
}

}  // namespace endovascular_sim::results
