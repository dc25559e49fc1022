#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scene/schema/scene_schema.h"

// Schema of faults of a robot's drives.

namespace endovascular_sim::scene
{
namespace
{

using robot::FaultKind;
using robot::FaultSettings;

/** Key of the amount of a fault. */
struct AmountKey
{
  FaultKind kind;
  const char* key;
  const Quantity& quantity;
  Range range;
};

const std::vector<AmountKey>& amountKeys()
{
  static const std::vector<AmountKey> keys = {
      {FaultKind::kSlipping, "share", quantities::kFraction, Range::between(0.0, 1.0)},
      {FaultKind::kDelayed, "delay", quantities::kDelay, Range::positive()},
      {FaultKind::kBacklash, "play", quantities::kBacklash, Range::positive()}};
  return keys;
}

void visitAmount(yaml::Fields& fields, FaultSettings& fault)
{
  for (const AmountKey& amount : amountKeys())
    if (amount.kind == fault.kind)
      fields.number(amount.key, fault.amount, amount.quantity, amount.range, Need::kRequired);
    else if (fields.reading() && fields.has(amount.key))
      fields.reject(amount.key, "belongs to kind " + robot::faultWords()[static_cast<std::size_t>(amount.kind)] +
                                    "; remove it, or change the kind");
}

void visitFault(yaml::Fields& fields, const Scene& scene, FaultSettings& fault)
{
  visitInstrumentName(fields, scene, fault.instrument);
  fields.option("axis", fault.axis, robot::axisWords(), Need::kRequired);
  fields.option("kind", fault.kind, robot::faultWords(), Need::kRequired);
  visitAmount(fields, fault);
  fields.number("start", fault.start, quantities::kProfileTime, Range::nonNegative());
  double end = std::isfinite(fault.end) ? fault.end : std::numeric_limits<double>::quiet_NaN();
  fields.optionalNumber("end", end, quantities::kProfileTime, Range::nonNegative());
  fault.end = std::isnan(end) ? std::numeric_limits<double>::infinity() : end;
  fields.number("probability", fault.probability, quantities::kFraction, Range::between(0.0, 1.0));
  fields.number("interval", fault.interval, quantities::kDuration, Range::positive());
  fields.bigInteger("seed", fault.seed);
  if (!fields.reading())
    return;
  if (fault.end <= fault.start)
    fields.reject("end", "is not after the start; must be more than " + std::to_string(fault.start) + " s");
}

}  // namespace

void visitFaults(yaml::Fields& fields, Scene& scene)
{
  fields.list(
      "faults", scene.faults.size(), [&scene](std::size_t size) { scene.faults.resize(size); },
      [&scene](yaml::Fields& fault, std::size_t k) { visitFault(fault, scene, scene.faults[k]); }, Need::kRequired);
  if (fields.reading() && !scene.introducer)
    fields.reject("faults", "need a drive through an introducer; remove them from a bench scene");
}

}  // namespace endovascular_sim::scene
