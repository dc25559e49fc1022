#include "simulation/contrast_injections.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kRounding = 1e-9;  // of times [s]
constexpr double kMillilitre = 1e-6;
constexpr auto kTag = "contrast";  // in saved states

}  // namespace

ContrastInjections::ContrastInjections(const scene::Scene& scene)
  : scene_(scene.contrast.value()),
    instrument_(static_cast<int>(scene.injectingInstrument())),
    time_step_(scene.flow.value().time_step),
    injector_(scene_.syringe()),
    lumens_(scene.instruments.size(), 0.0)
{
  const instrument::Instrument& instrument = scene.instruments.at(scene.injectingInstrument()).instrument;
  from_tip_ = instrument::openingsOf(instrument);
  dead_volume_ = units::kPi * instrument.inner_radius * instrument.inner_radius * instrument.wire.length();
}

/** Distances from the tip of the openings in the vessel: beyond the introducer, and not in an outer instrument [m]. */
std::vector<double> ContrastInjections::openings(const std::vector<double>& insertions) const
{
  const auto own = static_cast<std::size_t>(instrument_);
  double least = 0.0;  // insertion beyond which an opening is in the vessel
  for (std::size_t outer = own + 1; outer < insertions.size(); ++outer)
    least = std::max(least, insertions[outer]);
  std::vector<double> inside;
  for (const double from_tip : from_tip_)
    if (insertions[own] - from_tip > least)
      inside.push_back(from_tip);
  return inside;
}

std::string ContrastInjections::refusalOf(const contrast::Injection& injection, bool refill,
                                          const std::vector<double>& insertions) const
{
  const contrast::Syringe& syringe = injector_.syringe();
  std::string refusal = contrast::refusalOf(injection, syringe, refill ? syringe.capacity : injector_.content());
  if (refusal.empty() && injector_.isActive())
    refusal = formatted("%g ml of the present injection are left; stop it, or wait for its end",
                        injector_.left() / kMillilitre);
  if (refusal.empty() && openings(insertions).empty())
    refusal = "no opening of '" + scene_.instrument + "' is in the vessel; advance it, or withdraw what covers it";
  return refusal;
}

void ContrastInjections::follow(const ContrastInput& input)
{
  contrast::Injector changed = injector_;
  changed.stop();
  if (input.refill)
    changed.refill();
  if (input.injection.volume != 0.0)
    changed.start(input.injection);
  injector_ = changed;
  if (!inputs_.empty() && inputs_.front().step != input.step)
    inputs_.clear();
  inputs_.push_back(input);
}

flow::FlowInjection ContrastInjections::advance(double time, const std::vector<double>& insertions,
                                                const std::function<flow::TreePath()>& path)
{
  rate_ = 0.0;
  const bool is_due =
      next_ < scene_.injections.size() && scene_.injections[static_cast<std::size_t>(next_)].at <= time + kRounding;
  if (!is_due && !injector_.isActive())
    return {};
  const std::vector<double> inside = openings(insertions);
  if (is_due)
    beginDue(time, !inside.empty());
  flow::FlowInjection injection;
  const flow::TreePath from_tip = injector_.isActive() ? path() : flow::TreePath({});
  for (const double distance : inside)
    if (const flow::TreePlace place = from_tip.at(distance); place.branch >= 0)
      injection.openings.push_back({place, 1.0});
  if (injection.openings.empty())
    injector_.stop();
  const contrast::Dose dose = injector_.advance(time_step_);
  if (dose.volume <= 0.0)
    return {};
  rate_ = dose.volume / time_step_;
  injected_ += dose.volume;
  fillLumen(dose);
  injection.volume = dose.volume;
  injection.concentration = dose.concentration;
  injection.viscosity = dose.viscosity;
  return injection;
}

/** Begins the injections of the scene whose time has come; of several the last one. */
void ContrastInjections::beginDue(double time, bool has_opening)
{
  for (; next_ < scene_.injections.size() && scene_.injections[static_cast<std::size_t>(next_)].at <= time + kRounding;
       ++next_)
  {
    const scene::InjectionScene& one = scene_.injections[static_cast<std::size_t>(next_)];
    if (!has_opening)
    {
      ++missed_;
      continue;
    }
    injector_.stop();
    if (injector_.content() < one.volume)
      injector_.refill();
    injector_.start(scene_.injection(one.volume, one.rate, one.rise));
  }
}

/** Follows the medium through the instrument's lumen. */
void ContrastInjections::fillLumen(const contrast::Dose& dose)
{
  if (dose.concentration != medium_)
    through_ = 0.0;
  medium_ = dose.concentration;
  through_ += dose.volume;
  if (through_ >= dead_volume_)
    lumens_[static_cast<std::size_t>(instrument_)] = medium_;
}

void ContrastInjections::archive(Archive& archive)
{
  std::string tag = kTag;
  archive(tag);
  requireLoaded(tag == kTag, "holds no contrast medium");
  const std::size_t instruments = lumens_.size();
  archive(injector_, lumens_, medium_, through_, rate_, injected_, next_, missed_);
  if (!archive.reading())
    return;
  requireLength(instruments, lumens_);
  requireFinite(lumens_, medium_, through_, rate_, injected_);
  requireLoaded(next_ <= scene_.injections.size() && missed_ >= 0 && injected_ >= 0.0 &&
                    std::all_of(lumens_.begin(), lumens_.end(), [](double iodine) { return iodine >= 0.0; }) &&
                    (!injector_.isActive() || contrast::refusalOf(injector_.injection(), injector_.syringe()).empty()),
                "holds injections that the scene does not have");
  inputs_.clear();
}

}  // namespace endovascular_sim::simulation
