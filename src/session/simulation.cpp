#include "session/simulation.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "session/make_stepper.h"

namespace endovascular_sim::session
{
namespace
{

constexpr double kMaxHandSpeed = 1.0;            // m/s
constexpr double kMaxHandTurn = 60.0;            // rad/s
constexpr double kMaxRotationPerSubstep = 0.05;  // rad
constexpr double kGripTime = 10e-3;              // s in which the grip follows the force
constexpr double kTravelPerEdge = 0.25;          // of the shortest edge: more counts as its rotation
constexpr double kSlipBand = 0.1;                // of the limit, over which the grip lets go
constexpr double kFreeBand = 0.5;                // of the limit, beyond it, from where nothing holds at all

/** Grip of the hand, 1 firm to 0 slipping, after a time @p dt [s] in which the wire resisted the wanted motion. It
 *  follows the force with a delay: a grip that answered at once would chatter, because the wire's inertia answers every
 *  change. Far beyond the limit it lets go at once: a fast hand would push millimetres in the delay. */
double nextGrip(double grip, double wanted, double resistance, double limit, double dt)
{
  const double against = wanted > 0.0 ? resistance : -resistance;
  const double target = std::max(0.0, std::min(1.0, (limit - against) / (kSlipBand * limit)));
  const double firm = 1.0 - (against - limit) / (kFreeBand * limit);
  return std::max(0.0, std::min(grip + std::min(1.0, dt / kGripTime) * (target - grip), firm));
}

}  // namespace

Simulation::Simulation(const Scene& scene, const EntryPose& entry, contact::ContactSource* contacts,
                       const vessel::CentrelineTree* centreline)
  : scene_(scene),
    distal_direction_(scene.distal.direction.isZero() ? entry.direction : scene.distal.direction.normalized()),
    contacts_(contacts),
    sampling_(makeSampling(scene, entry, centreline)),
    sampling_every_(samplingInterval(scene)),
    stepper_(makeStepper(scene, entry, sampling_.get())),
    blind_hand_(scene.solver.contact_margin, scene.solver.time_step),
    valve_(scene.entry.valve_friction)
{
  if (sampling_ && !stepper_->resample(sampling_->discretisation()))
    throw InputError(scene.file, "sampling.kind",
                     "scheme '" + scene.solver.scheme + "' keeps its nodes; set sampling.kind: uniform");
  const rod::Discretisation& wire = stepper_->discretisation();
  max_travel_ = scene.solver.max_travel_per_substep;
  if (!sampling_)
    max_travel_ =
        std::min(max_travel_, kTravelPerEdge * *std::min_element(wire.rest_length.begin(), wire.rest_length.end()));
  // The introducer's guide must stay filled: the wire's end cannot be pushed into it.
  max_insertion_ = wire.length() - scene.solver.guide_length - 3.0 * wire.rest_length.front();
  if (scene.introducer && scene.drive.initial_insertion > max_insertion_)
    throw InputError(scene.file, "drive.initial_insertion",
                     "leaves less of the wire outside than the introducer's guide; at most " +
                         std::to_string(max_insertion_) + " m");
  const double insertion = scene.introducer ? std::max(0.0, scene.drive.insertionAt(0.0)) : 0.0;
  state_ = stepper_->initialState(insertion, scene.drive.rotationAt(0.0));
  while (sampling_ && sampling_->update(state_))
    stepper_->resample(sampling_->discretisation());
}

/** What the hand asks for in a step, as far as it can move at all. */
HandCommand Simulation::wantedMotion(const HandCommand& command)
{
  const double dt = scene_.solver.time_step;
  const bool blind = contacts_ != nullptr && stepper_->contactSet().stale;
  HandCommand rest{0.0, command.rotation - slipped_rotation_ - state_.rotation};
  if (scene_.introducer)
    rest.insertion = command.insertion - slipped_insertion_ - state_.inserted_length;
  HandCommand wanted = blind_hand_.follow(rest, blind);
  wanted.insertion = std::clamp(wanted.insertion, -kMaxHandSpeed * dt, kMaxHandSpeed * dt);
  wanted.rotation = std::clamp(wanted.rotation, -kMaxHandTurn * dt, kMaxHandTurn * dt);
  return wanted;
}

/** What of a wanted motion reaches the wire in a sub-step of @p dt [s]: the grip answers in every one of them. */
HandCommand Simulation::allowedMotion(const HandCommand& wanted, double dt)
{
  HandCommand motion = wanted;
  if (!scene_.introducer)
    return motion;
  grip_ = nextGrip(grip_, wanted.insertion, state_.hand_force, scene_.drive.force_limit, dt);
  const double reached = std::max(0.0, std::min(max_insertion_, state_.inserted_length + grip_ * wanted.insertion));
  motion.insertion = reached - state_.inserted_length;
  slipped_insertion_ += wanted.insertion - motion.insertion;
  turning_grip_ = nextGrip(turning_grip_, wanted.rotation, state_.hand_torque, scene_.drive.torque_limit, dt);
  motion.rotation = turning_grip_ * wanted.rotation;
  slipped_rotation_ += wanted.rotation - motion.rotation;
  return motion;
}

void Simulation::applyLoads(rod::StepInput& input) const
{
  const rod::Discretisation& wire = stepper_->discretisation();
  const double end_time = time() + scene_.solver.time_step;
  for (const PointLoad& load : scene_.loads.point_loads)
  {
    const double share = load.ramp_time > 0.0 ? std::min(1.0, end_time / load.ramp_time) : 1.0;
    input.tip_torque += share * load.torque;
    if (load.force.isZero(0.0))
      continue;
    const auto after = std::upper_bound(wire.position.begin(), wire.position.end(), load.position);
    const int edge = std::max(0, std::min(wire.nodes() - 2, static_cast<int>(after - wire.position.begin()) - 1));
    const double t = std::max(0.0, std::min(1.0, (load.position - wire.position[edge]) / wire.rest_length[edge]));
    input.forces.push_back({edge, (1.0 - t) * share * load.force});
    input.forces.push_back({edge + 1, t * share * load.force});
  }
}

rod::EndMotion Simulation::distalMotionAt(double t) const
{
  const DistalScene& distal = scene_.distal;
  return {distal.displacement.at(t) * distal_direction_, distal.tilt.at(t) * distal.tilt_axis.normalized(),
          distal.rotation.at(t)};
}

/** Old contacts are good for the edges that they were found at. */
void Simulation::resample()
{
  if (!sampling_ || steps_ % sampling_every_ != 0 || stepper_->contactSet().stale)
    return;
  PhaseTimer::Scope scope(timer_, Phase::kSampling);
  if (sampling_->update(state_))
    stepper_->resample(sampling_->discretisation());
}

/** The wire's own step, and what the introducer's valve adds to the force and the torque at the hand. */
void Simulation::moveWire(const rod::StepInput& input, double dt, std::uint32_t& pass)
{
  const double insertion = state_.inserted_length;
  const double rotation = state_.rotation;
  valve_.release(state_);
  report_.add(stepper_->step(state_, input, dt, pass, contacts_, timer_));
  const double outside = stepper_->discretisation().length() - state_.inserted_length;
  valve_.drag(state_, state_.inserted_length - insertion, state_.rotation - rotation,
              scene_.instrument.wire.radiusAt(outside));
}

void Simulation::step(const HandCommand& command)
{
  timer_.reset();
  resample();
  const HandCommand wanted = wantedMotion(command);
  const rod::EndMotion from = state_.distal;
  const rod::EndMotion to = distalMotionAt(time() + scene_.solver.time_step);
  const double travel = std::max(std::abs(wanted.insertion), (to.displacement - from.displacement).norm());
  const double turn =
      std::max({std::abs(wanted.rotation), std::abs(to.rotation - from.rotation), (to.tilt - from.tilt).norm()});
  const double substeps_wanted = std::max(travel / max_travel_, turn / kMaxRotationPerSubstep);
  const int substeps = std::max(1, static_cast<int>(std::ceil(substeps_wanted - 1e-9)));
  const double dt = scene_.solver.time_step / substeps;
  report_ = rod::StepReport();
  std::uint32_t pass = 0;
  for (int k = 1; k <= substeps; ++k)
  {
    rod::StepInput input;
    input.step = steps_;
    input.substep = static_cast<std::uint32_t>(k - 1);
    // The hand is slow enough already, unless the first set that failed to come did so in the middle of a fast step.
    const bool blind = k > 1 && travel > blind_hand_.reach() && contacts_ != nullptr && stepper_->contactSet().stale;
    const HandCommand part{wanted.insertion / substeps, wanted.rotation / substeps};
    const HandCommand motion = blind ? HandCommand() : allowedMotion(part, dt);
    if (blind)
      blind_hand_.miss(part);
    input.inserted_length = state_.inserted_length + motion.insertion;
    input.rotation = state_.rotation + motion.rotation;
    input.distal = blind ? state_.distal : rod::between(from, to, static_cast<double>(k) / substeps);
    applyLoads(input);
    moveWire(input, dt, pass);
    if (!report_.solved)
      break;  // the wire stays where it is; the hand's motion is made up for in the steps that follow
  }
  ++steps_;
  state_hash_ = state_.hash();
  trajectory_.add(state_hash_);
}

void Simulation::setState(rod::State state)
{
  state_ = std::move(state);
  stepper_->invalidateContacts();
}

contact::Query Simulation::initialQuery() const
{
  contact::Query query;
  query.margin = scene_.solver.contact_margin;
  query.first_node = state_.first_node;
  query.nodes.assign(state_.position.begin() + state_.first_node, state_.position.end());
  const std::vector<double>& radius = discretisation().radius;
  query.radius.assign(radius.begin() + state_.first_node, radius.end());
  return query;
}

double Simulation::surfacePenetration() const
{
  double deepest = 0.0;
  for (const contact::Feature& feature : stepper_->contactSet().features)
    deepest = std::max(deepest, -feature.gap);
  return deepest;
}

}  // namespace endovascular_sim::session
