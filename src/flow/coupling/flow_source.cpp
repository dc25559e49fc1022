#include "flow/coupling/flow_source.h"

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/text/format.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kSlowestRate = 1.0 / 3.0, kFastestRate = 5.0;  // [Hz]
constexpr double kLeastPressure = 2e3, kMostPressure = 4e4;     // [Pa]

}  // namespace

void archive(Archive& archive, FlowControls& controls)
{
  archive(controls.heart_rate, controls.mean_pressure, controls.hyperaemia);
  if (archive.reading())
    requireFinite(controls.heart_rate, controls.mean_pressure);
}

std::string refusalOf(const FlowControls& controls)
{
  const double rate = controls.heart_rate, pressure = controls.mean_pressure;
  if (rate != 0.0 && !(rate >= kSlowestRate && rate <= kFastestRate))
    return formatted("heart_rate is %g Hz; must be 0, or between %.3g and %.3g Hz", rate, kSlowestRate, kFastestRate);
  if (!(pressure >= kLeastPressure && pressure <= kMostPressure))
    return formatted("mean_pressure is %g Pa; must be between %g and %g Pa", pressure, kLeastPressure, kMostPressure);
  return "";
}

void archive(Archive& archive, BeatMeans& means)
{
  archive(means.root, means.readings, means.lesions, means.hyperaemia, means.step);
}

void IodineTotals::archive(Archive& archive)
{
  archive(injected, inside, left);
}

void archive(Archive& archive, FlowAnswer& answer)
{
  FlowField& field = answer.field;
  archive(answer.step, answer.state, field.phase, field.beats, field.ventricle, field.pressures, field.flows,
          field.areas, field.probes, field.readings, field.means, field.iodine, field.totals);
  if (archive.reading())
    requireFinite(field.pressures, field.flows, field.areas, field.readings, field.iodine);
}

}  // namespace endovascular_sim::flow
