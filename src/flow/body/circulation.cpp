#include "flow/body/circulation.h"

#include <cmath>

#include "common/quantities.h"
#include "common/text/format.h"
#include "yaml/reader.h"

namespace endovascular_sim::flow
{
namespace
{

using yaml::Need;
using yaml::Range;

void visitHeart(yaml::Fields& fields, HeartSettings& heart)
{
  fields.number("rate", heart.rate, quantities::kHeartRate, Range::positive());
  fields.number("output", heart.output, quantities::kBloodFlow, Range::positive());
  fields.number("largest_stroke", heart.largest_stroke, quantities::kStrokeVolume, Range::positive());
  fields.number("contraction", heart.contraction, quantities::kPulseTime, Range::positive());
  fields.number("relaxation", heart.relaxation, quantities::kPulseTime, Range::positive());
  fields.number("filling_pressure", heart.filling_pressure, quantities::kBloodPressure, Range::nonNegative());
  fields.number("largest_pressure", heart.largest_pressure, quantities::kPressure, Range::positive());
  fields.number("backflow", heart.backflow, quantities::kFraction, Range::between(0.0, 0.2));
  fields.number("closure", heart.closure, quantities::kPulseTime, Range::positive());
}

void visitWall(yaml::Fields& fields, WallElasticity& wall)
{
  fields.number("k1", wall.k1, quantities::kWallModulus, Range::nonNegative());
  fields.number("k2", wall.k2, quantities::kNumber, Range{-1e6, 0.0, false, false});
  fields.number("k3", wall.k3, quantities::kWallModulus, Range::positive());
  fields.number("pressure", wall.pressure, quantities::kBloodPressure, Range::nonNegative());
}

void visitOutlets(yaml::Fields& fields, Circulation& circulation)
{
  fields.number("decay", circulation.decay, quantities::kPulseTime, Range::positive());
  fields.number("muscle_decay", circulation.muscle_decay, quantities::kPulseTime, Range::positive());
  fields.number("muscle_proximal", circulation.muscle_proximal, quantities::kFraction, Range::between(0.05, 0.95));
  fields.number("hyperaemia", circulation.hyperaemia, quantities::kScale, Range{1.0, 10.0, false, false});
  double sum = 0.0;
  fields.list(
      "territories", circulation.territories.size(), [&](std::size_t size) { circulation.territories.resize(size); },
      [&](yaml::Fields& item, std::size_t k)
      {
        Territory& territory = circulation.territories[k];
        item.text("branch", territory.branch, Need::kRequired);
        item.number("share", territory.share, quantities::kFraction, Range::positiveUpTo(1.0), Need::kRequired);
        item.number("muscle", territory.muscle, quantities::kFraction, Range::between(0.0, 1.0));
        sum += territory.share;
        for (std::size_t other = 0; other < k; ++other)
          if (circulation.territories[other].branch == territory.branch)
            item.reject("branch", "\"" + territory.branch + "\" has a share already; keep one of the two");
      },
      Need::kRequired);
  if (fields.reading() && sum > 1.0 + 1e-9)
    fields.reject("territories", formatted("their shares add up to %.4g; the sum must be at most 1", sum));
}

}  // namespace

double WallElasticity::at(double radius) const
{
  return k1 * std::exp(k2 * radius) + k3;
}

void visitCirculation(yaml::Fields& fields, Circulation& circulation)
{
  fields.map("blood",
             [&](yaml::Fields& blood)
             {
               blood.number("density", circulation.density, quantities::kFluidDensity, Range::positive());
               blood.number("viscosity", circulation.viscosity, quantities::kViscosity, Range::positive());
             });
  fields.map("heart", [&](yaml::Fields& heart) { visitHeart(heart, circulation.heart); });
  fields.map("wall", [&](yaml::Fields& wall) { visitWall(wall, circulation.wall); });
  fields.number("mean_pressure", circulation.mean_pressure, quantities::kBloodPressure, Range::positive());
  fields.number("venous_pressure", circulation.venous_pressure, quantities::kBloodPressure, Range::nonNegative());
  if (fields.reading() && circulation.venous_pressure >= circulation.mean_pressure)
    fields.reject("venous_pressure", "must be less than mean_pressure");
  if (circulation.heart.largest_pressure < 2.0 * circulation.mean_pressure)
    fields.reject("heart.largest_pressure", "must be at least twice mean_pressure, or the heart cannot reach it");
  fields.map("outlets", [&](yaml::Fields& outlets) { visitOutlets(outlets, circulation); });
}

Circulation readCirculation(const std::string& file)
{
  const yaml::Node root =
      yaml::readTree(file, "give the path of a circulation, or the name of one of config/hemodynamics");
  yaml::Reader reader(root, nullptr);
  Circulation circulation;
  visitCirculation(reader, circulation);
  reader.finish();
  return circulation;
}

}  // namespace endovascular_sim::flow
