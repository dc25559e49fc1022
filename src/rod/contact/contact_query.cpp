#include "rod/contact/contact_query.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "rod/boundary/boundary_conditions.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kWideMargin = 5e-6;  // m
constexpr double kWideMotions = 4.0;  // times the recent motion
constexpr double kWideDecay = 0.5;    // per step
constexpr double kSnapMotion = 0.6;   // margins in one solve
constexpr double kSnapMargin = 3.0;   // margins
constexpr int kNeighboursOfSnap = 2;  // on either side

}  // namespace

ContactQueryBuilder::ContactQueryBuilder(const Discretisation& rod, const Boundary& boundary,
                                         const StepperSettings& settings, const WireSurface& surface)
  : rod_(rod),
    boundary_(boundary),
    settings_(settings),
    surface_(surface),
    margin_rule_(uniformMargin(settings.contact_margin))
{
}

void ContactQueryBuilder::beginStep(const StepInput& input, contact::ContactSource* source, std::uint32_t& pass,
                                    PhaseTimer& timer)
{
  if (input.step != step_ || input.substep == 0)
    step_is_stale_ = false;
  source_ = source;
  pass_ = &pass;
  timer_ = &timer;
  wide_motion_ *= kWideDecay;
  snap_before_ = snap_;
  snap_ = {};
  step_ = input.step;
  substep_ = input.substep;
  vessel_version_ = input.vessel_version;
}

void ContactQueryBuilder::noteSnapThrough(const NodalMotion& motion, int first)
{
  const double limit = kSnapMotion * settings_.contact_margin;
  for (int i = first; i < rod_.nodes(); ++i)
    if (motion[i].squaredNorm() > limit * limit)
      snap_.add({std::max(0, i - kNeighboursOfSnap), std::min(i + kNeighboursOfSnap + 1, rod_.nodes())});
}

void ContactQueryBuilder::noteWideMotion(double distance)
{
  wide_motion_ = std::isinf(wide_motion_) ? distance : std::max(distance, wide_motion_);
}

void ContactQueryBuilder::noteWideGrowth(double growth)
{
  wide_motion_ = std::max(wide_motion_, growth);
}

void ContactQueryBuilder::updateMarginRule()
{
  const double infinity = std::numeric_limits<double>::infinity();
  margin_rule_.widest_margin = surface_.hasWideBalloon() ? kWideMargin + kWideMotions * wide_motion_ : infinity;
  margin_rule_.snap = snap_before_;
  margin_rule_.snap.add(snap_);
  margin_rule_.snap_margin = margin_rule_.snap.empty() ? 0.0 : kSnapMargin * settings_.contact_margin;
}

/** @return parameter of the introducer's mouth on the first edge; 0 without */
double ContactQueryBuilder::describeNodes(const State& state)
{
  const BoundaryConditions held(rod_, boundary_);
  held.describe(state, query_);
  for (std::size_t i = 0; i < query_.radius.size() && !surface_.leastRadius().empty(); ++i)
    query_.radius[i] =
        std::max(query_.radius[i], surface_.leastRadius()[static_cast<std::size_t>(query_.first_node) + i]);
  return held.describeMouth(state, query_);
}

int ContactQueryBuilder::describe(const State& state)
{
  describeNodes(state);
  return query_.first_node;
}

void ContactQueryBuilder::detect(const State& state, contact::ContactSet& answer, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  mouth_ = describeNodes(state);
  mouth_edge_ = mouth_ > 0.0 ? query_.first_node : -1;
  updateMarginRule();
  send(0.0, answer, report);
  if (answer.stale)
    return;
  // The first queried point is the mouth, inside an edge: parameters on the queried part are mapped to the whole edge.
  for (contact::Feature& feature : answer.features)
    if (feature.edge == query_.first_node)
      feature.parameter = mouth_ + (1.0 - mouth_) * feature.parameter;
}

void ContactQueryBuilder::freeDistances(int first_edge, double wanted, contact::ContactSet& answer, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  const int skipped = std::max(0, first_edge - query_.first_node);
  query_.first_node += skipped;
  query_.nodes.erase(query_.nodes.begin(), query_.nodes.begin() + skipped);
  query_.radius.erase(query_.radius.begin(), query_.radius.begin() + skipped);
  send(wanted, answer, report);
}

/** @param wanted_free_distance 0 in a query for features [m] */
void ContactQueryBuilder::send(double wanted_free_distance, contact::ContactSet& answer, StepReport& report)
{
  query_.step = step_;
  query_.substep = substep_;
  query_.pass = *pass_;
  query_.vessel_version = vessel_version_;
  margin_rule_.apply(query_);
  // After a missing answer, the rest of the step uses the earlier set, so that a replay needs one number only.
  answer.stale = step_is_stale_;
  if (!step_is_stale_ && wanted_free_distance > 0.0)
    source_->freeDistances(query_, wanted_free_distance, answer);
  else if (!step_is_stale_)
    source_->detect(query_, answer);
  if (answer.stale && !step_is_stale_)
    report.first_stale_pass = *pass_;
  step_is_stale_ = answer.stale;
  ++*pass_;
}

void ContactQueryBuilder::resample(const NodeRenumbering& renumbering)
{
  for (NodeRange* range : {&snap_, &snap_before_, &margin_rule_.snap})
    renumbering.apply(*range);
  mouth_edge_ = renumbering.isShift() && mouth_edge_ >= 0 ? mouth_edge_ + renumbering.shift() : -1;
}

void ContactQueryBuilder::archiveStaleness(Archive& archive)
{
  archive(step_is_stale_);
}

void ContactQueryBuilder::archive(Archive& archive)
{
  archive(snap_, snap_before_, wide_motion_, step_, substep_, vessel_version_, query_.first_node,
          margin_rule_.widest_margin, margin_rule_.snap_margin, margin_rule_.snap, mouth_, mouth_edge_);
  if (!archive.reading())
    return;
  for (const NodeRange& range : {snap_, snap_before_, margin_rule_.snap})
  {
    requireIndex(range.begin, 0, rod_.nodes() + 1);
    requireIndex(range.end, 0, rod_.nodes() + 1);
  }
  requireIndex(query_.first_node, 0, rod_.nodes() + 1);
  requireIndex(mouth_edge_, -1, rod_.nodes() - 1);
  requireNumbers(wide_motion_, margin_rule_.widest_margin, margin_rule_.snap_margin, mouth_);
}

}  // namespace endovascular_sim::rod
