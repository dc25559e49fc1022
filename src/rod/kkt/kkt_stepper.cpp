#include "rod/kkt/kkt_stepper.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/archive.h"
#include "rod/kkt/layer_stack.h"
#include "rod/kkt/single_layer.h"
#include "rod/kkt/turn_truncation.h"
#include "rod/sampling/resampling.h"
#include "rod/stepping/solution_observer.h"
#include "rod/twist/bishop_frames.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kEnergyGrowth = 1.1;
constexpr int kMaxRestoringSolves = 4;
constexpr double kRestoringFraction = 0.03;  // of the time step, and at most kRestoringTime
constexpr double kRestoringTime = 30e-6;     // s: elastic forces cause negligible motion in it
constexpr double kLargestStrain = 1e-2;      // that a step may leave, e.g. of a straight wire that is shortened
constexpr int kMaxDepthHalvings = 6;

/** A rod with the stack's nodes, whose properties the stack sets. */
Discretisation rodOf(const std::vector<Layer>& layers, const std::vector<double>& position)
{
  const auto longest = std::max_element(
      layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.wire.length() < b.wire.length(); });
  if (longest == layers.end() || position.size() < 3)
    throw std::invalid_argument("KktStepper: requires at least one layer and three nodes");
  return discretise(longest->wire, position);
}

void checkDrags(const std::vector<NodalDrag>& drags, int nodes)
{
  int last = -1;
  for (const NodalDrag& drag : drags)
  {
    if (drag.node <= last || drag.node >= nodes)
      throw std::invalid_argument("KktStepper: drags of a stream require ascending nodes of the wire");
    last = drag.node;
  }
}

double scaleOf(const Discretisation& rod)
{
  return rod.mass[static_cast<std::size_t>(rod.nodes() / 2)];
}

}  // namespace

KktStepper::KktStepper(Discretisation rod, Boundary boundary, Environment environment, StepperSettings settings)
  : model_(std::move(rod), std::move(boundary), std::move(environment), settings),
    layers_(std::make_unique<SingleLayer>(model_))
{
  system_.scale = scaleOf(model_.rod);
}

KktStepper::KktStepper(const std::vector<Layer>& layers, const std::vector<double>& position, Boundary boundary,
                       Environment environment, StepperSettings settings)
  : model_(rodOf(layers, position), std::move(boundary), std::move(environment), settings),
    layers_(std::make_unique<LayerStack>(layers, model_))
{
  system_.scale = scaleOf(model_.rod);
}

StepReport KktStepper::step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                            contact::ContactSource* contacts, PhaseTimer& timer)
{
  checkDrags(input.drags, model_.rod.nodes());
  contacts_.beginStep(input, contacts, pass, timer);
  timer_ = &timer;
  motion_.resize(state.position.size());
  last_input_ = input;
  {
    PhaseTimer::Scope scope(timer, Phase::kLayers);
    if (layers_->beginStep(state, input, dt, friction_))
      contacts_.invalidate();
  }
  StepReport report;
  if (observer_ != nullptr)
    observer_->beginStep(model_.rod, state);
  report.solved = advance(state, layers_->centrelineInput(state, input), dt, report);
  if (observer_ != nullptr)
    observer_->endStep(report.solved);
  report.max_strain = strain_;
  return report;
}

bool KktStepper::advance(State& state, const StepInput& input, double dt, StepReport& report)
{
  const bool solved = bisection_.advance(
      state, input, dt, report,
      [this, &report](State& part, const State& before, const StepInput& at, double part_dt, bool shortest)
      {
        const bool accepted =
            solveStep(part, at, part_dt, report) && (shortest || !gainedEnergy(before, part, part_dt));
        if (accepted && observer_ != nullptr)
          showPart(before, part, at, part_dt);
        return accepted;
      },
      [this] { contacts_.invalidate(); });
  if (solved)
    return true;
  layers_->stop(state);
  strain_ = maxStrain(model_.rod, state);
  return false;
}

/** Upper bound of the work of streams in a step that was solved [J]. */
double KktStepper::streamWork(const State& state, double dt) const
{
  double work = 0.0;
  for (const NodalDrag& drag : last_input_.drags)
    if (const int i = drag.node; i >= state.first_node)
    {
      const Eigen::Vector3d travel = state.position[i] - begin_[i] + surfaceSlide(layers_->slides(), i);
      work += std::abs(drag.force(travel, dt).dot(travel));
    }
  return work;
}

/** Finds the turn of the wall about the wire's axis at every node, as the change of a twist angle that would follow it.
 *  Angles refer to Bishop frames, which turn by the motion, too. Where the layer model counts their turns, those of the
 *  wall are in space. @param state before it is carried */
void KktStepper::findWallTurns(const State& state)
{
  const int n = model_.rod.nodes();
  wall_turn_.assign(static_cast<std::size_t>(n), 0.0);
  turnsBy(model_.rod, model_.conditions.twistBoundary(state, 0.0), state, travel_.displacement, frame_turn_);
  for (int j = layers_->firstCountedTurn(); j < n - 1; ++j)
    frame_turn_[j] = 0.0;
  for (int i = state.first_node; i < n; ++i)
  {
    const int before = std::max(i - 1, state.first_node);
    const int after = std::min(i + 1, n - 1);
    const double length = model_.rod.position[after] - model_.rod.position[before];
    wall_turn_[i] = travel_.turn[i].dot(state.position[after] - state.position[before]) / length -
                    nodeAngle(frame_turn_, i, state.first_node);
  }
}

/** Upper bound of the work of a moving wall in a step that was solved [J]. */
double KktStepper::wallWork(const State& state) const
{
  double work = 0.0;
  for (int i = state.first_node; carried_ && i < model_.rod.nodes(); ++i)
    work += (1.0 + state.friction_coefficient[i]) * state.wall_force[i].norm() * travel_.displacement[i].norm();
  return work;
}

/** True where a step that was accepted at the limit of solves has more energy than at its beginning and the work of the
 *  handle, of streams and of the wall: a snap-through too violent for the step. */
bool KktStepper::gainedEnergy(const State& before, const State& state, double dt)
{
  if (!hit_iteration_limit_)
    return false;
  const double travel = state.inserted_length - before.inserted_length;
  double mass = 0.0;
  double kinetic = 0.0;
  double kinetic_before = 0.0;
  for (int i = state.first_node; i < model_.rod.nodes(); ++i)
  {
    mass += model_.rod.mass[i];
    kinetic += 0.5 * model_.rod.mass[i] * state.velocity[i].squaredNorm();
    kinetic_before += 0.5 * model_.rod.mass[i] * before.velocity[i].squaredNorm();
  }
  const double work = layers_->handleWork(before, state) + 0.5 * mass * (travel / dt) * (travel / dt) +
                      streamWork(state, dt) + wallWork(state);
  const Energy elastic_before = energy(before);
  const Energy elastic = energy(state);
  const double allowed = kEnergyGrowth * (kinetic_before + elastic_before.bending + elastic_before.twist) + work;
  return kinetic + elastic.bending + elastic.twist > allowed;
}

bool KktStepper::solveStep(State& state, const StepInput& input, double dt, StepReport& report)
{
  begin_ = state.position;
  {
    PhaseTimer::Scope scope(*timer_, Phase::kLayers);
    turned_ = layers_->advance(state, input, dt);
  }
  with_turns_ = false;
  placeEnds(state, input, dt);
  carry(state, input);
  {
    PhaseTimer::Scope scope(*timer_, Phase::kContact);
    contacts_.refresh(state, report);
    contacts_.settle(state);
  }
  if (!iterate(state, input, dt, report))
    return false;
  contacts_.releaseRetained();
  // The centreline has moved since the twist was relaxed.
  if (!turned_ && (layers_->isCurved() || model_.boundary.distal_twist_held))
    layers_->relaxTwist(state, input, friction_.lastAboutAxis(), *timer_);
  finish(state, dt);
  if (turned_)
    updateTorques(state, input);
  if (fading_)
    fading_ = fadeOffsets(state, dt);
  return true;
}

void KktStepper::placeEnds(State& state, const StepInput& input, double dt)
{
  const PlacedNodes placed = model_.conditions.placePrescribedNodes(state, input.inserted_length, dt);
  for (int i = placed.begin; i < placed.end; ++i)
    begin_[i] = state.position[i] - dt * state.velocity[i];  // new nodes have no earlier position
  model_.conditions.placeDistalEnd(state, input.distal, dt);
  state.rotation = input.rotation;
}

/** Moves the wall, and carries nodes and contacts with it. */
void KktStepper::carry(State& state, const StepInput& input)
{
  carried_ = input.wall != nullptr;
  if (!carried_)
    return;
  PhaseTimer::Scope scope(*timer_, Phase::kContact);
  input.wall->move(input.wall_from, input.wall_to, state.position, state.first_node, travel_);
  findWallTurns(state);
  for (int i = model_.conditions.firstFreeNode(state); i < model_.rod.nodes(); ++i)
  {
    if (!model_.conditions.isDistalHeld(i))
      state.position[i] += travel_.displacement[i];
    if (state.wall_force[i].isZero(0.0))
      continue;
    state.wall_force[i] += travel_.turn[i].cross(state.wall_force[i]);
    state.friction_stretch[i] += travel_.turn[i].cross(state.friction_stretch[i]);
  }
  contacts_.carry(state, *input.wall);
}

/** Solves a step until its strain and its contacts are within their tolerances. */
bool KktStepper::iterate(State& state, const StepInput& input, double dt, StepReport& report)
{
  hit_iteration_limit_ = false;
  bool moved = true;
  for (int k = 0; k < model_.settings.max_iterations; ++k)
  {
    collectFriction(state, dt, k == 0);
    relaxTwist(state, input, k == 0);
    {
      PhaseTimer::Scope scope(*timer_, Phase::kAssembly);
      contacts_.prepare(state, dt, wall());
      assemble(state, input, dt, k == 0, layers_->slides());
    }
    ++report.solves;
    if (!solve(state, dt, true, report))
      return false;
    const double factor = move(state, truncation(state, report), report);
    if (with_turns_)
      layers_->turnSurface(state, turn_solver_.turns(), factor);
    // After two solves without motion, the next solve would repeat this one.
    const bool last = k + 1 == model_.settings.max_iterations || (factor == 0.0 && !moved);
    moved = factor != 0.0;
    if (k > 0)
      contacts_.retainActiveContacts(state);
    if (factor == 1.0)
      accept(state, dt);
    if (contacts_.present() && contacts_.set().stale)
      return true;  // a stale contact set serves one solve per step
    strain_ = maxStrain(model_.rod, state);
    if (factor == 1.0 && strain_ <= model_.settings.strain_tolerance && !contacts_.foundUnknown(state))
      return true;
    hit_iteration_limit_ = last;
    report.hit_iteration_limit += last;
    if (last)
      return restoreLengths(state, input, dt, report) && !(maxStrain(model_.rod, state) > kLargestStrain);
  }
  return true;
}

/** Computes the twist of a solve. While a handle turns and the wall holds the surface, the positions and the turns of
 *  the surface are unknowns of one system: a wire that rolls moves sidewise as it turns, and computed in turn either
 *  motion would find the other one at rest. */
void KktStepper::relaxTwist(State& state, const StepInput& input, bool first_solve)
{
  const std::vector<TwistFriction>& friction = friction_.aboutAxis();
  with_turns_ = turned_ && (!friction.empty() || layers_->isCurved());
  if (!with_turns_)
  {
    twist_ = layers_->relaxTwist(state, input, friction, *timer_);
    return;
  }
  twist_ = layers_->predictTwist(state, input, friction, first_solve, *timer_);
  PhaseTimer::Scope scope(*timer_, Phase::kTwist);
  layers_->lineariseTwist(state, surface_twist_);
}

/** Updates the torques at the end of a step in which a handle turned. After a solve with turns, friction is that of the
 *  stretches at the end of the step. */
void KktStepper::updateTorques(State& state, const StepInput& input)
{
  PhaseTimer::Scope scope(*timer_, Phase::kForces);
  if (with_turns_)
  {
    const SurfaceMotion at_rest{model_.rod.radius, surface_angle_, surface_angle_};
    friction_.collect(state, state.position, nullptr, 1.0, false, &at_rest);
    friction_.aboutAxis();
  }
  layers_->updateTorques(state, input, friction_.lastAboutAxis(), *timer_);
}

void KktStepper::assemble(const State& state, const StepInput& input, double dt, bool first_solve,
                          const LayerSlides* slides)
{
  layers_->surfaceAngles(state, surface_angle_);
  const SurfaceMotion surface = surfaceMotion();
  if (with_turns_)
    friction_.lineariseWithTurns(surface);
  else
    friction_.linearise(&surface);
  assembly_.assemble({state, begin_, twist_, slides, input.forces, input.drags, dt, first_solve, wall()});
}

/** Computes the motion of a system.
 *  @param corrected also removes the strain that the motion would leave */
bool KktStepper::solve(const State& state, double dt, bool corrected, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kSolve);
  if (with_turns_)
  {
    if (!turn_solver_.solve(state, dt, contacts_, friction_, &surface_twist_, motion_, report))
      return false;
    if (corrected)
      turn_solver_.correctLengths(state, motion_);
    return true;
  }
  if (!solver_.solve(state, dt, contacts_, friction_, nullptr, motion_, report))
    return false;
  if (corrected)
    solver_.correctLengths(state, motion_);
  return true;
}

/** After a step that was accepted at the limit of solves (a snap-through that the trust region cut short): restores the
 *  lengths of the edges without advancing the motion, by solves over a small fraction of the step from rest. */
bool KktStepper::restoreLengths(State& state, const StepInput& input, double dt, StepReport& report)
{
  saved_begin_ = begin_;
  saved_velocity_ = state.velocity;
  bool solved = true;
  const bool with_turns = with_turns_;
  const bool carried = carried_;
  carried_ = false;  // the wall has moved already
  for (int k = 0; k < kMaxRestoringSolves && solved; ++k)
  {
    if (maxStrain(model_.rod, state) <= model_.settings.strain_tolerance)
      break;
    solved = restoreOnce(state, input, std::min(kRestoringFraction * dt, kRestoringTime), report);
  }
  with_turns_ = with_turns;
  carried_ = carried;
  begin_ = saved_begin_;
  state.velocity = saved_velocity_;
  strain_ = maxStrain(model_.rod, state);
  return solved;
}

bool KktStepper::restoreOnce(State& state, const StepInput& input, double dt, StepReport& report)
{
  begin_ = state.position;
  with_turns_ = false;
  std::fill(state.velocity.begin(), state.velocity.end(), Eigen::Vector3d::Zero());
  contacts_.prepare(state, dt);
  collectFriction(state, dt, true);
  assemble(state, input, dt, true, nullptr);
  ++report.solves;
  if (!solve(state, dt, false, report))
    return false;
  move(state, truncation(state, report), report);
  return true;
}

double KktStepper::truncation(const State& state, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kContact);
  double factor = turnTruncation(model_.rod, state, motion_, model_.settings.max_rotation);
  factor = contacts_.truncation(state, motion_, factor, report);
  report.truncations += factor < 1.0;
  return factor;
}

/** Moves the wire by a share of the solution and detects the contacts there. A motion that would put the wire deeper
 *  into a rigid wall than before, and deeper than tolerated, is halved: from a state inside, whatever the solution is,
 *  only states inside are reached.
 *  @return the remaining share */
double KktStepper::move(State& state, double factor, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kContact);
  const int n = model_.rod.nodes();
  for (int i = state.first_node; i < n; ++i)
    state.position[i] += factor * motion_[i];
  if (!contacts_.present())
    return factor;
  contacts_.noteDepths();
  double moved = factor;
  contacts_.detect(state, report);
  for (int halving = 0; !contacts_.set().stale && contacts_.isDeeper() && moved > 0.0; ++halving)
  {
    const double shorter = halving < kMaxDepthHalvings ? 0.5 * moved : 0.0;
    for (int i = state.first_node; i < n; ++i)
      state.position[i] -= (moved - shorter) * motion_[i];
    moved = shorter;
    contacts_.detectAgain(state, report);
  }
  report.truncations += moved < factor;
  return moved;
}

/** Lagged forces are taken from accepted solutions only: a truncated one is not an equilibrium. */
void KktStepper::accept(State& state, double dt)
{
  PhaseTimer::Scope scope(*timer_, Phase::kForces);
  contacts_.updateWallForces(state, motion_);
  if (observer_ != nullptr)
    noteForces(dt);
  reactions_.update({model_, system_, solution(), motion_, begin_, assembly_.resistance(),
                     assembly_.configurationalForce(), layers_->restForce(state) + assembly_.guideRestForce(state),
                     layers_->slides(), friction_, last_input_.forces, last_input_.drags, dt, wall()},
                    state);
}

void KktStepper::finish(State& state, double dt)
{
  PhaseTimer::Scope scope(*timer_, Phase::kFriction);
  layers_->initialSurfaceAngles(state, surface_begin_);
  layers_->surfaceAngles(state, surface_angle_);
  const SurfaceMotion surface = surfaceMotion();
  friction_.finish(state, begin_, &surface);
  const double inverse = 1.0 / dt;
  for (int i = model_.conditions.firstFreeNode(state); i < model_.rod.nodes(); ++i)
    if (!model_.conditions.isDistalHeld(i))
      state.velocity[i] = inverse * (state.position[i] - begin_[i]);
  PhaseTimer::Scope layers(*timer_, Phase::kLayers);
  layers_->finish(state, dt);
}

void KktStepper::collectFriction(const State& state, double dt, bool first_solve)
{
  PhaseTimer::Scope scope(*timer_, Phase::kFriction);
  layers_->initialSurfaceAngles(state, surface_begin_);
  const SurfaceMotion surface = surfaceMotion();
  friction_.collect(state, begin_, &model_.rod.mass, dt, first_solve, &surface);
}

SurfaceMotion KktStepper::surfaceMotion() const
{
  const LayerSlides* slides = layers_->slides();
  return {model_.rod.radius, surface_begin_, surface_angle_, slides != nullptr ? &slides->surface : nullptr, wall(),
          wallTurn()};
}

void KktStepper::setContactRadii(const std::vector<double>& radii)
{
  contacts_.setRadii(radii);
  if (observer_ != nullptr)
    observer_->setContactRadii(radii);
}

bool KktStepper::resample(const Discretisation& rod)
{
  contacts_.resample(rod);
  fading_ = true;
  model_.rod = rod;
  layers_->resample();
  return true;
}

/** Stores the resisting forces of an accepted solution for the observer. */
void KktStepper::noteForces(double dt)
{
  resisting_.reset(motion_.size());
  for (std::size_t k = 0; k < friction_.count(); ++k)
  {
    const WallFriction::Term& term = friction_.term(k);
    resisting_.friction[term.node] = term.pullAfter(motion_[term.node]);
  }
  for (int i = system_.first; i < model_.rod.nodes(); ++i)
  {
    resisting_.damping[i] = model_.rod.mass[i] * model_.environment.damping / dt;
    resisting_.drag[i] = assembly_.resistance().coefficient[i] / (dt * dt) - resisting_.damping[i];
  }
  spring_energy_ = contacts_.springEnergy();
}

void KktStepper::showPart(const State& before, const State& after, const StepInput& input, double dt)
{
  std::vector<NodeSlide> slides;
  for (std::size_t i = 0; layers_->slides() != nullptr && i < after.position.size(); ++i)
  {
    const MassSlide& mass = layers_->slides()->mass[i];
    slides.push_back({layers_->slides()->surface[i], mass.travel, mass.gained});
  }
  if (resisting_.friction.size() != after.position.size())
    resisting_.reset(after.position.size());
  layers_->surfaceAngles(after, surface_angle_);
  const LayerFrictionWork layers = layers_->frictionWork(before, after);
  const PotentialFunction potential = [this](const State& state, int from) { return potentialEnergy(state, from); };
  observer_->addPart({before,
                      after,
                      begin_,
                      input,
                      dt,
                      model_.rod,
                      model_.boundary,
                      model_.conditions,
                      potential,
                      resisting_,
                      slides,
                      friction_.lastAboutAxis(),
                      surface_begin_,
                      surface_angle_,
                      layers_->frameTurns(after),
                      spring_energy_,
                      layers.push,
                      layers.turn,
                      layers_->insertionWork(before, after) +
                          assembly_.guideRestForce(after) * (after.inserted_length - before.inserted_length),
                      wall(),
                      wallTurn()});
  layers_->restore(after);
}

/** Potential energies of a state at its present angles. @param from first node whose weight counts */
PotentialEnergy KktStepper::potentialEnergy(const State& state, int from)
{
  PotentialEnergy energy;
  layers_->addElasticEnergy(state, energy);
  energy.guide = assembly_.introducerEnergy(state);
  for (int i = from; i < model_.rod.nodes(); ++i)
    energy.gravity -= model_.immersedMass(i) * model_.environment.gravity.dot(state.position[i]);
  return energy;
}

/** All other members are recomputed in every step. */
void KktStepper::archive(Archive& archive, const State& state)
{
  archive(contacts_, fading_, strain_);
  if (archive.reading())
    layers_->restore(state);
}

}  // namespace endovascular_sim::rod
