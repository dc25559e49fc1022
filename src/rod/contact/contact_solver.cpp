#include "rod/contact/contact_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "contact/contract/contact_set_archive.h"

namespace endovascular_sim::rod
{
namespace
{

/** Checks a loaded contact set against a wire.
 *  @throws ArchiveError */
void requireFit(const contact::ContactSet& set, int nodes)
{
  for (const contact::Feature& feature : set.features)
  {
    requireIndex(feature.edge, 0, nodes - 1);
    requireFinite(feature.parameter, feature.point, feature.normal, feature.gap, feature.friction);
    requireLoaded(feature.parameter >= 0.0 && feature.parameter <= 1.0, "holds a contact beyond its edge");
    requireNumbers(feature.clearance_radius, feature.stiffness);
  }
  requireNumbers(set.free_distance);
}

/** Checks loaded springs against a wire and their contacts.
 *  @throws ArchiveError */
void requireFit(const std::vector<ContactSpring>& springs, std::size_t features, int nodes)
{
  requireLoaded(springs.size() <= features, "holds arrays of a wrong length");
  for (const ContactSpring& spring : springs)
  {
    requireIndex(spring.node, 0, nodes - 1);
    requireFinite(spring.weight0, spring.weight1, spring.stiffness, spring.gap, spring.force, spring.reached,
                  spring.resisted);
  }
}

}  // namespace

ContactSolver::ContactSolver(const Discretisation& rod, const Boundary& boundary, const StepperSettings& settings)
  : rod_(rod),
    settings_(settings),
    surface_(rod),
    query_(rod, boundary, settings, surface_),
    trust_region_(rod, settings, surface_, query_),
    springs_(rod, settings),
    penetration_(rod),
    transfer_(rod)
{
}

void ContactSolver::beginStep(const StepInput& input, contact::ContactSource* source, std::uint32_t& pass,
                              PhaseTimer& timer)
{
  query_.beginStep(input, source, pass, timer);
}

void ContactSolver::setRadii(const std::vector<double>& radii)
{
  if (surface_.leastRadius().size() == radii.size())
  {
    releaseRetained();
    removeStiffLayer(current_.set.features);
    trust_region_.subtractGrowth(radii);
    for (contact::Feature& feature : current_.set.features)
    {
      const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
      feature.gap -= (1.0 - feature.parameter) * surface_.growthTo(radii[feature.edge], feature.edge) +
                     feature.parameter * surface_.growthTo(radii[next], next);
    }
    addStiffLayers();
  }
  surface_.setLeastRadius(radii);
}

void ContactSolver::addStiffLayers()
{
  const auto reach = [this](int node) { return std::max(settings_.contact_margin, trust_region_.reach(node)); };
  addStiffLayer(rod_, reach, current_.set.features);
}

void ContactSolver::invalidate()
{
  valid_ = false;
  trust_region_.setStaleBudget(0.0);
}

void ContactSolver::refresh(const State& state, StepReport& report)
{
  if (present() && (!valid_ || current_.set.stale))
    detect(state, report);
}

/** Queries the contacts. A fresh set receives stiff layers; a stale set remains unchanged. */
void ContactSolver::query(const State& state, StepReport& report)
{
  query_.detect(state, current_.set, report);
  if (current_.set.stale)
    return;
  trust_region_.update(current_.set.features);
  addStiffLayers();
}

void ContactSolver::detect(const State& state, StepReport& report)
{
  std::swap(current_, previous_);
  current_.retained = 0;
  query(state, report);
  valid_ = solve_precedes_detection_ = true;
  if (current_.set.stale)
    reuseEarlierContacts(state);
  else
    trust_region_.setStaleBudget(1.0);
}

void ContactSolver::detectAgain(const State& state, StepReport& report)
{
  query(state, report);
  if (current_.set.stale)
    trust_region_.setStaleBudget(0.0);  // the state that the stale set belongs to is unknown
}

void ContactSolver::reuseEarlierContacts(const State& state)
{
  std::vector<contact::Feature>& features = current_.set.features;
  features = previous_.set.features;
  features.resize(previous_.detected());
  removeStiffLayer(features);
  for (contact::Feature& feature : features)
    feature.gap = surface_.gapTo(feature, state);
  addStiffLayers();
}

void ContactSolver::carry(const State& state, const contact::WallMotion& wall)
{
  wall.carry(current_.set.features);
  for (contact::Feature& feature : current_.set.features)
    feature.gap = surface_.gapTo(feature, state) + (isStiffLayer(feature) ? stiffLayerDepth(feature, rod_) : 0.0);
}

void ContactSolver::noteDepths()
{
  penetration_.store(current_, query_.mouthEdge(), query_.mouth());
}

void ContactSolver::prepare(const State& state, double dt, const contact::WallTravel* wall)
{
  solve_precedes_detection_ = false;
  springs_.prepare(state, dt, current_, wall);
}

bool ContactSolver::updateActiveSet(const Motion& motion, int pass, bool same_rest)
{
  return active_set_.update(current_, motion, pass, same_rest);
}

double ContactSolver::truncation(const State& state, const Motion& motion, double factor, StepReport& report)
{
  return present() ? trust_region_.truncation(state, motion, factor, current_.set, report) : factor;
}

void ContactSolver::updateWallForces(State& state, const Motion& motion)
{
  springs_.exertForces(solve_precedes_detection_ ? previous_ : current_, motion, state);
}

double ContactSolver::springEnergy() const
{
  double sum = 0.0;
  for (const Spring& spring : (solve_precedes_detection_ ? previous_ : current_).springs)
    sum += 0.5 * spring.force * spring.force / spring.stiffness;
  return sum;
}

bool ContactSolver::foundUnknown(const State& state) const
{
  for (const contact::Feature& feature : current_.set.features)
  {
    if (feature.gap + wallOffset(state, feature) >= -settings_.penetration_tolerance)
      continue;
    bool known = false;
    for (std::size_t c = 0; c < previous_.springs.size() && !known; ++c)
      known = previous_.springs[c].active && isSameContact(previous_.set.features[c], feature);
    if (!known)
      return true;
  }
  return false;
}

void ContactSolver::retainActiveContacts(const State& state)
{
  if (current_.set.stale)
    return;
  std::vector<contact::Feature>& features = current_.set.features;
  const std::size_t detected = features.size();
  for (std::size_t c = 0; c < previous_.springs.size(); ++c)
  {
    const contact::Feature& feature = previous_.set.features[c];
    const bool pressed = feature.gap + wallOffset(state, feature) < 0.0 || previous_.springs[c].active ||
                         c + previous_.retained >= previous_.springs.size();
    if (!pressed || isStiffLayer(feature) || !isBetweenNodes(feature))
      continue;
    const auto begin = features.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(detected);
    if (std::any_of(begin, end, [&feature](const contact::Feature& other) { return isSameContact(feature, other); }))
      continue;
    features.push_back(feature);
    features.back().gap = surface_.gapTo(feature, state);
  }
  current_.retained = features.size() - detected;
}

void ContactSolver::releaseRetained()
{
  current_.set.features.resize(current_.detected());
  current_.retained = 0;
}

void ContactSolver::resample(const Discretisation& to)
{
  const NodeRenumbering renumbering(rod_, to, query_.query().first_node);
  transfer_.moveFeatures(to, renumbering, current_.set.features);
  valid_ = valid_ && renumbering.isShift();
  surface_.resample(renumbering);
  trust_region_.resample(renumbering);
  query_.resample(renumbering);
  transfer_.storeForces(previous_);
}

// The order is that of saved states of format 4.
void ContactSolver::archive(Archive& archive)
{
  archive(current_.set, previous_.set, current_.springs, previous_.springs);
  transfer_.archive(archive);
  surface_.archive(archive);
  archive(valid_, solve_precedes_detection_);
  query_.archiveStaleness(archive);
  trust_region_.archive(archive);
  query_.archive(archive);
  if (!archive.reading())
    return;
  requireFit(current_.set, rod_.nodes());
  requireFit(previous_.set, rod_.nodes());
  // The present springs are those of an earlier set, possibly of other nodes, until the next solve prepares them.
  requireFit(previous_.springs, previous_.set.features.size(), rod_.nodes());
}

}  // namespace endovascular_sim::rod
