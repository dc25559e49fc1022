#include "intervention/treatment.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace endovascular_sim::intervention
{
namespace
{

constexpr double kBodySpacing = 0.25e-3;  // spacing of the points on the balloon's axis [m]

instrument::Balloon balloonOf(const instrument::Instrument& instrument)
{
  if (!instrument.balloon)
    throw InputError(instrument.name, "balloon", "is missing; a treatment requires a balloon_catheter");
  return *instrument.balloon;
}

}  // namespace

Treatment::Treatment(const instrument::Instrument& instrument) : inflation_(balloonOf(instrument))
{
  if (instrument.stent)
    stent_.emplace(*instrument.stent, *instrument.balloon);
}

bool Treatment::carriesStent() const
{
  return stent_ &&
         (stent_->state() == StentPlacement::State::kCrimped || stent_->state() == StentPlacement::State::kExpanding);
}

bool Treatment::isUnderStent(double from_tip) const
{
  const instrument::Balloon& data = inflation_.balloon();
  return carriesStent() && std::abs(from_tip - data.from_tip - 0.5 * data.length) <= 0.5 * stent_->length();
}

double Treatment::radiusAt(double from_tip) const
{
  const double balloon = inflation_.radiusAt(from_tip);
  return isUnderStent(from_tip) ? std::max(balloon, 0.5 * stent_->outerDiameter()) : balloon;
}

double Treatment::crossingRadiusAt(double from_tip) const
{
  const double balloon = inflation_.foldedRadiusAt(from_tip);
  return isUnderStent(from_tip) ? std::max(balloon, 0.5 * stent_->crimpedDiameter()) : balloon;
}

void Treatment::updateBalloonBody(const ShaftLine& shaft, double covered_from)
{
  RoundBody& body = load_.balloon;
  const double begin = std::max(inflation_.begin(), shaft.begin());
  const double end = std::min(inflation_.end(), shaft.end());
  const int count = std::max(2, static_cast<int>(std::ceil((end - begin) / kBodySpacing)));
  for (int k = 0; k <= count; ++k)
  {
    const double from_tip = begin + (end - begin) * k / count;
    body.axis.push_back(shaft.at(from_tip));
    body.radii.push_back(from_tip < covered_from ? radiusAt(from_tip) : 0.0);
  }
}

void Treatment::updateStent(const ShaftLine* shaft)
{
  if (!carriesStent())
    return;
  if (shaft == nullptr)
  {
    // A stent that expands outside of the vessel is lost.
    if (inflation_.diameter() > stent_->crimpedDiameter())
      stent_->dislodge();
    events_.stent_lost = events_.stent_lost || !carriesStent();
    return;
  }
  const bool was_over_expanded = stent_->overExpanded();
  const StentPlacement::State state = stent_->update(*shaft, inflation_.pressure(), inflation_.diameter());
  events_.over_expanded = !was_over_expanded && stent_->overExpanded();
  events_.stent_placed = state == StentPlacement::State::kPlaced;
}

const BalloonLoad& Treatment::step(double dt, double commanded, const ShaftLine* shaft, double covered_from)
{
  events_ = TreatmentEvents{};
  if (dislodged_)
  {
    events_.stent_lost = stent_->state() == StentPlacement::State::kLost;
    events_.stent_placed = !events_.stent_lost;
    dislodged_ = false;
  }
  const BalloonInflation::Event event = inflation_.step(dt, commanded);
  events_.above_rated = event == BalloonInflation::Event::kAboveRated;
  events_.burst = event == BalloonInflation::Event::kBurst;
  updateStent(shaft);
  load_.balloon.axis.clear();
  load_.balloon.radii.clear();
  load_.sleeve.reset();
  load_.pressure = shaft != nullptr ? inflation_.pressure() : 0.0;
  if (load_.pressure > 0.0)
    updateBalloonBody(*shaft, covered_from);
  if (events_.stent_placed)
    load_.sleeve = stent_->sleeve();
  return load_;
}

void Treatment::dislodgeStent()
{
  if (!carriesStent())
    return;
  stent_->dislodge();
  stent_->release();
  dislodged_ = true;
}

}  // namespace endovascular_sim::intervention
