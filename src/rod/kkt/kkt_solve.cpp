#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "rod/kkt/kkt_stepper.h"

// The part of the scheme that solves an assembled system: contact springs with their active set, trust region.

namespace endovascular_sim::rod
{
namespace
{

constexpr int kMaxActiveSetPasses = 16;
constexpr double kQuietTurn = 0.01;  // rad of an edge in one solve: less cannot fold anything
constexpr double kSharpTurn = 0.6;   // 1 + cos of a turning angle (114°) below which folding is watched for
constexpr int kMaxFoldHalvings = 10;
constexpr int kMaxDepthHalvings = 6;
constexpr double kShift = 10.0;  // of the mass matrix, when a factorisation has the wrong inertia

}  // namespace

bool KktStepper::solveActiveSet(const State& state, double dt, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kSolve);
  double shift = 0.0;
  bool same_rest = false;
  int changed = first_;  // the first node whose terms are not those of the last pass
  for (int active_pass = 0; active_pass < kMaxActiveSetPasses; ++active_pass)
  {
    fresh_ = matrix_.rewind(base_, shift > 0.0 || !canRewind(state) ? 0 : row(changed));
    rhs_ = base_rhs_;
    for (std::size_t c = 0; c < contacts_.count(); ++c)
      if (contacts_.spring(c).active)
        addContact(contacts_.feature(c), contacts_.spring(c), dt);
    for (std::size_t k = 0; k < friction_.count(); ++k)
      addFriction(friction_.term(k), dt);
    for (int i = first_; shift > 0.0 && i < rod_.nodes(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        matrix_.at(row(i) + axis, row(i) + axis) += shift * rod_.mass[i];
    if (!factoriseAndSolve(state, report))
    {
      if (shift > 0.0)
        return false;
      shift = kShift;
      same_rest = false;
      changed = first_;
      continue;
    }
    for (int i = first_; i < rod_.nodes(); ++i)
      motion_[i] = increment(i);
    const bool contacts_changed = contacts_.updateActiveSet(motion_, active_pass, same_rest);
    const bool friction_changed = friction_.update(motion_, active_pass);
    if (!contacts_changed && !friction_changed)
      return true;
    same_rest = !friction_changed;
    changed = std::min(contacts_changed ? contacts_.firstChanged() : rod_.nodes(),
                       friction_changed ? friction_.firstChanged() : rod_.nodes());
  }
  return true;
}

/** A motion stretches the edges by the square of what they turn by. Where that is little it is taken out by another
 * right-hand side instead of another solve (second-order correction: Nocedal & Wright 2006, §18.3); the correction is
 * another order smaller. */
void KktStepper::correctLengths(const State& state)
{
  if (settings_.corrected_strain <= settings_.strain_tolerance)
    return;
  PhaseTimer::Scope scope(*timer_, Phase::kSolve);
  correction_.assign(rhs_.size(), 0.0);
  const int free = conditions_.firstFreeNode(state);
  double largest = 0.0;
  for (int j = std::max(first_, free - 1); j + 1 < rod_.nodes(); ++j)
  {
    if (conditions_.isDistalHeld(j))
      continue;
    const Eigen::Vector3d edge = state.position[j + 1] + motion_[j + 1] - state.position[j] - motion_[j];
    const double stretch = edge.norm() - rod_.rest_length[j];
    correction_[multiplierRow(j)] = -scale_ * stretch;
    largest = std::max(largest, std::abs(stretch) / rod_.rest_length[j]);
  }
  if (largest <= settings_.strain_tolerance || !(largest <= settings_.corrected_strain))
    return;
  solveAgain(correction_);
  for (std::size_t k = 0; k < rhs_.size(); ++k)
    rhs_[k] += correction_[k];
  for (int i = first_; i < rod_.nodes(); ++i)
    motion_[i] = increment(i);
}

/** Whether a factorisation may go on from where it stands: only where the prescribed nodes are done with by then. */
bool KktStepper::canRewind(const State& state) const
{
  if (settings_.linear_solver == LinearSolver::kSparse || !boundary_.introducer || boundary_.distal != EndHold::kFree)
    return false;
  return row(conditions_.firstFreeNode(state)) + kBandwidth <= Matrix::kMarkEvery;
}

void KktStepper::addContact(const contact::Feature& feature, const ContactSolver::Spring& contact, double dt)
{
  const double stiffness = dt * dt * contact.stiffness;
  const double push = -stiffness * contact.gap;
  const int r0 = row(contact.node);
  const int r1 = contact.weight1 > 0.0 ? row(contact.node + 1) : r0;
  for (int col = 0; col < 3; ++col)
  {
    rhs_[r0 + col] += contact.weight0 * push * feature.normal[col];
    for (int line = col; line < 3 && r0 >= fresh_; ++line)
      matrix_.at(r0 + line, r0 + col) +=
          stiffness * contact.weight0 * contact.weight0 * feature.normal[line] * feature.normal[col];
    if (contact.weight1 <= 0.0)
      continue;
    rhs_[r1 + col] += contact.weight1 * push * feature.normal[col];
    for (int line = col; line < 3 && r1 >= fresh_; ++line)
      matrix_.at(r1 + line, r1 + col) +=
          stiffness * contact.weight1 * contact.weight1 * feature.normal[line] * feature.normal[col];
    for (int line = 0; line < 3 && r0 >= fresh_; ++line)
      matrix_.at(r1 + line, r0 + col) +=
          stiffness * contact.weight0 * contact.weight1 * feature.normal[line] * feature.normal[col];
  }
}

void KktStepper::addFriction(const WallFriction::Term& term, double dt)
{
  const int r = row(term.node);
  for (int col = 0; col < 3; ++col)
  {
    rhs_[r + col] -= dt * dt * term.pull[col];
    for (int line = col; line < 3 && r >= fresh_; ++line)
      matrix_.at(r + line, r + col) += dt * dt * term.stiffness(line, col);
  }
}

double KktStepper::truncation(const State& state, StepReport& report)
{
  double factor = 1.0;
  double largest_turn = 0.0;  // squared, until all are seen
  for (int j = first_; j + 1 < rod_.nodes(); ++j)
  {
    // Along the edge the solve restores what the hand's motion took from a short one: no rotation.
    const Eigen::Vector3d edge = state.position[j + 1] - state.position[j];
    const Eigen::Vector3d change = motion_[j + 1] - motion_[j];
    const double along = change.dot(edge);
    const double across = std::max(0.0, change.squaredNorm() - along * along / edge.squaredNorm());
    largest_turn = std::max(largest_turn, across / (rod_.rest_length[j] * rod_.rest_length[j]));
  }
  largest_turn = std::sqrt(largest_turn);
  if (largest_turn > settings_.max_rotation)
    factor = settings_.max_rotation / largest_turn;
  if (largest_turn > kQuietTurn)
    factor = foldTruncation(state, factor);
  factor = contacts_.truncation(state, motion_, factor, report);
  report.truncations += factor < 1.0;
  return factor;
}

/** No two neighbouring edges may come closer to folding back onto each other than by half of what is left: the bending
 *  energy is infinite there, and beyond it the curvature binormal has changed its side. */
double KktStepper::foldTruncation(const State& state, double factor) const
{
  for (int halving = 0; halving < kMaxFoldHalvings; ++halving)
  {
    bool folds = false;
    for (int i = first_ + 1; i + 1 < rod_.nodes() && !folds; ++i)
    {
      const Eigen::Vector3d e = state.position[i] - state.position[i - 1];
      const Eigen::Vector3d g = state.position[i + 1] - state.position[i];
      const Eigen::Vector3d new_e = e + factor * (motion_[i] - motion_[i - 1]);
      const Eigen::Vector3d new_g = g + factor * (motion_[i + 1] - motion_[i]);
      // 1 + cos of the turning angle: 2 for a straight wire, 0 for a fold.
      const double now = 1.0 + e.dot(g) / std::sqrt(e.squaredNorm() * g.squaredNorm());
      const double then = 1.0 + new_e.dot(new_g) / std::sqrt(new_e.squaredNorm() * new_g.squaredNorm());
      folds = then < kSharpTurn && then < 0.5 * now;
    }
    if (!folds)
      break;
    factor *= 0.5;
  }
  return factor;
}

/** Moves the wire by a share of the solution and finds the contacts there. A motion that would put the wire deeper into
 *  a rigid wall than it is, and deeper than is tolerated, is halved until it does not: from a state inside, whatever
 *  the solution is, only states inside are reached.
 *  @return the share that was left */
double KktStepper::move(State& state, double factor, StepReport& report)
{
  for (int i = first_; i < rod_.nodes(); ++i)
    state.position[i] += factor * motion_[i];
  if (!contacts_.present())
    return factor;
  contacts_.noteDepths();
  double moved = factor;
  contacts_.detect(state, report);
  for (int halving = 0; !contacts_.set().stale && contacts_.isDeeper() && moved > 0.0; ++halving)
  {
    const double shorter = halving < kMaxDepthHalvings ? 0.5 * moved : 0.0;
    for (int i = first_; i < rod_.nodes(); ++i)
      state.position[i] -= (moved - shorter) * motion_[i];
    moved = shorter;
    contacts_.detectAgain(state, report);
  }
  report.truncations += moved < factor;
  return moved;
}

/** Lagged forces follow accepted solutions only: a truncated one is not an equilibrium. */
void KktStepper::accept(State& state, double dt)
{
  const double to_force = scale_ / (dt * dt);
  for (int j = first_; j + 1 < rod_.nodes(); ++j)
    state.tension[j] = to_force * rhs_[multiplierRow(j)];
  contacts_.updateWallForces(state, motion_);
  updateEndForces(state, dt);
  updateHandParts(state, dt);
}

bool KktStepper::resample(const Discretisation& rod)
{
  contacts_.resample(rod);
  fading_ = true;
  rod_ = rod;
  return true;
}

/** All else is made anew in every step. */
void KktStepper::archive(Archive& archive, const State& /*state*/)
{
  archive(contacts_, fading_, strain_);
}

}  // namespace endovascular_sim::rod
