#include "simulation/balloon_treatments.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "simulation/wall_history.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kGrip = 200.0;     // N/m, load of an inflated balloon on a wall that limits it: assumed
constexpr double kGrowth = 10e-6;   // m, growth of a balloon's radius per contact query
constexpr int kSettleRounds = 200;  // rounds after the last pressure until the wall is at rest

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
  : time_step_(scene.solver.time_step), contact_stiffness_(scene.solver.stepper.contact_stiffness), wall_(wall)
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
  for (const InstrumentTreatment& treated : treatments_)
    if (treated.instrument == instrument)
      return &treated.treatment;
  return nullptr;
}

/** Arc length of an instrument's tip along the nodes [m]. */
double BalloonTreatments::tipOf(int instrument, const rod::State& state, const rod::Discretisation& rod) const
{
  if (state.layers.empty())
    return rod.length();
  const double behind = state.layers[static_cast<std::size_t>(state.reference)].inserted_length -
                        state.layers[static_cast<std::size_t>(instrument)].inserted_length;
  return rod.length() - std::max(0.0, behind);
}

/** Distance from an instrument's tip beyond which a wider instrument covers it [m]. */
double BalloonTreatments::coveredFrom(int instrument, const rod::State& state, const rod::Discretisation& rod) const
{
  double covered = kInfinity;
  // Outside the introducer the order of the tips is not that of the instruments: no instrument covers another.
  if (!state.layers.empty() && state.layers[static_cast<std::size_t>(instrument)].inserted_length <= 0.0)
    return covered;
  const double tip = tipOf(instrument, state, rod);
  for (std::size_t k = static_cast<std::size_t>(instrument) + 1; k < state.layers.size(); ++k)
    if (state.layers[k].inserted_length > 0.0)
      covered = std::min(covered, std::max(0.0, tip - tipOf(static_cast<int>(k), state, rod)));
  return covered;
}

/** Part of the shaft under a balloon that is in the vessel; none when the balloon is outside. */
std::optional<intervention::ShaftLine> BalloonTreatments::shaftOf(const InstrumentTreatment& treated,
                                                                  const rod::State& state,
                                                                  const std::vector<Eigen::Vector3d>& at_rest,
                                                                  const rod::Discretisation& rod) const
{
  const intervention::Treatment& treatment = treated.treatment;
  const double tip = tipOf(treated.instrument, state, rod);
  const double inserted = rod.length() - state.inserted_length;  // arc length of the introducer along the nodes
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
    points.push_back(at_rest[i]);
  }
  return intervention::ShaftLine(std::move(from_tip), std::move(points));
}

/** True where a catheter, narrower than the stent, strips it off at its tip when the balloon is drawn in. */
bool BalloonTreatments::isHeldBack(const InstrumentTreatment& treated, double covered_from,
                                   const rod::State& state) const
{
  if (!treated.treatment.carriesStent() || covered_from == kInfinity)
    return false;
  const intervention::StentPlacement& stent = *treated.treatment.stent();
  const instrument::Balloon& balloon = treated.treatment.inflation().balloon();
  const double proximal_end = balloon.from_tip + 0.5 * balloon.length + 0.5 * stent.length();
  double lumen = kInfinity;
  for (std::size_t k = static_cast<std::size_t>(treated.instrument) + 1; k < lumens_.size(); ++k)
    if (state.layers[k].inserted_length > 0.0)
      lumen = std::min(lumen, lumens_[k]);
  return covered_from < proximal_end && 0.5 * stent.outerDiameter() > lumen;
}

double BalloonTreatments::presentRadius(int instrument) const
{
  for (const InstrumentTreatment& treated : treatments_)
    if (treated.instrument == instrument && !treated.widths.empty())
      return *std::max_element(treated.widths.begin(), treated.widths.end());
  return 0.0;
}

std::uint64_t BalloonTreatments::beginStep(std::uint64_t step)
{
  if (wall_ == nullptr)
    return 0;
  if (step % kBalloonLoadPeriod == 0 && shown_ != due_)
    wall_->activate(shown_ = due_);
  return shown_;
}

/** Radius at a distance from the tip at the last contact query; 0 where there was none [m]. */
double BalloonTreatments::lastWidth(const InstrumentTreatment& treated, double from_tip)
{
  const std::vector<double>& positions = treated.positions;
  const auto next = std::upper_bound(positions.begin(), positions.end(), from_tip);
  if (next == positions.begin() || next == positions.end())
    return 0.0;
  const auto k = static_cast<std::size_t>(next - positions.begin());
  const double t = (from_tip - positions[k - 1]) / (positions[k] - positions[k - 1]);
  return treated.widths[k - 1] + t * (treated.widths[k] - treated.widths[k - 1]);
}

/** Sets the radii of a balloon without the wall.
 *  @param growth largest growth since the last contact query [m] */
void BalloonTreatments::widen(InstrumentTreatment& treated, const rod::State& state, const rod::Discretisation& rod,
                              double growth)
{
  const double tip = tipOf(treated.instrument, state, rod);
  const double begin = treated.treatment.begin();
  const double end = std::min(treated.treatment.end(), coveredFrom(treated.instrument, state, rod));
  positions_.clear();
  const auto from = rod.position.begin() + state.first_node;
  const auto beyond = std::lower_bound(from, rod.position.end(), tip - begin);
  for (int i = static_cast<int>(beyond - rod.position.begin()) - 1; i >= state.first_node; --i)
  {
    const double from_tip = tip - rod.position[i];
    if (from_tip >= end)
      break;
    if (from_tip <= begin)
      continue;
    if (positions_.empty())
      treated.last_node = i;
    const double hard = treated.treatment.crossingRadiusAt(from_tip);
    const double most = std::max(hard, lastWidth(treated, from_tip)) + growth;
    radii_[i] = std::max({radii_[i], hard, std::min(treated.treatment.radiusAt(from_tip), most)});
    hard_[i] = std::max(hard_[i], hard);
    positions_.push_back(from_tip);
  }
  treated.positions.swap(positions_);
}

/** Reduces the radii of balloons where they would press on the wall with more than kGrip. Both nodes of an edge yield,
 *  the nearer one more, so that the radii are continuous while a contact moves along the edge. */
void BalloonTreatments::complyWithWall(const rod::State& state, const rod::Discretisation& rod,
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
  for (InstrumentTreatment& treated : treatments_)
    widen(treated, state, rod, contacts.stale ? 0.0 : kGrowth);  // no growth without a fresh contact set
  complyWithWall(state, rod, contacts);
  for (InstrumentTreatment& treated : treatments_)
  {
    treated.widths.clear();
    for (std::size_t k = 0; k < treated.positions.size(); ++k)
      treated.widths.push_back(radii_[static_cast<std::size_t>(treated.last_node) - k]);
  }
  return radii_;
}

void BalloonTreatments::addEvent(std::uint64_t step, int instrument, TreatmentEvent event)
{
  events_.push_back({step, static_cast<double>(step + 1) * time_step_, instrument, event});
}

void BalloonTreatments::collectEvents(const InstrumentTreatment& treated, std::uint64_t step)
{
  const intervention::TreatmentEvents& events = treated.treatment.events();
  if (events.above_rated)
    addEvent(step, treated.instrument, TreatmentEvent::kAboveRated);
  if (events.burst)
    addEvent(step, treated.instrument, TreatmentEvent::kBurst);
  if (events.over_expanded)
    addEvent(step, treated.instrument, TreatmentEvent::kOverExpanded);
  if (events.stent_placed)
    addEvent(step, treated.instrument, TreatmentEvent::kStentPlaced);
  if (events.stent_lost)
    addEvent(step, treated.instrument, TreatmentEvent::kStentLost);
}

void BalloonTreatments::endStep(std::uint64_t step, const std::vector<double>& commanded, const rod::State& state,
                                const std::vector<Eigen::Vector3d>& at_rest, const rod::Discretisation& rod)
{
  const intervention::Treatment* strongest = nullptr;
  for (InstrumentTreatment& treated : treatments_)
  {
    const double covered_from = coveredFrom(treated.instrument, state, rod);
    if (isHeldBack(treated, covered_from, state))
      treated.treatment.dislodgeStent();
    std::optional<intervention::ShaftLine> shaft = shaftOf(treated, state, at_rest, rod);
    const intervention::BalloonLoad& load = treated.treatment.step(
        time_step_, commanded[static_cast<std::size_t>(treated.instrument)], shaft ? &*shaft : nullptr, covered_from);
    if (load.sleeve)
      next_.sleeve = load.sleeve;
    if (strongest == nullptr || load.pressure > strongest->load().pressure)
      strongest = &treated.treatment;
    collectEvents(treated, step);
  }
  if (wall_ == nullptr || strongest == nullptr || (step + 1) % kBalloonLoadPeriod != 0)
    return;
  due_ = promised_;
  next_.balloon = strongest->load().balloon;
  next_.pressure = strongest->load().pressure;
  loadWall(step);
}

/** Loads the wall while there is a load, or until the wall is at rest. */
void BalloonTreatments::loadWall(std::uint64_t step)
{
  if (next_.pressure > 0.0 || next_.sleeve)
  {
    pressed_ = true;
    still_ = 0;
  }
  else
    ++still_;
  if (!pressed_ || still_ > kSettleRounds)
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

void BalloonTreatments::InstrumentTreatment::archive(Archive& archive)
{
  archive(treatment, positions, widths);
  if (!archive.reading())
    return;
  requireLength(positions.size(), widths);
  requireFinite(positions, widths);
}

void BalloonTreatments::archive(Archive& archive)
{
  for (InstrumentTreatment& treated : treatments_)
    archive(treated);
  archive(events_, next_, shown_, due_, promised_, still_, pressed_, at_risk_);
  if (wall_ != nullptr)
    archive(*wall_);
  if (archive.reading())
    requireLoaded(!(next_.pressure > 0.0) || !next_.balloon.axis.empty(), "holds a pressure without a balloon");
}

}  // namespace endovascular_sim::simulation
