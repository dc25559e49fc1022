#include <algorithm>
#include <cmath>

#include "rod/boundary/reaction_forces.h"
#include "rod/mixed/mixed_stepper.h"

// Solution of an assembled system of the `mixed` scheme: contact springs and friction, inertia of the matrix, trust
// region.

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr int kMaxActiveSetPasses = 8;
constexpr double kFirstShift = 1.0;  // of the inertia, when a factorisation is not that of a minimum
constexpr double kShiftGrowth = 30.0;
constexpr double kMostShift = 1e6;
constexpr double kLargestMotion = 1e3;  // m: beyond it a solution counts as failed
constexpr int kMaxRestoringSolves = 4;
constexpr double kRestoringFraction = 0.03;  // of the time step: elastic forces cause negligible motion in it

}  // namespace

void MixedStepper::addFriction(const State& state, const WallFriction::Term& term)
{
  const int r = model_.positionRow(state, term.node);
  for (int col = 0; col < 3; ++col)
  {
    rhs_[r + col] -= term.pull[col];
    for (int row = col; row < 3; ++row)
      matrix_.at(r + row, r + col) += term.stiffness(row, col);
  }
}

void MixedStepper::addSpring(const State& state, std::size_t index)
{
  const ContactSolver::Spring& spring = contacts_.spring(index);
  const contact::Feature& feature = contacts_.feature(index);
  const Vector3d& normal = feature.normal;
  const double push = -spring.stiffness * feature.gap;
  const int r0 = model_.positionRow(state, spring.node);
  const int r1 = spring.weight1 > 0.0 ? model_.positionRow(state, spring.node + 1) : r0;
  for (int col = 0; col < 3; ++col)
  {
    const double pull = spring.stiffness * normal[col];
    rhs_[r0 + col] += spring.weight0 * push * normal[col];
    for (int row = col; row < 3; ++row)
      matrix_.at(r0 + row, r0 + col) += spring.weight0 * spring.weight0 * pull * normal[row];
    if (spring.weight1 <= 0.0)
      continue;
    rhs_[r1 + col] += spring.weight1 * push * normal[col];
    for (int row = col; row < 3; ++row)
      matrix_.at(r1 + row, r1 + col) += spring.weight1 * spring.weight1 * pull * normal[row];
    for (int row = 0; row < 3; ++row)
      matrix_.at(r1 + row, r0 + col) += spring.weight0 * spring.weight1 * pull * normal[row];
  }
}

/** Solves until no spring opens or closes. A matrix without the inertia of a minimum gets more mass, which shortens the
 *  motion.
 *  @param shifted set when that happened: the step needs another solve */
bool MixedStepper::solveActiveSet(const State& state, double dt, StepReport& report, bool& shifted)
{
  PhaseTimer::Scope scope(*timer_, Phase::kSolve);
  double shift = 0.0;
  for (int pass = 0; pass < kMaxActiveSetPasses;)
  {
    if (!factoriseAndSolve(state, shift / (dt * dt), report))
    {
      shifted = true;
      shift = std::max(kFirstShift, kShiftGrowth * shift);
      if (shift > kMostShift)
        return false;
      continue;
    }
    for (int i = state.first_node; i < rod_.nodes(); ++i)
      motion_[i] = increment(model_.positionRow(state, i));
    const bool contacts_changed = contacts_.updateActiveSet(motion_, pass, false);
    const bool friction_changed = friction_.update(motion_, pass);
    if (!contacts_changed && !friction_changed)
      return true;
    ++pass;
  }
  return true;
}

bool MixedStepper::factoriseAndSolve(const State& state, double shift, StepReport& report)
{
  matrix_.copyFrom(base_);
  rhs_ = gradient_;
  for (double& value : rhs_)
    value = -value;
  for (std::size_t c = 0; c < contacts_.count(); ++c)
    if (contacts_.spring(c).active)
      addSpring(state, c);
  for (std::size_t k = 0; k < friction_.count(); ++k)
    addFriction(state, friction_.term(k));
  for (int i = state.first_node; shift > 0.0 && i < rod_.nodes(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      matrix_.at(model_.positionRow(state, i) + axis, model_.positionRow(state, i) + axis) += shift * rod_.mass[i];
  model_.prescribeEnds(state, matrix_, rhs_);
  for (int i = state.first_node; boundary_.introducer && i < rod_.nodes() && conditions().isPrescribed(i, state); ++i)
  {
    model_.prescribe(model_.positionRow(state, i), 1.0, matrix_, rhs_);
    if (i > state.first_node)
      matrix_.prescribe(model_.tensionRow(state, i - 1), 0.0, -1.0, rhs_);
  }
  ++report.factorisations;
  if (matrix_.factorise() != model_.negativePivots(state))
    return false;
  matrix_.solve(rhs_);
  return std::all_of(rhs_.begin(), rhs_.end(), [](double value) { return std::abs(value) < kLargestMotion; });
}

/** After a step that was accepted at the limit of solves (a snap-through that the trust region cut short): restores the
 *  lengths of the edges without advancing the motion, by solves over a small fraction of the step from rest. */
bool MixedStepper::restoreLengths(State& state, const StepInput& input, double dt, StepReport& report)
{
  restore_begin_ = begin_;
  restore_velocity_ = state.velocity;
  const double fraction = kRestoringFraction * dt;
  bool solved = true;
  for (int solve = 0; solve < kMaxRestoringSolves && solved; ++solve)
  {
    if (largestStrain(state) <= settings_.strain_tolerance)
      break;
    begin_ = state.position;
    std::fill(state.velocity.begin(), state.velocity.end(), Vector3d::Zero());
    relaxTwist(state, input.tip_torque);
    contacts_.prepare(state, fraction);
    assemble(state, input, fraction, true);
    ++report.solves;
    bool shifted = false;
    solved = solveActiveSet(state, fraction, report, shifted);
    if (!solved)
      break;
    const double factor = truncation(state, report);
    for (int i = state.first_node; i < rod_.nodes(); ++i)
    {
      state.position[i] += factor * motion_[i];
      state.moment[i] += factor * increment(model_.momentRow(state, i));
    }
    if (contacts_.present())
      contacts_.detect(state, report);
  }
  begin_ = restore_begin_;
  state.velocity = restore_velocity_;
  return solved;
}

double MixedStepper::truncation(const State& state, StepReport& report)
{
  double largest_turn = 0.0;
  for (int j = state.first_node; j + 1 < rod_.nodes(); ++j)
    largest_turn = std::max(largest_turn, (motion_[j + 1] - motion_[j]).norm() / rod_.rest_length[j]);
  double factor = largest_turn > settings_.max_rotation ? settings_.max_rotation / largest_turn : 1.0;
  factor = contacts_.truncation(state, motion_, factor, report);
  report.truncations += factor < 1.0;
  return factor;
}

void MixedStepper::accept(State& state, double factor)
{
  for (int i = state.first_node; i < rod_.nodes(); ++i)
  {
    state.position[i] += factor * motion_[i];
    state.moment[i] += factor * increment(model_.momentRow(state, i));
  }
  for (int j = state.first_node; j + 1 < rod_.nodes(); ++j)
    state.tension[j] += factor * rhs_[model_.tensionRow(state, j)];
  // Lagged forces are taken from accepted solutions only: a truncated one is not an equilibrium.
  if (factor < 1.0)
    return;
  contacts_.updateWallForces(state, motion_);
  updateEndForces(
      state, boundary_, [this, &state](int node) { return conditions().isPrescribed(node, state); },
      [this, &state](int node)
      {
        const int row = model_.positionRow(state, node);
        return remainder(base_, -Vector3d(gradient_.data() + row), rhs_, row);
      });
}

}  // namespace endovascular_sim::rod
