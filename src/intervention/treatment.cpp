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

void Treatment::layBody(const ShaftLine& shaft, double covered_from)
{
  RoundBody& body = pressing_.balloon;
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

void Treatment::followStent(const ShaftLine* shaft)
{
  if (!carriesStent())
    return;
  if (shaft == nullptr)
  {
    // Opened outside of the vessel, it is of no use any more.
    if (inflation_.diameter() > stent_->crimpedDiameter())
      stent_->stripOff();
    events_.stent_lost = events_.stent_lost || !carriesStent();
    return;
  }
  const bool was_over = stent_->overExpanded();
  const StentPlacement::State state = stent_->follow(*shaft, inflation_.pressure(), inflation_.diameter());
  events_.over_expanded = !was_over && stent_->overExpanded();
  events_.stent_placed = state == StentPlacement::State::kPlaced;
}

const BalloonLoad& Treatment::step(double dt, double commanded, const ShaftLine* shaft, double covered_from)
{
  events_ = TreatmentEvents{};
  if (stripped_)
  {
    events_.stent_lost = stent_->state() == StentPlacement::State::kLost;
    events_.stent_placed = !events_.stent_lost;
    stripped_ = false;
  }
  const BalloonInflation::Event event = inflation_.step(dt, commanded);
  events_.above_rated = event == BalloonInflation::Event::kAboveRated;
  events_.burst = event == BalloonInflation::Event::kBurst;
  followStent(shaft);
  pressing_.balloon.axis.clear();
  pressing_.balloon.radii.clear();
  pressing_.sleeve.reset();
  pressing_.pressure = shaft != nullptr ? inflation_.pressure() : 0.0;
  if (pressing_.pressure > 0.0)
    layBody(*shaft, covered_from);
  if (events_.stent_placed)
    pressing_.sleeve = stent_->sleeve();
  return pressing_;
}

void Treatment::stripStent()
{
  if (!carriesStent())
    return;
  stent_->stripOff();
  stent_->release();
  stripped_ = true;
}

}  // namespace endovascular_sim::intervention
