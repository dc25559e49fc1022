#include "simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/error.h"
#include "rod/boundary/boundary_conditions.h"
#include "rod/contact/contact_margins.h"
#include "rod/stepping/solution_observer.h"
#include "scene/schema/scene_schema.h"
#include "simulation/stepper_factory.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kMaxRotationPerSubstep = 0.05;  // rad
constexpr double kTravelPerEdge = 0.25;          // largest travel of a sub-step, in shortest edges
constexpr double kAtIntroducer = 0.1e-3;         // m, tolerance of the insertion of an instrument outside

/** Motion of one handle that a stale contact set covers [m]: the margin at the widest folded instrument minus the
 *  travel of a sub-step, divided by the number of handles. */
double staleCover(const scene::Scene& scene)
{
  double widest = 0.0;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    widest = std::max(widest, instrument::crossingRadius(driven.instrument));
  const double margin = scene.solver.stepper.contact_margin * rod::marginShare(widest);
  const double left = std::max(0.5 * margin, margin - scene.solver.max_travel_per_substep);
  return left / static_cast<double>(scene.instruments.size());
}

/** Rollers of a scene at the start; null without. */
std::unique_ptr<contact::Rollers> makeRollers(const scene::Scene& scene)
{
  if (scene.rollers.empty())
    return nullptr;
  std::vector<contact::Roller> rollers;
  for (const scene::RollerScene& roller : scene.rollers)
    rollers.push_back({roller.positionAt(0.0), roller.axis, roller.radius, roller.friction});
  return std::make_unique<contact::Rollers>(std::move(rollers));
}

}  // namespace

std::vector<drive::HandCommand> commandsAt(const scene::Scene& scene, double time)
{
  std::vector<drive::HandCommand> commands;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    commands.push_back({driven.drive.insertionAt(time), driven.drive.rotationAt(time), driven.drive.pressureAt(time)});
  return commands;
}

Simulation::Simulation(const scene::Scene& scene, const scene::EntryPose& entry, contact::ContactSource* contacts,
                       const vessel::CentrelineTree* centreline, intervention::DeformableWall* wall)
  : scene_(scene),
    entry_(entry),
    distal_direction_(scene.distal.direction.isZero() ? entry.direction : scene.distal.direction.normalized()),
    rollers_(makeRollers(scene)),
    contacts_(rollers_ ? rollers_.get() : contacts),
    sampling_(makeSampling(scene, entry, centreline)),
    samples_(sampling_ != nullptr),
    sampling_every_(samplingInterval(scene)),
    initial_nodes_(initialNodes(scene, sampling_.get())),
    stepper_(makeStepper(scene, entry, initial_nodes_)),
    max_insertions_(scene.instruments.size()),
    wanted_(scene.instruments.size()),
    parts_(scene.instruments.size()),
    valve_(scene.entry.valve_friction),
    treatments_(scene, wall),
    pressures_(scene.instruments.size(), 0.0)
{
  for (const scene::DrivenInstrument& driven : scene_.instruments)
    hands_.emplace_back(driven.drive, StaleContactPacer(staleCover(scene), scene.solver.time_step));
  const rod::Discretisation& wire = stepper_->discretisation();
  max_travel_ = scene.solver.max_travel_per_substep;
  if (!sampling_)
    max_travel_ =
        std::min(max_travel_, kTravelPerEdge * *std::min_element(wire.rest_length.begin(), wire.rest_length.end()));
  setMaxInsertions();
  if (scene_.contrast && scene_.flow)
    contrast_.emplace(scene_);
  state_ = initialState();
  while (samples_ && sampling_->update(state_))
    stepper_->resample(sampling_->discretisation());
}

rod::State Simulation::initialState() const
{
  const double least = !scene_.introducer ? 0.0 : instruments() > 1 ? outsideInsertion() : 0.0;
  std::vector<rod::LayerInput> layers;
  for (const scene::DrivenInstrument& driven : scene_.instruments)
    layers.push_back(
        {scene_.introducer ? std::max(least, driven.drive.insertionAt(0.0)) : 0.0, driven.drive.rotationAt(0.0)});
  return stepper_->initialState(layers);
}

/** Sets the largest insertions, at which the introducer's guide is still filled. */
void Simulation::setMaxInsertions()
{
  for (int k = 0; k < instruments(); ++k)
  {
    max_insertions_[k] =
        rod::maxInsertion(stepper_->layerLength(k), stepper_->discretisation(), scene_.solver.guide_length);
    if (scene_.introducer && scene_.instruments[k].drive.initial_insertion > max_insertions_[k])
      throw InputError(scene_.file, scene::drivePath(scene_, k) + "drive.initial_insertion",
                       "leaves a proximal part shorter than the introducer's guide; must be at most " +
                           std::to_string(max_insertions_[k]) + " m");
  }
}

HandState Simulation::hand(int instrument) const
{
  const rod::HandleState handle = rod::handleState(state_, instrument);
  return {handle.inserted_length, handle.rotation, handle.force, handle.torque, pressures_[instrument]};
}

drive::HandMotion Simulation::reached(int instrument) const
{
  const HandState now = hand(instrument);
  const drive::HandIncrement& slipped = hands_[instrument].slipped();
  return {now.insertion + slipped.insertion, now.rotation + slipped.rotation};
}

drive::HandMotion Simulation::slipped(int instrument) const
{
  return {hands_[instrument].slipped().insertion, hands_[instrument].slipped().rotation};
}

drive::Interval Simulation::stops(int instrument) const
{
  if (!scene_.introducer)
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const double least = leastInsertion(instrument);
  return drive::Interval{least, std::max(least, mostInsertion(instrument))}.shifted(
      hands_[instrument].slipped().insertion);
}

/** Insertion at which an instrument is outside the introducer [m]. */
double Simulation::outsideInsertion() const
{
  return rod::outsideInsertion(discretisation(), scene_.solver.guide_length);
}

void Simulation::setPressures(const std::vector<drive::HandCommand>& commands)
{
  for (int k = 0; k < instruments(); ++k)
  {
    if (commands[k].pressure != 0.0 && (treatments_.of(k) == nullptr || !scene_.solver.traits().balloons))
      throw std::invalid_argument("Simulation: a pressure requires an instrument with a balloon, and the scheme kkt");
    pressures_[k] = commands[k].pressure;
  }
}

bool Simulation::isOutside(int instrument) const
{
  return instruments() > 1 && hand(instrument).insertion <= outsideInsertion() + kAtIntroducer;
}

drive::HandIncrement Simulation::wantedMotion(int instrument, const drive::HandCommand& command)
{
  const bool stale = contacts_ != nullptr && stepper_->contactSet().stale;
  const double dt = scene_.solver.time_step;
  if (!scene_.introducer)
    return hands_[instrument].wanted(hand(instrument), command, nullptr, stale, dt);
  const HandleRange range = this->range(instrument);
  return hands_[instrument].wanted(hand(instrument), command, &range, stale, dt);
}

HandleRange Simulation::range(int instrument) const
{
  const double commanded = instruments() > 1 ? outsideInsertion() : -std::numeric_limits<double>::infinity();
  return {commanded, leastInsertion(instrument), mostInsertion(instrument)};
}

/** Least insertion of an instrument. It can leave the introducer only while another one stays in it. */
double Simulation::leastInsertion(int instrument) const
{
  for (int k = 0; k < instruments(); ++k)
    if (k != instrument && hand(k).insertion >= 0.0)
      return outsideInsertion();
  return 0.0;
}

/** Largest insertion of an instrument. It stays outside while another one is inside and neither fits into the other. */
double Simulation::mostInsertion(int instrument) const
{
  for (int k = 0; k < instruments(); ++k)
  {
    const bool inner = k < instrument;
    if (k != instrument && !isOutside(k) &&
        !instrument::fitsInside(scene_.instruments[inner ? k : instrument].instrument,
                                scene_.instruments[inner ? instrument : k].instrument))
      return std::max(outsideInsertion(), std::min(hand(instrument).insertion, max_insertions_[instrument]));
  }
  return max_insertions_[instrument];
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

/** Longest travel of a roller in the coming step [m]. */
double Simulation::travelOfRollers() const
{
  double longest = 0.0;
  for (const scene::RollerScene& roller : scene_.rollers)
    longest = std::max(
        longest, std::abs(roller.displacement.at(time() + scene_.solver.time_step) - roller.displacement.at(time())));
  return longest;
}

/** Work of the rollers on the wire by their last movement: every node with a force bears on the nearest one [J].
 *  @param before positions before the movement */
double Simulation::workOfRollers(const std::vector<contact::Roller>& before) const
{
  double work = 0.0;
  for (std::size_t i = 0; i < state_.wall_force.size(); ++i)
  {
    if (state_.wall_force[i].isZero(0.0))
      continue;
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < before.size(); ++k)
      if (contact::distanceFrom(rollers_->rollers()[k], state_.position[i]) <
          contact::distanceFrom(rollers_->rollers()[nearest], state_.position[i]))
        nearest = k;
    work += state_.wall_force[i].dot(rollers_->rollers()[nearest].position - before[nearest].position);
  }
  return work;
}

/** Moves the rollers to their positions at a time [s].
 *  @return true if one has moved, so that the contact set is invalid */
bool Simulation::placeRollers(double time)
{
  bool moved = false;
  for (std::size_t k = 0; rollers_ && k < scene_.rollers.size(); ++k)
  {
    const Eigen::Vector3d position = scene_.rollers[k].positionAt(time);
    moved = moved || rollers_->rollers()[k].position != position;
    rollers_->moveTo(k, position);
  }
  return moved;
}

/** Updates adaptive sampling. A stale contact set holds only for the present edges. */
void Simulation::resample()
{
  if (!samples_ || steps_ % sampling_every_ != 0 || stepper_->contactSet().stale)
    return;
  PhaseTimer::Scope scope(timer_, Phase::kSampling);
  if (!sampling_->update(state_, &positionsAtRest()))
    return;
  stepper_->resample(sampling_->discretisation());
  positions_at_rest_.clear();
}

/** Sets the least radius for contact at every node. */
void Simulation::prepareContactRadii()
{
  if (treatments_.empty())
    return;
  PhaseTimer::Scope scope(timer_, Phase::kBalloon);
  stepper_->setContactRadii(treatments_.contactRadii(state_, discretisation(), contactSet()));
}

/** Steps the wire, and adds the force and the torque of the introducer's valve on the hand. */
void Simulation::moveWire(const rod::StepInput& input, double dt, std::uint32_t& pass)
{
  const double insertion = state_.inserted_length;
  const double rotation = state_.rotation;
  valve_.release(state_);
  report_.add(stepper_->step(state_, input, dt, pass, contacts_, timer_));
  if (!valve_.present())
    return;
  const double outside = stepper_->discretisation().length() - state_.inserted_length;
  valve_.drag(state_, state_.inserted_length - insertion, state_.rotation - rotation,
              scene_.instruments.front().instrument.wire.radiusAt(outside));
  if (observer_ != nullptr)
    observer_->addValve(state_.hand_parts.valve * (state_.inserted_length - insertion),
                        state_.valve_torque * (state_.rotation - rotation));
}

/** True where a hand of a state bears more than its grip. */
bool Simulation::isBeyondGrip(const rod::State& state) const
{
  for (int k = 0; k < instruments(); ++k)
    if (!drive::GripSearch::isWithin(rod::handleState(state, k).force, scene_.instruments[k].drive.force_limit))
      return true;
  return false;
}

/** Search that begins with the state before the sub-step. */
drive::GripSearch Simulation::gripSearch() const
{
  std::vector<drive::GrippingHand> hands;
  for (int k = 0; k < instruments(); ++k)
  {
    const rod::HandleState handle = rod::handleState(before_, k);
    const double least = std::min(leastInsertion(k), handle.inserted_length);
    hands.push_back({scene_.instruments[k].drive.force_limit, least, std::max(mostInsertion(k), handle.inserted_length),
                     handle.inserted_length, handle.force});
  }
  return drive::GripSearch(std::move(hands));
}

/** Steps the wire. A hand that would bear more than its grip slips: the sub-step is repeated until no hand does. Where
 *  no such positions are found, the friction between the instruments yields. Where that does not help, as beside a snap
 *  of the wire, the instruments rest for the sub-step, and the hands slip. */
void Simulation::moveWithinGrips(rod::StepInput& input, double dt, std::uint32_t& pass)
{
  before_ = state_;
  if (observer_ != nullptr)
    observer_->keep();
  moveWire(input, dt, pass);
  if (!scene_.introducer || !report_.solved || !isBeyondGrip(state_))
    return;
  const std::vector<rod::LayerInput> wanted = handles_;
  drive::GripSearch search = gripSearch();
  hand_positions_.clear();
  for (const rod::LayerInput& handle : handles_)
    hand_positions_.push_back(handle.inserted_length);
  const auto repeat = [&]
  {
    setState(before_);
    if (observer_ != nullptr)
      observer_->revert();
    input.setHandles(handles_);
    moveWire(input, dt, pass);
  };
  while (report_.solved && !stepper_->contactSet().stale)
  {
    hand_forces_.clear();
    for (int k = 0; k < instruments(); ++k)
      hand_forces_.push_back(hand(k).force);
    if (!search.improve(hand_forces_, hand_positions_))
      break;
    for (int k = 0; k < instruments(); ++k)
      handles_[k].inserted_length = hand_positions_[k];
    repeat();
  }
  if (report_.solved && !stepper_->contactSet().stale && isBeyondGrip(state_))
  {
    for (int k = 0; k < instruments(); ++k)
      handles_[k].most_force = scene_.instruments[k].drive.force_limit;
    repeat();
  }
  if (report_.solved && isBeyondGrip(state_) && !isBeyondGrip(before_))
    rest(input);
  for (int k = 0; report_.solved && k < instruments(); ++k)
    hands_[k].noteSlip(rod::handleState(before_, k).inserted_length, wanted[k].inserted_length,
                       handles_[k].inserted_length);
}

/** Undoes the sub-step; the wall goes on. @param input of the sub-step */
void Simulation::rest(const rod::StepInput& input)
{
  setState(before_);
  carry(input.wall_from, input.wall_to);
  if (observer_ != nullptr)
    observer_->revert();
  for (int k = 0; k < instruments(); ++k)
    handles_[k].inserted_length = rod::handleState(before_, k).inserted_length;
}

/** Number of sub-steps in which no handle moves further than allowed. */
int Simulation::substepsFor(const std::vector<drive::HandIncrement>& wanted, const rod::EndMotion& from,
                            const rod::EndMotion& to) const
{
  double travel = std::max((to.displacement - from.displacement).norm(), travelOfRollers());
  double turn = std::max(std::abs(to.rotation - from.rotation), (to.tilt - from.tilt).norm());
  for (const drive::HandIncrement& hand : wanted)
  {
    travel = std::max(travel, std::abs(hand.insertion));
    turn = std::max(turn, std::abs(hand.rotation));
  }
  const double substeps = std::max(travel / max_travel_, turn / kMaxRotationPerSubstep);
  return std::max(1, static_cast<int>(std::ceil(substeps - 1e-9)));
}

/** Sets the positions of all handles at the end of a sub-step. */
void Simulation::setHandles(const std::vector<drive::HandIncrement>& parts, bool stale, double dt,
                            rod::StepInput& input)
{
  handles_.clear();
  for (int k = 0; k < instruments(); ++k)
  {
    const HandState now = hand(k);
    drive::HandIncrement motion = parts[k];
    if (stale)
    {
      hands_[k].pacer().miss(parts[k]);
      motion = drive::HandIncrement();
    }
    else if (scene_.introducer)
      motion = hands_[k].allowed(now, parts[k], range(k), dt);
    handles_.push_back({now.insertion + motion.insertion, now.rotation + motion.rotation});
  }
  input.setHandles(handles_);
}

/** @return version of the vessel in this step */
std::uint64_t Simulation::beginTreatments()
{
  PhaseTimer::Scope scope(timer_, treatments_.empty() ? Phase::kControl : Phase::kBalloon);
  return treatments_.beginStep(steps_);
}

void Simulation::endTreatments()
{
  PhaseTimer::Scope scope(timer_, treatments_.empty() ? Phase::kControl : Phase::kBalloon);
  treatments_.endStep(steps_, pressures_, state_, positionsAtRest(), discretisation());
}

void Simulation::setBlood(std::unique_ptr<BloodCoupling> blood,
                          std::function<const std::vector<Eigen::Vector3d>&()> wall)
{
  blood_ = std::move(blood);
  wall_ = std::move(wall);
}

/** Begins a step of the flow of blood where one is due. */
void Simulation::exchangeBlood(std::uint64_t vessel_version)
{
  if (!blood_ || !blood_->isDue(steps_))
    return;
  PhaseTimer::Scope scope(timer_, Phase::kBlood);
  if (contrast_)
    blood_->setInjection(contrast_->advance(
        time(), insertions(),
        [this] { return blood_->pathOf(contrast_->instrument(), state_, positionsAtRest(), discretisation()); }));
  blood_->exchange(state_, positionsAtRest(), motion_ ? &motion_->patient().map() : nullptr, discretisation(),
                   treatments_, wall_(), vessel_version);
}

std::vector<double> Simulation::insertions() const
{
  std::vector<double> lengths;
  for (int k = 0; k < instruments(); ++k)
    lengths.push_back(hand(k).insertion);
  return lengths;
}

std::string Simulation::refusalOf(const contrast::Injection& injection, bool refill) const
{
  if (!contrast_ || !blood_)
    return "the scene has no contrast medium; give it the key contrast";
  return contrast_->refusalOf(injection, refill, insertions());
}

/** Follows an input before the next step. */
void Simulation::follow(const contrast::Injection& injection, bool refill)
{
  if (!contrast_ || !blood_)
    throw std::logic_error("Simulation: the scene has no contrast medium; give it the key contrast");
  contrast_->follow({steps_, injection, refill});
}

void Simulation::inject(const contrast::Injection& injection, bool refill)
{
  const std::string refusal = refusalOf(injection, refill);
  if (contrast_ && blood_ && !refusal.empty())
    throw std::invalid_argument("injection: " + refusal);
  follow(injection, refill);
}

void Simulation::stopInjection()
{
  follow({}, false);
}

void Simulation::refillSyringe()
{
  follow({}, true);
}

void Simulation::setMotion(const PatientMotion& motion)
{
  if (!scene_.solver.traits().moving_walls || motion_)
    throw std::logic_error("Simulation: a moving patient requires the scheme kkt, and is set once");
  motion_ = std::make_unique<MotionCoupling>(motion, scene_.solver.time_step, contacts_);
  if (contacts_ != nullptr)
    contacts_ = motion_->contacts();
  positions_at_rest_.clear();
}

const std::vector<Eigen::Vector3d>& Simulation::positionsAtRest() const
{
  if (!motion_)
    return state_.position;
  if (positions_at_rest_.empty())
    motion_->patient().map().pullBack(state_.position, positions_at_rest_);
  return positions_at_rest_;
}

/** Advances the patient. With flow of blood, the heart follows its clock. */
void Simulation::beginMotion()
{
  if (!motion_)
    return;
  PhaseTimer::Scope scope(timer_, Phase::kControl);
  const std::optional<HeartClock> clock =
      blood_ ? blood_->heartClock(steps_, scene_.solver.time_step) : std::optional<HeartClock>();
  motion_->beginStep(clock ? &*clock : nullptr);
  positions_at_rest_.clear();
}

/** Carries a wire that rests in the vessel with the wall. @param from, to shares of the step */
void Simulation::carry(double from, double to)
{
  if (!motion_ || motion_->wall() == nullptr)
    return;
  contact::WallTravel travel;
  motion_->wall()->move(from, to, state_.position, state_.first_node, travel);
  for (std::size_t i = 0; i < travel.displacement.size(); ++i)
    state_.position[i] += travel.displacement[i];
  stepper_->invalidateContacts();
}

/** Sets the motion of the wall in a sub-step. */
void Simulation::setWall(int substep, int substeps, rod::StepInput& input)
{
  if (!motion_)
    return;
  input.wall = motion_->wall();
  input.wall_from = static_cast<double>(substep - 1) / substeps;
  input.wall_to = static_cast<double>(substep) / substeps;
}

void Simulation::stepAll(const std::vector<drive::HandCommand>& commands)
{
  if (commands.size() != hands_.size())
    throw std::invalid_argument("Simulation: requires one command for every instrument");
  timer_.reset();
  PhaseTimer::Scope scope(timer_, Phase::kControl);
  setPressures(commands);
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
  const std::uint64_t vessel_version = beginTreatments();
  exchangeBlood(vessel_version);
  beginMotion();
  for (int k = 1; k <= substeps; ++k)
  {
    rod::StepInput input;
    setWall(k, substeps, input);
    input.step = steps_;
    input.substep = static_cast<std::uint32_t>(k - 1);
    input.vessel_version = vessel_version;
    // The pacer has slowed the handle already, unless the first stale set occurred in the middle of a fast step.
    const bool stale =
        k > 1 && travel > hands_.front().pacer().reach() && contacts_ != nullptr && stepper_->contactSet().stale;
    setHandles(parts_, stale, dt, input);
    input.distal = stale ? state_.distal : rod::between(from, to, static_cast<double>(k) / substeps);
    applyLoads(input);
    if (blood_)
      blood_->addLoads(state_, discretisation(), input);
    const std::vector<contact::Roller> rollers = rollers_ ? rollers_->rollers() : std::vector<contact::Roller>();
    const bool rollers_move = placeRollers(time() + k * dt);
    if (rollers_move)
      stepper_->invalidateContacts();
    prepareContactRadii();
    moveWithinGrips(input, dt, pass);
    if (rollers_move && observer_ != nullptr && report_.solved)
      observer_->addMovedWall(workOfRollers(rollers));
    if (!report_.solved)
    {
      carry(input.wall_from, 1.0);
      break;  // the wire keeps its position in the vessel; later steps make up for the motion of the handle
    }
  }
  positions_at_rest_.clear();
  endTreatments();
  ++steps_;
  state_hash_ = state_.hash();
  trajectory_.add(state_hash_);
}

void Simulation::setObserver(rod::SolutionObserver* observer)
{
  stepper_->setObserver(observer);
  observer_ = observer;
}

void Simulation::setState(rod::State state)
{
  state_ = std::move(state);
  positions_at_rest_.clear();
  stepper_->invalidateContacts();
}

contact::Query Simulation::initialQuery() const
{
  contact::Query query;
  query.first_node = state_.first_node;
  query.nodes.assign(state_.position.begin() + state_.first_node, state_.position.end());
  const std::vector<double>& radius = discretisation().radius;
  query.radius.assign(radius.begin() + state_.first_node, radius.end());
  rod::uniformMargin(scene_.solver.stepper.contact_margin).apply(query);
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
