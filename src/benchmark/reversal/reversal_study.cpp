#include "benchmark/reversal/reversal_study.h"

#include <memory>

#include "benchmark/reversal/reversal_runs.h"

namespace endovascular_sim::benchmark
{
namespace
{

struct Motion
{
  double rate;       ///< [rad/s]
  double time_step;  ///< [s]
};

/** The motions of the study; the first one, with the smallest steps, is the reference. */
std::vector<Motion> motions(bool quick)
{
  if (quick)
    return {{2.0, 5e-5}, {2.0, 1e-3}};
  return {{1.0, 1e-5}, {0.5, 1e-4}, {0.5, 1e-3}, {2.0, 1e-4}, {2.0, 5e-4},
          {2.0, 1e-3}, {2.0, 2e-3}, {6.0, 1e-4}, {6.0, 1e-3}, {6.0, 2e-3}};
}

void addCase(const std::string& name, ReversalCase& wire, const StudyOptions& options, const Progress& progress,
             double done, std::vector<Section>& sections)
{
  const std::vector<Motion> all = motions(options.quick);
  ReversalCurve reference;
  for (std::size_t k = 0; k < all.size(); ++k)
  {
    const Motion& motion = all[k];
    progress(done + 0.5 * static_cast<double>(k) / static_cast<double>(all.size()),
             name + " " + number(motion.rate) + " rad/s " + number(1e3 * motion.time_step) + " ms");
    ReversalMotion turn;
    turn.rate = motion.rate;
    turn.time_step = motion.time_step;
    const ReversalCurve curve = wire.run(turn);
    if (k == 0)
      reference = curve;
    for (std::size_t s = 0; s < curve.angle.size(); ++s)
      sections[0].table.add({name, number(motion.rate), number(1e3 * motion.time_step),
                             2 * s + 1 > curve.angle.size() ? "back" : "up", number(curve.angle[s]),
                             number(1e6 * curve.torque[s], 5)});
    sections[1].table.add(
        {name, number(motion.rate), number(1e3 * motion.time_step), number(1e6 * curve.slidingTorque(), 5),
         number(100.0 * (curve.slidingTorque() / reference.slidingTorque() - 1.0)),
         number(100.0 * worstDeviation(curve, reference)), number(curve.solves), number(curve.step_us)});
  }
}

}  // namespace

std::vector<TableSpec> reversalTables()
{
  return {
      {"reversal_curves",
       "Torque after a reversal",
       {"case", "rate [rad/s]", "step [ms]", "way", "angle [rad]", "torque [µN·m]"},
       "reversal.png"},
      {"reversal_errors",
       "Torque after a reversal: deviation from the limit of small steps",
       {"case", "rate [rad/s]", "step [ms]", "sliding torque [µN·m]", "its deviation [%]",
        "largest deviation on the way back [% of the sliding torque]", "factorisations per step", "time per step [µs]"},
       ""}};
}

std::vector<Section> reversalStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections = {Section(reversalTables(), "reversal_curves"),
                                   Section(reversalTables(), "reversal_errors")};
  sections[0].text =
      "A wire is turned by 2 rad and back. `bend`: straight 0.035\" wire, 120 mm in the tube of `tube.yaml`, μ = 0.1. "
      "`trough`: heavy soft wire in a straight cylindrical trough, μ = 0.2.";
  sections[1].text =
      "Reference: the first row of each case. Time and factorisations: mean over the second half of the way up, in "
      "which the wire slides.";
  addCase("bend", *reversalInBend(), options, progress, 0.0, sections);
  addCase("trough", *reversalInTrough(), options, progress, 0.5, sections);
  return sections;
}

}  // namespace endovascular_sim::benchmark
