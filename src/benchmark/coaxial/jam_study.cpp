#include "benchmark/coaxial/jam_study.h"

#include <cmath>
#include <stdexcept>

#include "benchmark/coaxial/jam_runs.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kLargestQuickGrip = 5.0;  // N, of the quick study
constexpr double kRelativeTolerance = 0.05;
constexpr double kTolerance = 5e-3;  // N

/** "-" where the reference does not arrive. */
std::string referenceOf(const JamCase& at, const JamSample& sample, double& force)
{
  try
  {
    force = forceInRigidTube(at, sample, referenceFor(at));
    return number(force, 4);
  }
  catch (const std::runtime_error&)
  {
    force = NAN;
    return "-";
  }
}

}  // namespace

std::vector<TableSpec> jamTables()
{
  return {{"jam",
           "Jammed wire: force at its hand",
           {"case", "load at the stop [N]", "wire [N]", "catheter [N]", "reference [N]", "deviation [%]",
            "deviation over 5 % + 5 mN", "largest hand over its grip", "largest layer over both grips",
            "unexplained work [%]"},
           ""}};
}

std::vector<Section> jamStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections = {Section(jamTables(), "jam")};
  sections[0].text =
      "A wire is pushed through a catheter with bends of 30 mm against a closed end. Load and forces: the state with "
      "the largest force of the wire before a hand slips. Reference: the same wire, pushed against this load "
      "through a rigid tube along the recorded axis.";
  const std::vector<JamCase> cases = jamCases();
  for (std::size_t k = 0; k < cases.size(); ++k)
  {
    const JamCase& at = cases[k];
    if (options.quick && at.grip > kLargestQuickGrip)
      continue;
    progress(static_cast<double>(k) / static_cast<double>(cases.size()), at.name);
    const JamResult result = runJam(at);
    const JamSample& pushed = result.pushed;
    double reference = 0.0;
    const std::string text = referenceOf(at, pushed, reference);
    const double deviation = pushed.wire - reference;
    sections[0].table.add({at.name, number(pushed.tip_load, 4), number(pushed.wire, 4), number(pushed.catheter, 4),
                           text, number(100.0 * deviation / reference),
                           number(std::abs(deviation) / (kRelativeTolerance * reference + kTolerance)),
                           number(result.hand_ratio, 4), number(result.layer_force, 4),
                           number(100.0 * result.unexplained)});
  }
  return sections;
}

}  // namespace endovascular_sim::benchmark
