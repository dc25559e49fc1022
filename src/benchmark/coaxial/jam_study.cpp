#include "benchmark/coaxial/jam_study.h"

#include <algorithm>
#include <cmath>

#include "benchmark/coaxial/jam_runs.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kSmallGrip = 5.0;  // N: quick study; up to here the contacts of the pushed wire do not chatter
constexpr double kRelativeTolerance = 0.05;
constexpr double kTolerance = 5e-3;  // N

}  // namespace

std::vector<TableSpec> jamTables()
{
  return {{"jam",
           "Jammed wire: force at its hand",
           {"case", "load at the stop [N]", "wire [N]", "catheter [N]", "rigid tube, pushed [N]",
            "static, free mouth [N]", "static, loaded mouth [N]", "deviation from free [%]",
            "deviation from loaded [%]", "deviation from loaded over 5 % + 5 mN", "largest hand over its grip",
            "largest layer over both grips", "unexplained work [%]"},
           ""}};
}

std::vector<Section> jamStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections = {Section(jamTables(), "jam")};
  sections[0].text =
      "A wire is pushed through a catheter with bends of 30 mm against a closed end. Load and forces: the state with "
      "the largest force of the wire before a hand slips. Reference: the same wire in a rigid tube along the recorded "
      "axis, up to the tip of the catheter, in static equilibrium. Its end bears the forces on the wire beyond the "
      "catheter: with a free mouth their part along the tube, with a loaded mouth all of them, and their moment. For "
      "comparison, up to 5 N, the force of a wire that is pushed slowly.";
  const std::vector<JamCase> cases = jamCases();
  for (std::size_t k = 0; k < cases.size(); ++k)
  {
    const JamCase& at = cases[k];
    if (options.quick && at.grip > kSmallGrip)
      continue;
    progress(static_cast<double>(k) / static_cast<double>(cases.size()), at.name);
    const JamResult result = runJam(at);
    const JamSample& pushed = result.pushed;
    const bool compared = at.grip <= kSmallGrip;
    const double free = staticForceInRigidTube(at, pushed, JamMouth::kFree);
    const double loaded = staticForceInRigidTube(at, pushed, JamMouth::kLoaded);
    const double bound = kRelativeTolerance * pushed.wire + kTolerance;
    sections[0].table.add({at.name, number(pushed.tip_load, 4), number(pushed.wire, 4), number(pushed.catheter, 4),
                           compared ? number(forceInRigidTube(at, pushed, JamReference()), 4) : "", number(free, 4),
                           number(loaded, 4), number(100.0 * (pushed.wire - free) / pushed.wire),
                           number(100.0 * (pushed.wire - loaded) / pushed.wire),
                           number(std::abs(pushed.wire - loaded) / bound), number(result.hand_ratio, 4),
                           number(result.layer_force, 4), number(100.0 * result.unexplained)});
  }
  return sections;
}

}  // namespace endovascular_sim::benchmark
