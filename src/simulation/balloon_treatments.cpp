#include "simulation/balloon_treatments.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/archive.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kGrip = 200.0;        // N/m with which an inflated balloon presses on what holds it back: assumed
constexpr double kGrowth = 10e-6;      // m by which a balloon may widen at once
constexpr int kSettlePressings = 200;  // after the last pressure: the wall has come to rest by then

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

const char* nameOf(TreatmentEvent event)
{
  switch (event)
  {
    case TreatmentEvent::kAboveRated:
      return "above_rated";
    case TreatmentEvent::kBurst:
      return "burst";
    case TreatmentEvent::kStentPlaced:
      return "stent_placed";
    case TreatmentEvent::kOverExpanded:
      return "over_expanded";
    case TreatmentEvent::kStentLost:
      return "stent_lost";
    case TreatmentEvent::kAtRisk:
      break;
  }
  return "at_risk";
}

BalloonTreatments::BalloonTreatments(const scene::Scene& scene, intervention::DeformableWall* wall)
  : time_step_(scene.solver.time_step), contact_stiffness_(scene.solver.contact_stiffness), wall_(wall)
{
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
  {
    const instrument::Instrument& instrument = scene.instruments[k].instrument;
    lumens_.push_back(instrument.inner_radius);
    if (instrument.balloon)
      treatments_.push_back({static_cast<int>(k), intervention::Treatment(instrument), {}, {}, 0});
  }
  if (wall_ != nullptr)
    shown_ = due_ = promised_ = wall_->version();
}

const intervention::Treatment* BalloonTreatments::of(int instrument) const
{
  for (const Worked& worked : treatments_)
    if (worked.instrument == instrument)
      return &worked.treatment;
  return nullptr;
}

/** Place of an instrument's tip along the nodes [m]. */
double BalloonTreatments::tipOf(int instrument, const rod::State& state, const rod::Discretisation& rod) const
{
  if (state.layers.empty())
    return rod.length();
  const double behind = state.layers[static_cast<std::size_t>(state.reference)].inserted_length -
                        state.layers[static_cast<std::size_t>(instrument)].inserted_length;
  return rod.length() - std::max(0.0, behind);
}

/** Distance from an instrument's tip from which on a wider one covers it [m]. */
double BalloonTreatments::coveredFrom(int instrument, const rod::State& state, const rod::Discretisation& rod) const
{
  double covered = kInfinity;
  // In front of the introducer the order of the places is not that of the instruments: nothing covers another one.
  if (!state.layers.empty() && state.layers[static_cast<std::size_t>(instrument)].inserted_length <= 0.0)
    return covered;
  const double tip = tipOf(instrument, state, rod);
  for (std::size_t k = static_cast<std::size_t>(instrument) + 1; k < state.layers.size(); ++k)
    if (state.layers[k].inserted_length > 0.0)
      covered = std::min(covered, std::max(0.0, tip - tipOf(static_cast<int>(k), state, rod)));
  return covered;
}

/** The part of the shaft under a balloon that is in the vessel, as far as the nodes know; none when it is outside. */
std::optional<intervention::ShaftLine> BalloonTreatments::shaftOf(const Worked& worked, const rod::State& state,
                                                                  const rod::Discretisation& rod) const
{
  const intervention::Treatment& treatment = worked.treatment;
  const double tip = tipOf(worked.instrument, state, rod);
  const double inserted = rod.length() - state.inserted_length;  // place of the introducer along the nodes
  if (tip - inserted <= treatment.inflation().balloon().from_tip)
    return std::nullopt;
  const auto from =
      std::upper_bound(rod.position.begin() + state.first_node, rod.position.end(), tip - treatment.end());
  const auto to = std::lower_bound(from, rod.position.end(), tip - treatment.begin());
  const int first = std::max(state.first_node, static_cast<int>(from - rod.position.begin()) - 1);
  const int last = std::min(rod.nodes() - 1, static_cast<int>(to - rod.position.begin()));
  std::vector<double> from_tip;
  std::vector<Eigen::Vector3d> points;
  for (int i = std::min(first, last - 1); i <= last; ++i)
  {
    from_tip.push_back(tip - rod.position[i]);
    points.push_back(state.position[i]);
  }
  return intervention::ShaftLine(std::move(from_tip), std::move(points));
}

/** A stent that is wider than the catheter into which it is drawn stays at that catheter's tip. */
bool BalloonTreatments::isHeldBack(const Worked& worked, double covered_from, const rod::State& state) const
{
  if (!worked.treatment.carriesStent() || covered_from == kInfinity)
    return false;
  const intervention::StentPlacement& stent = *worked.treatment.stent();
  const instrument::Balloon& balloon = worked.treatment.inflation().balloon();
  const double proximal_end = balloon.from_tip + 0.5 * balloon.length + 0.5 * stent.length();
  double lumen = kInfinity;
  for (std::size_t k = static_cast<std::size_t>(worked.instrument) + 1; k < lumens_.size(); ++k)
    if (state.layers[k].inserted_length > 0.0)
      lumen = std::min(lumen, lumens_[k]);
  return covered_from < proximal_end && 0.5 * stent.outerDiameter() > lumen;
}

std::uint64_t BalloonTreatments::beginStep(std::uint64_t step)
{
  if (wall_ == nullptr)
    return 0;
  if (step % kPressEvery == 0 && shown_ != due_)
    wall_->activate(shown_ = due_);
  return shown_;
}

/** Radius at a place when contacts were last asked for; 0 where it was not there [m]. */
double BalloonTreatments::lastWidth(const Worked& worked, double from_tip)
{
  const std::vector<double>& places = worked.places;
  const auto next = std::upper_bound(places.begin(), places.end(), from_tip);
  if (next == places.begin() || next == places.end())
    return 0.0;
  const auto k = static_cast<std::size_t>(next - places.begin());
  const double t = (from_tip - places[k - 1]) / (places[k] - places[k - 1]);
  return worked.widths[k - 1] + t * (worked.widths[k] - worked.widths[k - 1]);
}

/** Radii that a balloon would have in a wider vessel. @param growth that it may widen by [m] */
void BalloonTreatments::widen(Worked& worked, const rod::State& state, const rod::Discretisation& rod, double growth)
{
  const double tip = tipOf(worked.instrument, state, rod);
  const double covered_from = coveredFrom(worked.instrument, state, rod);
  places_.clear();
  for (int i = rod.nodes() - 1; i >= state.first_node; --i)
  {
    const double from_tip = tip - rod.position[i];
    if (from_tip >= std::min(worked.treatment.end(), covered_from))
      break;
    if (from_tip <= worked.treatment.begin())
      continue;
    if (places_.empty())
      worked.last_node = i;
    const double hard = worked.treatment.crossingRadiusAt(from_tip);
    const double most = std::max(hard, lastWidth(worked, from_tip)) + growth;
    radii_[i] = std::max({radii_[i], hard, std::min(worked.treatment.radiusAt(from_tip), most)});
    hard_[i] = std::max(hard_[i], hard);
    places_.push_back(from_tip);
  }
  worked.places.swap(places_);
}

/** Makes balloons narrower where they would press on the wall by more than their grip. Between two nodes both give way,
 *  the nearer one more, so that a contact that moves along the edge does not jump from one to the other. */
void BalloonTreatments::giveWay(const rod::State& state, const rod::Discretisation& rod,
                                const contact::ContactSet& contacts)
{
  for (const contact::Feature& feature : contacts.features)
  {
    const auto node = static_cast<std::size_t>(feature.edge);
    const std::size_t next = std::min(node + 1, hard_.size() - 1);
    if (hard_[node] == 0.0 && hard_[next] == 0.0)
      continue;
    const double w1 = feature.parameter;
    const double w0 = 1.0 - w1;
    const Eigen::Vector3d axis = w0 * state.position[node] + w1 * state.position[next];
    const double grip = kGrip * (w0 * rod.cell_length[node] + w1 * rod.cell_length[next]) / contact_stiffness_;
    const double width = w0 * std::max(radii_[node], rod.radius[node]) + w1 * std::max(radii_[next], rod.radius[next]);
    const double beyond = width - feature.normal.dot(axis - feature.point) - grip;
    if (beyond <= 0.0)
      continue;
    const double least = beyond / (w0 * w0 + w1 * w1);
    radii_[node] = std::max(hard_[node], radii_[node] - w0 * least);
    radii_[next] = std::max(hard_[next], radii_[next] - w1 * least);
  }
}

const std::vector<double>& BalloonTreatments::contactRadii(const rod::State& state, const rod::Discretisation& rod,
                                                           const contact::ContactSet& contacts)
{
  radii_.assign(state.position.size(), 0.0);
  hard_.assign(state.position.size(), 0.0);
  for (Worked& worked : treatments_)
    widen(worked, state, rod, contacts.stale ? 0.0 : kGrowth);  // not into a wall that nobody has seen
  giveWay(state, rod, contacts);
  for (Worked& worked : treatments_)
  {
    worked.widths.clear();
    for (std::size_t k = 0; k < worked.places.size(); ++k)
      worked.widths.push_back(radii_[static_cast<std::size_t>(worked.last_node) - k]);
  }
  return radii_;
}

void BalloonTreatments::addEvent(std::uint64_t step, int instrument, TreatmentEvent event)
{
  events_.push_back({step, static_cast<double>(step + 1) * time_step_, instrument, event});
}

void BalloonTreatments::collectEvents(const Worked& worked, std::uint64_t step)
{
  const intervention::TreatmentEvents& events = worked.treatment.events();
  if (events.above_rated)
    addEvent(step, worked.instrument, TreatmentEvent::kAboveRated);
  if (events.burst)
    addEvent(step, worked.instrument, TreatmentEvent::kBurst);
  if (events.over_expanded)
    addEvent(step, worked.instrument, TreatmentEvent::kOverExpanded);
  if (events.stent_placed)
    addEvent(step, worked.instrument, TreatmentEvent::kStentPlaced);
  if (events.stent_lost)
    addEvent(step, worked.instrument, TreatmentEvent::kStentLost);
}

void BalloonTreatments::endStep(std::uint64_t step, const std::vector<double>& commanded, const rod::State& state,
                                const rod::Discretisation& rod)
{
  const intervention::Treatment* strongest = nullptr;
  for (Worked& worked : treatments_)
  {
    const double covered_from = coveredFrom(worked.instrument, state, rod);
    if (isHeldBack(worked, covered_from, state))
      worked.treatment.dislodgeStent();
    const std::optional<intervention::ShaftLine> shaft = shaftOf(worked, state, rod);
    const intervention::BalloonLoad& pressing = worked.treatment.step(
        time_step_, commanded[static_cast<std::size_t>(worked.instrument)], shaft ? &*shaft : nullptr, covered_from);
    if (pressing.sleeve)
      next_.sleeve = pressing.sleeve;
    if (strongest == nullptr || pressing.pressure > strongest->load().pressure)
      strongest = &worked.treatment;
    collectEvents(worked, step);
  }
  if (wall_ == nullptr || strongest == nullptr || (step + 1) % kPressEvery != 0)
    return;
  due_ = promised_;
  next_.balloon = strongest->load().balloon;
  next_.pressure = strongest->load().pressure;
  pressWall(step);
}

/** Only while something presses, or the wall may still move. */
void BalloonTreatments::pressWall(std::uint64_t step)
{
  if (next_.pressure > 0.0 || next_.sleeve)
  {
    pressed_ = true;
    still_ = 0;
  }
  else
    ++still_;
  if (!pressed_ || still_ > kSettlePressings)
    return;
  promised_ = wall_->applyLoad(step, next_);
  next_.sleeve.reset();
  if (wall_->atRisk() && !at_risk_)
    addEvent(step, treatments_.front().instrument, TreatmentEvent::kAtRisk);
  at_risk_ = wall_->atRisk();
}

void archive(Archive& archive, TimedEvent& event)
{
  archive(event.step, event.time, event.instrument, event.event);
}

void BalloonTreatments::Worked::archive(Archive& archive)
{
  archive(treatment, places, widths);
}

void BalloonTreatments::archive(Archive& archive)
{
  for (Worked& worked : treatments_)
    archive(worked);
  archive(events_, next_, shown_, due_, promised_, still_, pressed_, at_risk_);
  if (wall_ != nullptr)
    archive(*wall_);
}

}  // namespace endovascular_sim::simulation
