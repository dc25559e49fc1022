#include "intervention/treatment.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace endovascular_sim::intervention
{
namespace
{

constexpr double kBodySpacing = 0.25e-3;  // m, of the axis's points

instrument::Balloon balloonOf(const instrument::Instrument& instrument)
{
  if (!instrument.balloon)
    throw InputError(instrument.name, "balloon", "has none; only a balloon_catheter treats a vessel");
  return *instrument.balloon;
}

}  // namespace

Treatment::Treatment(const instrument::Instrument& instrument, VesselOpening& opening)
  : inflation_(balloonOf(instrument)), opening_(opening)
{
  if (instrument.stent)
    stent_.emplace(*instrument.stent, *instrument.balloon);
}

bool Treatment::carriesStent() const
{
  return stent_ &&
         (stent_->state() == StentPlacement::State::kCrimped || stent_->state() == StentPlacement::State::kExpanding);
}

double Treatment::radiusAt(double from_tip) const
{
  const double balloon = inflation_.radiusAt(from_tip);
  if (!carriesStent())
    return balloon;
  const instrument::Balloon& data = inflation_.balloon();
  const bool within = std::abs(from_tip - data.from_tip - 0.5 * data.length) <= 0.5 * stent_->length();
  return within ? std::max(balloon, 0.5 * stent_->outerDiameter()) : balloon;
}

RoundBody Treatment::body(const ShaftLine& shaft) const
{
  const double begin = std::max(inflation_.begin(), shaft.begin());
  const double end = std::min(inflation_.end(), shaft.end());
  const int count = std::max(2, static_cast<int>(std::ceil((end - begin) / kBodySpacing)));
  RoundBody body;
  for (int k = 0; k <= count; ++k)
  {
    const double from_tip = begin + (end - begin) * k / count;
    body.axis.push_back(shaft.at(from_tip));
    body.radii.push_back(radiusAt(from_tip));
  }
  return body;
}

const MovedVertices& Treatment::step(double dt, double commanded, const ShaftLine& shaft, std::size_t most)
{
  events_ = TreatmentEvents{};
  const bool was_at_risk = opening_.atRisk();
  const BalloonInflation::Event event = inflation_.step(dt, commanded);
  events_.above_rated = event == BalloonInflation::Event::kAboveRated;
  events_.burst = event == BalloonInflation::Event::kBurst;
  if (carriesStent())
  {
    const bool was_over = stent_->overExpanded();
    events_.stent_placed =
        stent_->follow(shaft, inflation_.pressure(), inflation_.diameter()) == StentPlacement::State::kPlaced;
    events_.over_expanded = !was_over && stent_->overExpanded();
    if (events_.stent_placed)
      opening_.hold(stent_->sleeve());
  }
  const MovedVertices& moved = opening_.press(body(shaft), inflation_.pressure(), most);
  events_.at_risk = !was_at_risk && opening_.atRisk();
  return moved;
}

void Treatment::stripStent()
{
  if (stent_)
    stent_->stripOff();
}

}  // namespace endovascular_sim::intervention
