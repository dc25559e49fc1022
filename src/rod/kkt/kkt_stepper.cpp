#include "rod/kkt/kkt_stepper.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "rod/boundary/boundary_conditions.h"
#include "rod/sampling/resampling.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr int kIdleRow = 3;  // after the first node's, where a multiplier would stand
constexpr double kEnergyGrowth = 1.1;
constexpr int kMaxRestoringSolves = 4;
constexpr double kRestoringFraction = 0.03;  // of the time step, and at most
constexpr double kRestoringTime = 30e-6;     // s: elastic forces move next to nothing in it
constexpr double kLargestMotion = 1e3;       // m: beyond it a solution counts as failed
constexpr double kLargestStrain = 1e-2;      // that a step may leave, e.g. of a straight wire that is shortened
constexpr double kLargestTension = 1e9;      // the same, in units of the multiplier

}  // namespace

KktStepper::KktStepper(Discretisation rod, Boundary boundary, Environment environment, StepperSettings settings)
  : rod_(std::move(rod)), boundary_(std::move(boundary)), environment_(std::move(environment)), settings_(settings)
{
  scale_ = rod_.mass[static_cast<std::size_t>(rod_.nodes() / 2)];
}

State KktStepper::initialState(double inserted_length, double rotation) const
{
  return conditions_.initialState(inserted_length, rotation);
}

void KktStepper::placePrescribedNodes(State& state, double inserted_length, double dt)
{
  const PlacedNodes placed = conditions_.placePrescribedNodes(state, inserted_length, dt);
  for (int i = placed.begin; i < placed.end; ++i)
    begin_[i] = state.position[i] - dt * state.velocity[i];  // a node that was not simulated yet has no other
  for (int i = placed.begin; i < placed.born; ++i)
    begin_twist_[i] = state.rotation;
  first_ = state.first_node;
}

KktStepper::TwistAction KktStepper::relaxTwist(State& state, const StepInput& input,
                                               const std::vector<TwistFriction>& friction)
{
  TwistBoundary boundary = conditions_.twistBoundary(state, input);
  boundary.friction = &friction;
  if (!QuasiStaticTwist::matters(rod_, boundary))
  {
    std::fill(state.twist_angle.begin() + state.first_node, state.twist_angle.end(), state.rotation);
    state.hand_torque = state.distal_torque = 0.0;
    return {};
  }
  PhaseTimer::Scope scope(*timer_, Phase::kTwist);
  twist_.solve(rod_, boundary, state);
  return {true, twist_.firstCurved(), twist_.restCurvatureBinormals().data(), twist_.torques().data()};
}

bool KktStepper::run(State& state, const StepInput& input, double dt, StepReport& report)
{
  return advance(state, input, dt, report);
}

void KktStepper::refreshRod(State& /*state*/, const StepInput& /*input*/, double /*dt*/) {}

void KktStepper::complete(State& /*state*/, double /*dt*/) {}

/** Twist was relaxed with the hand turned on already and the centreline not yet: while a hand turns, that torque is too
 *  large by the bent tip's stiffness times the turn of a step. */
void KktStepper::renewTorques(State& state, const StepInput& input)
{
  kept_twist_ = state.twist_angle;
  relaxTwist(state, input, friction_.lastAboutAxis());
  state.twist_angle.swap(kept_twist_);
}

void KktStepper::surfaceAngles(const State& state, std::vector<double>& angle) const
{
  angle.resize(state.position.size());
  for (int i = state.first_node; i < rod_.nodes(); ++i)
    angle[i] = nodeAngle(state.twist_angle, i, state.first_node);
}

void KktStepper::surfaceBeginAngles(const State& state, std::vector<double>& angle) const
{
  angle.resize(state.position.size());
  for (int i = state.first_node; i < rod_.nodes(); ++i)
    angle[i] = nodeAngle(begin_twist_, i, state.first_node);
}

double KktStepper::handWork(const State& before, const State& after) const
{
  return std::abs(after.hand_force * (after.inserted_length - before.inserted_length)) +
         std::abs(after.hand_torque * (after.rotation - before.rotation));
}

StepReport KktStepper::step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                            contact::ContactSource* contacts, PhaseTimer& timer)
{
  contacts_.beginStep(input, contacts, pass, timer);
  timer_ = &timer;
  motion_.resize(state.position.size());
  last_input_ = input;
  StepReport report;
  if (!run(state, input, dt, report))
    report.solved = false;
  report.max_strain = strain_;
  return report;
}

bool KktStepper::advance(State& state, const StepInput& input, double dt, StepReport& report)
{
  const bool solved = bisection_.advance(
      state, input, dt, report,
      [this, &report](State& part, const State& before, const StepInput& at, double part_dt, bool shortest)
      { return solveStep(part, at, part_dt, report) && (shortest || !gainedEnergy(before, part, part_dt)); },
      [this] { contacts_.invalidate(); });
  if (!solved)
    strain_ = maxStrain(rod_, state);
  return solved;
}

/** Whether a step that was accepted unfinished has more energy than it began with and the hand gave: a snap that was
 *  too violent for the step. */
bool KktStepper::gainedEnergy(const State& before, const State& state, double dt)
{
  if (!hit_iteration_limit_)
    return false;
  const double travel = state.inserted_length - before.inserted_length;
  double mass = 0.0;
  double kinetic = 0.0;
  double kinetic_before = 0.0;
  for (int i = first_; i < rod_.nodes(); ++i)
  {
    mass += rod_.mass[i];
    kinetic += 0.5 * rod_.mass[i] * state.velocity[i].squaredNorm();
    kinetic_before += 0.5 * rod_.mass[i] * before.velocity[i].squaredNorm();
  }
  const double given = handWork(before, state) + 0.5 * mass * (travel / dt) * (travel / dt);
  PhaseTimer* const timer = timer_;
  const Energy elastic_before = energy(before);
  const Energy elastic = energy(state);
  timer_ = timer;
  const double allowed = kEnergyGrowth * (kinetic_before + elastic_before.bending + elastic_before.twist) + given;
  return kinetic + elastic.bending + elastic.twist > allowed;
}

bool KktStepper::solveStep(State& state, const StepInput& input, double dt, StepReport& report)
{
  begin_ = state.position;
  begin_twist_ = state.twist_angle;
  const bool turned = turns(state, input);
  refreshRod(state, input, dt);
  placePrescribedNodes(state, input.inserted_length, dt);
  conditions_.placeDistalEnd(state, input.distal, dt);
  state.rotation = input.rotation;
  contacts_.refresh(state, report);
  contacts_.settle(state);
  hit_iteration_limit_ = false;
  bool moved = true;
  for (int solve = 0; solve < settings_.max_iterations; ++solve)
  {
    collectFriction(state, dt, solve == 0);
    action_ = relaxTwist(state, input, friction_.aboutAxis());
    {
      PhaseTimer::Scope scope(*timer_, Phase::kAssembly);
      contacts_.prepare(state, dt);
      assemble(state, input, dt, solve == 0);
    }
    ++report.solves;
    if (!solveActiveSet(state, dt, report))
      return false;
    correctLengths(state);
    const double factor = move(state, truncation(state, report), report);
    // Where nothing could move twice the next solve would be the same again.
    const bool last = solve + 1 == settings_.max_iterations || (factor == 0.0 && !moved);
    moved = factor != 0.0;
    if (solve > 0)
      contacts_.retainActiveContacts(state);
    if (factor == 1.0)
      accept(state, dt);
    if (contacts_.present() && contacts_.set().stale)
      break;  // one solve per step is all that old contacts are good for
    strain_ = maxStrain(rod_, state);
    if (factor == 1.0 && strain_ <= settings_.strain_tolerance && !contacts_.foundUnknown(state))
      break;
    hit_iteration_limit_ = last;
    report.hit_iteration_limit += last;
    if (last && (!restoreLengths(state, input, dt, report) || maxStrain(rod_, state) > kLargestStrain))
      return false;
    if (last)
      break;
  }
  contacts_.releaseRetained();
  finish(state, dt);
  if (turned)
    renewTorques(state, input);
  if (fading_)
    fading_ = fadeOffsets(state, dt);
  return true;
}

/** After a step that was accepted unfinished (a snap that the trust region cut short): brings the edges back to their
 *  lengths without moving on, by solves over a small fraction of the step from rest. */
bool KktStepper::restoreLengths(State& state, const StepInput& input, double dt, StepReport& report)
{
  restore_begin_ = begin_;
  restore_velocity_ = state.velocity;
  bool solved = true;
  restoring_ = true;
  for (int solve = 0; solve < kMaxRestoringSolves && solved; ++solve)
  {
    if (maxStrain(rod_, state) <= settings_.strain_tolerance)
      break;
    begin_ = state.position;
    std::fill(state.velocity.begin(), state.velocity.end(), Eigen::Vector3d::Zero());
    const double fraction = std::min(kRestoringFraction * dt, kRestoringTime);
    contacts_.prepare(state, fraction);
    collectFriction(state, fraction, true);
    assemble(state, input, fraction, true);
    ++report.solves;
    solved = solveActiveSet(state, fraction, report);
    if (!solved)
      break;
    move(state, truncation(state, report), report);
  }
  restoring_ = false;
  begin_ = restore_begin_;
  state.velocity = restore_velocity_;
  strain_ = maxStrain(rod_, state);
  return solved;
}

void KktStepper::finish(State& state, double dt)
{
  surfaceAngles(state, surface_angle_);
  const SurfaceMotion surface = surfaceMotion();
  friction_.finish(state, begin_, &surface);
  const double inverse = 1.0 / dt;
  for (int i = conditions_.firstFreeNode(state); i < rod_.nodes(); ++i)
    if (!conditions_.isDistalHeld(i))
      state.velocity[i] = inverse * (state.position[i] - begin_[i]);
  complete(state, dt);
}

void KktStepper::collectFriction(const State& state, double dt, bool first_solve)
{
  surfaceBeginAngles(state, surface_begin_);
  const SurfaceMotion surface = surfaceMotion();
  friction_.collect(state, begin_, &rod_.mass, dt, first_solve, &surface);
}

SurfaceMotion KktStepper::surfaceMotion() const
{
  return {rod_.radius, surface_begin_, surface_angle_, surfaceSlide()};
}

void KktStepper::prescribeNodes(const State& state)
{
  for (int i = first_; i < rod_.nodes(); ++i)
  {
    if (!conditions_.isPrescribed(i, state))
    {
      if (boundary_.introducer && boundary_.distal == EndHold::kFree)
        break;
      continue;
    }
    const bool next_too = i + 1 < rod_.nodes() && conditions_.isPrescribed(i + 1, state);
    if (fresh_ > 0)  // the matrix knows already
      std::fill_n(rhs_.begin() + row(i), next_too ? 8 : 3, 0.0);
    else
    {
      for (int axis = 0; axis < 3; ++axis)
        matrix_.prescribe(row(i) + axis, 0.0, scale_, rhs_);
      if (next_too)
        matrix_.prescribe(multiplierRow(i), 0.0, -scale_, rhs_);
    }
  }
}

bool KktStepper::factoriseAndSolve(const State& state, StepReport& report)
{
  prescribeNodes(state);
  ++report.factorisations;
  if (settings_.linear_solver == LinearSolver::kSparse)
  {
    if (!klu_.factorise(sparseFromBand(matrix_)))
      return false;
  }
  else if (matrix_.factorise() != rod_.nodes() - first_)
    return false;
  solveAgain(rhs_);
  // Tensions may be huge for one solve, where a straight wire is shortened; motions may not.
  for (std::size_t k = 0; k < rhs_.size(); ++k)
  {
    const bool multiplier = k % 4 == kIdleRow;
    if (!(std::abs(rhs_[k]) < (multiplier ? kLargestTension : kLargestMotion)))
      return false;
  }
  return true;
}

/** With the factors that are there. */
void KktStepper::solveAgain(std::vector<double>& rhs)
{
  if (settings_.linear_solver == LinearSolver::kSparse)
    klu_.solve(rhs.data());
  else
    matrix_.solve(rhs);
}

Energy KktStepper::energy(const State& state)
{
  State relaxed = state;
  PhaseTimer unused;
  timer_ = &unused;
  action_ = relaxTwist(relaxed, last_input_, frictionAtRest(state));
  return elasticEnergy(rod_, state, action_.active ? &twist_ : nullptr);
}

const std::vector<TwistFriction>& KktStepper::frictionAtRest(const State& state)
{
  surfaceAngles(state, surface_begin_);
  const SurfaceMotion at_rest{rod_.radius, surface_begin_, surface_begin_};
  friction_.collect(state, state.position, nullptr, 1.0, false, &at_rest);
  return friction_.aboutAxis();
}

std::vector<Eigen::Vector3d> KktStepper::elasticGradient(State state, const StepInput& input)
{
  PhaseTimer unused;
  timer_ = &unused;
  first_ = state.first_node;
  last_input_ = input;
  refreshRod(state, input, 1.0);
  action_ = relaxTwist(state, input, {});
  base_.reset(4 * (rod_.nodes() - first_));
  base_rhs_.assign(static_cast<std::size_t>(base_.size()), 0.0);
  addAllBending(state, 1.0);
  std::vector<Eigen::Vector3d> gradient(state.position.size(), Eigen::Vector3d::Zero());
  for (int i = first_; i < rod_.nodes(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      gradient[i][axis] = -base_rhs_[row(i) + axis];
  return gradient;
}

}  // namespace endovascular_sim::rod
