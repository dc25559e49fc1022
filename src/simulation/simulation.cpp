#include "simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/error.h"
#include "rod/contact/contact_margins.h"
#include "scene/schema/scene_schema.h"
#include "simulation/stepper_factory.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kMaxHandSpeed = 1.0;            // m/s
constexpr double kMaxHandTurn = 60.0;            // rad/s
constexpr double kMaxRotationPerSubstep = 0.05;  // rad
constexpr double kGripTime = 10e-3;              // s in which the grip follows the force
constexpr double kTravelPerEdge = 0.25;          // of the shortest edge: more counts as its rotation
constexpr double kSlipBand = 0.1;                // of the limit, over which the grip lets go
constexpr double kAtIntroducer = 0.1e-3;         // m by which an instrument that is outside may stand deeper
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

rod::State initialStack(const scene::Scene& scene, const rod::StackStepper& stack)
{
  std::vector<rod::LayerInput> layers;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    layers.push_back({std::max(stack.outside(), driven.drive.insertionAt(0.0)), driven.drive.rotationAt(0.0)});
  return stack.initialState(layers);
}

/** Motion of one hand that an old contact set covers: its share of the least margin, balloons folded, less what may
 * have been moved on that set before [m]. */
double blindCover(const scene::Scene& scene)
{
  double widest = 0.0;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    widest = std::max(widest, instrument::crossingRadius(driven.instrument));
  const double margin = scene.solver.contact_margin * rod::marginShare(widest);
  const double left = std::max(0.5 * margin, margin - scene.solver.max_travel_per_substep);
  return left / static_cast<double>(scene.instruments.size());
}

}  // namespace

std::vector<HandCommand> commandsAt(const scene::Scene& scene, double time)
{
  std::vector<HandCommand> commands;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    commands.push_back({driven.drive.insertionAt(time), driven.drive.rotationAt(time), driven.drive.pressureAt(time)});
  return commands;
}

Simulation::Simulation(const scene::Scene& scene, const scene::EntryPose& entry, contact::ContactSource* contacts,
                       const vessel::CentrelineTree* centreline, intervention::DeformableWall* wall)
  : scene_(scene),
    distal_direction_(scene.distal.direction.isZero() ? entry.direction : scene.distal.direction.normalized()),
    contacts_(contacts),
    sampling_(makeSampling(scene, entry, centreline)),
    sampling_every_(samplingInterval(scene)),
    stepper_(makeStepper(scene, entry, sampling_.get())),
    channels_(scene.instruments.size(), Channel{StaleContactPacer(blindCover(scene), scene.solver.time_step)}),
    wanted_(channels_.size()),
    parts_(channels_.size()),
    stack_(dynamic_cast<const rod::StackStepper*>(stepper_.get())),
    valve_(scene.entry.valve_friction),
    treatments_(scene, wall),
    pressures_(channels_.size(), 0.0)
{
  if (sampling_ && !stepper_->resample(sampling_->discretisation()))
    throw InputError(scene.file, "sampling.kind",
                     "scheme '" + scene.solver.scheme + "' keeps its nodes; set sampling.kind: uniform");
  const rod::Discretisation& wire = stepper_->discretisation();
  max_travel_ = scene.solver.max_travel_per_substep;
  if (!sampling_)
    max_travel_ =
        std::min(max_travel_, kTravelPerEdge * *std::min_element(wire.rest_length.begin(), wire.rest_length.end()));
  setMaxInsertions();
  state_ = stack_ != nullptr
               ? initialStack(scene, *stack_)
               : stepper_->initialState(
                     scene.introducer ? std::max(0.0, scene.instruments.front().drive.insertionAt(0.0)) : 0.0,
                     scene.instruments.front().drive.rotationAt(0.0));
  while (sampling_ && sampling_->update(state_))
    stepper_->resample(sampling_->discretisation());
}

/** The introducer's guide must stay filled: an instrument's end cannot be pushed into it. */
void Simulation::setMaxInsertions()
{
  for (int k = 0; k < instruments(); ++k)
  {
    const rod::Discretisation& wire = stepper_->discretisation();
    Channel& channel = channels_[k];
    channel.max_insertion = stack_ != nullptr
                                ? stack_->maxInsertion(k)
                                : wire.length() - scene_.solver.guide_length - 3.0 * wire.rest_length.front();
    if (scene_.introducer && scene_.instruments[k].drive.initial_insertion > channel.max_insertion)
      throw InputError(scene_.file, scene::drivePath(scene_, k) + "drive.initial_insertion",
                       "leaves less of the wire outside than the introducer's guide; at most " +
                           std::to_string(channel.max_insertion) + " m");
  }
}

HandState Simulation::hand(int instrument) const
{
  if (stack_ == nullptr)
    return {state_.inserted_length, state_.rotation, state_.hand_force, state_.hand_torque, pressures_.front()};
  const rod::LayerState& layer = state_.layers[instrument];
  return {layer.inserted_length, layer.rotation, layer.hand_force, layer.hand_torque, pressures_[instrument]};
}

void Simulation::setPressures(const std::vector<HandCommand>& commands)
{
  for (int k = 0; k < instruments(); ++k)
  {
    if (commands[k].pressure != 0.0 && (treatments_.of(k) == nullptr || scene_.solver.scheme != "kkt"))
      throw std::invalid_argument("Simulation: a pressure for an instrument without a balloon, or without scheme kkt");
    pressures_[k] = commands[k].pressure;
  }
}

bool Simulation::isOutside(int instrument) const
{
  return stack_ != nullptr && hand(instrument).insertion <= stack_->outside() + kAtIntroducer;
}

/** What the hand asks for in a step, as far as it can move at all. */
HandCommand Simulation::wantedMotion(int instrument, const HandCommand& command)
{
  const double dt = scene_.solver.time_step;
  const bool blind = contacts_ != nullptr && stepper_->contactSet().stale;
  Channel& channel = channels_[instrument];
  const HandState now = hand(instrument);
  HandCommand rest{0.0, command.rotation - channel.slipped_rotation - now.rotation};
  if (scene_.introducer)
    rest.insertion = (stack_ != nullptr ? std::max(stack_->outside(), command.insertion) : command.insertion) -
                     channel.slipped_insertion - now.insertion;
  HandCommand wanted = channel.blind_hand.follow(rest, blind);
  wanted.insertion = std::clamp(wanted.insertion, -kMaxHandSpeed * dt, kMaxHandSpeed * dt);
  wanted.rotation = std::clamp(wanted.rotation, -kMaxHandTurn * dt, kMaxHandTurn * dt);
  return wanted;
}

/** An instrument can leave the introducer where another one stays in it. */
double Simulation::leastInsertion(int instrument) const
{
  for (int k = 0; stack_ != nullptr && k < instruments(); ++k)
    if (k != instrument && hand(k).insertion >= 0.0)
      return stack_->outside();
  return 0.0;
}

/** An instrument stays outside while one is inside that does not fit into it, or that it does not fit into. */
double Simulation::mostInsertion(int instrument) const
{
  for (int k = 0; stack_ != nullptr && k < instruments(); ++k)
  {
    const bool inner = k < instrument;
    if (k != instrument && !isOutside(k) &&
        !instrument::fitsInside(scene_.instruments[inner ? k : instrument].instrument,
                                scene_.instruments[inner ? instrument : k].instrument))
      return std::max(stack_->outside(), std::min(hand(instrument).insertion, channels_[instrument].max_insertion));
  }
  return channels_[instrument].max_insertion;
}

/** What of a wanted motion reaches the wire in a sub-step of @p dt [s]: the grip answers in every one of them. */
HandCommand Simulation::allowedMotion(int instrument, const HandCommand& wanted, double dt)
{
  HandCommand motion = wanted;
  if (!scene_.introducer)
    return motion;
  Channel& channel = channels_[instrument];
  const HandState now = hand(instrument);
  const scene::DriveScene& drive = scene_.instruments[instrument].drive;
  channel.grip = nextGrip(channel.grip, wanted.insertion, now.force, drive.force_limit, dt);
  const double reached = std::max(leastInsertion(instrument),
                                  std::min(mostInsertion(instrument), now.insertion + channel.grip * wanted.insertion));
  motion.insertion = reached - now.insertion;
  channel.slipped_insertion += wanted.insertion - motion.insertion;
  channel.turning_grip = nextGrip(channel.turning_grip, wanted.rotation, now.torque, drive.torque_limit, dt);
  motion.rotation = channel.turning_grip * wanted.rotation;
  channel.slipped_rotation += wanted.rotation - motion.rotation;
  return motion;
}

void Simulation::applyLoads(rod::StepInput& input) const
{
  const rod::Discretisation& wire = stepper_->discretisation();
  const double end_time = time() + scene_.solver.time_step;
  for (const scene::PointLoad& load : scene_.loads.point_loads)
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
  const scene::DistalScene& distal = scene_.distal;
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
  if (!treatments_.empty())
    stepper_->setContactRadii(treatments_.contactRadii(state_, discretisation(), contactSet()));
  valve_.release(state_);
  report_.add(stepper_->step(state_, input, dt, pass, contacts_, timer_));
  if (stack_ != nullptr)
    return;
  const double outside = stepper_->discretisation().length() - state_.inserted_length;
  valve_.drag(state_, state_.inserted_length - insertion, state_.rotation - rotation,
              scene_.instruments.front().instrument.wire.radiusAt(outside));
}

/** Sub-steps in which no hand moves further than the solver takes at once. */
int Simulation::substepsFor(const std::vector<HandCommand>& wanted, const rod::EndMotion& from,
                            const rod::EndMotion& to) const
{
  double travel = (to.displacement - from.displacement).norm();
  double turn = std::max(std::abs(to.rotation - from.rotation), (to.tilt - from.tilt).norm());
  for (const HandCommand& hand : wanted)
  {
    travel = std::max(travel, std::abs(hand.insertion));
    turn = std::max(turn, std::abs(hand.rotation));
  }
  const double substeps = std::max(travel / max_travel_, turn / kMaxRotationPerSubstep);
  return std::max(1, static_cast<int>(std::ceil(substeps - 1e-9)));
}

/** Where every hand is at the end of a sub-step. */
void Simulation::setHands(const std::vector<HandCommand>& parts, bool blind, double dt, rod::StepInput& input)
{
  for (int k = 0; k < instruments(); ++k)
  {
    const HandCommand motion = blind ? HandCommand() : allowedMotion(k, parts[k], dt);
    if (blind)
      channels_[k].blind_hand.miss(parts[k]);
    const HandState now = hand(k);
    if (stack_ != nullptr)
      input.layers.push_back({now.insertion + motion.insertion, now.rotation + motion.rotation});
    else
    {
      input.inserted_length = now.insertion + motion.insertion;
      input.rotation = now.rotation + motion.rotation;
    }
  }
}

void Simulation::stepAll(const std::vector<HandCommand>& commands)
{
  if (commands.size() != channels_.size())
    throw std::invalid_argument("Simulation: one command for every instrument");
  setPressures(commands);
  timer_.reset();
  resample();
  double travel = 0.0;
  for (int k = 0; k < instruments(); ++k)
  {
    wanted_[k] = wantedMotion(k, commands[k]);
    travel = std::max(travel, std::abs(wanted_[k].insertion));
  }
  const rod::EndMotion from = state_.distal;
  const rod::EndMotion to = distalMotionAt(time() + scene_.solver.time_step);
  travel = std::max(travel, (to.displacement - from.displacement).norm());
  const int substeps = substepsFor(wanted_, from, to);
  const double dt = scene_.solver.time_step / substeps;
  for (int k = 0; k < instruments(); ++k)
    parts_[k] = {wanted_[k].insertion / substeps, wanted_[k].rotation / substeps};
  report_ = rod::StepReport();
  std::uint32_t pass = 0;
  const std::uint64_t vessel_version = treatments_.beginStep(steps_);
  for (int k = 1; k <= substeps; ++k)
  {
    rod::StepInput input;
    input.step = steps_;
    input.substep = static_cast<std::uint32_t>(k - 1);
    input.vessel_version = vessel_version;
    // The hand is slow enough already, unless the first set that failed to come did so in the middle of a fast step.
    const bool blind =
        k > 1 && travel > channels_.front().blind_hand.reach() && contacts_ != nullptr && stepper_->contactSet().stale;
    setHands(parts_, blind, dt, input);
    input.distal = blind ? state_.distal : rod::between(from, to, static_cast<double>(k) / substeps);
    applyLoads(input);
    moveWire(input, dt, pass);
    if (!report_.solved)
      break;  // the wire stays where it is; the hand's motion is made up for in the steps that follow
  }
  treatments_.endStep(steps_, pressures_, state_, discretisation());
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
  query.first_node = state_.first_node;
  query.nodes.assign(state_.position.begin() + state_.first_node, state_.position.end());
  const std::vector<double>& radius = discretisation().radius;
  query.radius.assign(radius.begin() + state_.first_node, radius.end());
  rod::uniformMargin(scene_.solver.contact_margin).apply(query);
  return query;
}

double Simulation::surfacePenetration() const
{
  double deepest = 0.0;
  for (const contact::Feature& feature : stepper_->contactSet().features)
    deepest = std::max(deepest, -feature.gap);
  return deepest;
}

}  // namespace endovascular_sim::simulation
