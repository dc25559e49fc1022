#include "rod/kkt/active_set_solver.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

constexpr int kMaxActiveSetPasses = 16;
constexpr double kShift = 10.0;          // of the mass matrix, when a factorisation has the wrong inertia
constexpr double kLargestMotion = 1e3;   // m: beyond it a solution counts as failed
constexpr double kLargestTension = 1e9;  // the same, in units of the multiplier

}  // namespace

bool ActiveSetSolver::solve(const State& state, double dt, ContactSolver& contacts, WallFriction& friction,
                            ContactSolver::Motion& motion, StepReport& report)
{
  double shift = 0.0;
  bool same_rest = false;
  int changed = system_.first;  // first node whose terms differ from those of the last pass
  for (int active_pass = 0; active_pass < kMaxActiveSetPasses; ++active_pass)
  {
    fresh_ = matrix_.rewind(system_.matrix, shift > 0.0 || !canRewind(state) ? 0 : system_.row(changed));
    rhs_ = system_.rhs;
    addTerms(contacts, friction, shift, dt);
    if (!factoriseAndSolve(state, report))
    {
      if (shift > 0.0)
        return false;
      shift = kShift;
      same_rest = false;
      changed = system_.first;
      continue;
    }
    readMotion(motion);
    const bool contacts_changed = contacts.updateActiveSet(motion, active_pass, same_rest);
    const bool friction_changed = friction.update(motion, active_pass);
    if (!contacts_changed && !friction_changed)
      return true;
    same_rest = !friction_changed;
    changed = std::min(contacts_changed ? contacts.firstChanged() : model_.rod.nodes(),
                       friction_changed ? friction.firstChanged() : model_.rod.nodes());
  }
  return true;
}

void ActiveSetSolver::addTerms(const ContactSolver& contacts, const WallFriction& friction, double shift, double dt)
{
  for (std::size_t c = 0; c < contacts.count(); ++c)
    if (contacts.spring(c).active)
      addContact(contacts.feature(c), contacts.spring(c), dt);
  for (std::size_t k = 0; k < friction.count(); ++k)
    addFriction(friction.term(k), dt);
  for (int i = system_.first; shift > 0.0 && i < model_.rod.nodes(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      matrix_.at(system_.row(i) + axis, system_.row(i) + axis) += shift * model_.rod.mass[i];
}

void ActiveSetSolver::readMotion(ContactSolver::Motion& motion) const
{
  for (int i = system_.first; i < model_.rod.nodes(); ++i)
  {
    const double* value = rhs_.data() + system_.row(i);
    motion[i] = {value[0], value[1], value[2]};
  }
}

void ActiveSetSolver::correctLengths(const State& state, ContactSolver::Motion& motion)
{
  const StepperSettings& settings = model_.settings;
  const double corrected_strain = settings.corrected_strain_ratio * settings.strain_tolerance;
  if (corrected_strain <= settings.strain_tolerance)
    return;
  correction_.assign(rhs_.size(), 0.0);
  const int free = model_.conditions.firstFreeNode(state);
  double largest = 0.0;
  for (int j = std::max(system_.first, free - 1); j + 1 < model_.rod.nodes(); ++j)
  {
    if (model_.conditions.isDistalHeld(j))
      continue;
    const Eigen::Vector3d edge = state.position[j + 1] + motion[j + 1] - state.position[j] - motion[j];
    const double stretch = edge.norm() - model_.rod.rest_length[j];
    correction_[system_.multiplierRow(j)] = -system_.scale * stretch;
    largest = std::max(largest, std::abs(stretch) / model_.rod.rest_length[j]);
  }
  if (largest <= settings.strain_tolerance || !(largest <= corrected_strain))
    return;
  solveWithFactors(correction_);
  for (std::size_t k = 0; k < rhs_.size(); ++k)
    rhs_[k] += correction_[k];
  readMotion(motion);
}

/** True where a factorisation may continue from an earlier one: the prescribed nodes lie before its first mark. */
bool ActiveSetSolver::canRewind(const State& state) const
{
  if (model_.settings.linear_solver == LinearSolver::kSparse || !model_.boundary.introducer ||
      model_.boundary.distal != EndHold::kFree)
    return false;
  return system_.row(model_.conditions.firstFreeNode(state)) + KktSystem::kBandwidth <= KktSystem::Matrix::kMarkEvery;
}

void ActiveSetSolver::addContact(const contact::Feature& feature, const ContactSolver::Spring& contact, double dt)
{
  const double stiffness = dt * dt * contact.stiffness;
  const double push = -stiffness * contact.gap;
  const int r0 = system_.row(contact.node);
  const int r1 = contact.weight1 > 0.0 ? system_.row(contact.node + 1) : r0;
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

void ActiveSetSolver::addFriction(const WallFriction::Term& term, double dt)
{
  const int r = system_.row(term.node);
  for (int col = 0; col < 3; ++col)
  {
    rhs_[r + col] -= dt * dt * term.pull[col];
    for (int line = col; line < 3 && r >= fresh_; ++line)
      matrix_.at(r + line, r + col) += dt * dt * term.stiffness(line, col);
  }
}

void ActiveSetSolver::prescribeNodes(const State& state)
{
  const BoundaryConditions& conditions = model_.conditions;
  const int n = model_.rod.nodes();
  for (int i = system_.first; i < n; ++i)
  {
    if (!conditions.isPrescribed(i, state))
    {
      if (model_.boundary.introducer && model_.boundary.distal == EndHold::kFree)
        break;
      continue;
    }
    const bool next_too = i + 1 < n && conditions.isPrescribed(i + 1, state);
    if (fresh_ > 0)  // the factors of these rows are still valid
      std::fill_n(rhs_.begin() + system_.row(i), next_too ? 8 : 3, 0.0);
    else
    {
      for (int axis = 0; axis < 3; ++axis)
        matrix_.prescribe(system_.row(i) + axis, 0.0, system_.scale, rhs_);
      if (next_too)
        matrix_.prescribe(system_.multiplierRow(i), 0.0, -system_.scale, rhs_);
    }
  }
}

bool ActiveSetSolver::factoriseAndSolve(const State& state, StepReport& report)
{
  prescribeNodes(state);
  ++report.factorisations;
  if (model_.settings.linear_solver == LinearSolver::kSparse)
  {
    if (!klu_.factorise(sparseFromBand(matrix_)))
      return false;
  }
  else if (matrix_.factorise() != model_.rod.nodes() - system_.first)
    return false;
  solveWithFactors(rhs_);
  return isSmall();
}

/** Tensions may be huge for one solve, where a straight wire is shortened; motions may not. */
bool ActiveSetSolver::isSmall() const
{
  for (std::size_t k = 0; k < rhs_.size(); ++k)
  {
    const bool multiplier = k % 4 == KktSystem::kIdleRow;
    if (!(std::abs(rhs_[k]) < (multiplier ? kLargestTension : kLargestMotion)))
      return false;
  }
  return true;
}

void ActiveSetSolver::solveWithFactors(std::vector<double>& rhs)
{
  if (model_.settings.linear_solver == LinearSolver::kSparse)
    klu_.solve(rhs.data());
  else
    matrix_.solve(rhs);
}

}  // namespace endovascular_sim::rod
