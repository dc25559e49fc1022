#include "rod/kkt/active_set_solver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::rod
{
namespace
{

constexpr int kMaxActiveSetPasses = 16;
constexpr double kShift = 10.0;          // of the mass matrix, when a factorisation has the wrong inertia
constexpr double kLargestMotion = 1e3;   // m: beyond it a solution counts as failed
constexpr double kLargestTension = 1e9;  // the same, in units of the multiplier

}  // namespace

template <class Layout>
bool ActiveSetSolver<Layout>::solve(const State& state, double dt, ContactSolver& contacts, WallFriction& friction,
                                    const SurfaceTwist* twist, ContactSolver::Motion& motion, StepReport& report)
{
  bool coupled = false;
  if constexpr (Layout::kTurns)
  {
    coupled = !twist->mixed.empty();
    buildBase(*twist, dt, coupled);
  }
  twist_ = twist;
  state_ = &state;
  double shift = 0.0;
  bool same_rest = false;
  int changed = system_.first;  // first node whose terms differ from those of the last pass
  for (int active_pass = 0; active_pass < kMaxActiveSetPasses; ++active_pass)
  {
    // The turn of the edge before a node lies one block before the node's rows.
    const int keep = shift > 0.0 || !canRewind(state) ? 0 : row(changed) - (Layout::kTurns ? Layout::kPeriod : 0);
    if constexpr (Layout::kTurns)
    {
      fresh_ = matrix_.rewind(base_, keep);
      rhs_ = base_rhs_;
    }
    else
    {
      fresh_ = matrix_.rewind(system_.matrix, keep);
      rhs_ = system_.rhs;
    }
    addTerms(contacts, friction, shift, dt);
    if (!factoriseAndSolve(state, report))
    {
      if (coupled)
      {
        coupled = false;
        buildBase(*twist, dt, false);
      }
      else if (shift > 0.0)
        return false;
      else
        shift = kShift;
      same_rest = false;
      changed = system_.first;
      continue;
    }
    readMotion(motion);
    const bool contacts_changed = contacts.updateActiveSet(motion, active_pass, same_rest);
    const bool friction_changed = updateFriction(friction, motion, active_pass);
    if (!contacts_changed && !friction_changed)
      return true;
    same_rest = !friction_changed;
    changed = std::min(contacts_changed ? contacts.firstChanged() : model_.rod.nodes(),
                       friction_changed ? friction.firstChanged() : model_.rod.nodes());
  }
  return true;
}

template <class Layout>
void ActiveSetSolver<Layout>::addTerms(const ContactSolver& contacts, const WallFriction& friction, double shift,
                                       double dt)
{
  for (std::size_t c = 0; c < contacts.count(); ++c)
  {
    if (!contacts.spring(c).active)
      continue;
    addContact(contacts.feature(c), contacts.spring(c), dt);
    if (Layout::kTurns || model_.settings.curved_wall)
      addCurvature(contacts.feature(c), contacts.spring(c), dt);
  }
  for (std::size_t k = 0; k < friction.count(); ++k)
    addFriction(friction.term(k), dt);
  for (int i = system_.first; shift > 0.0 && i < model_.rod.nodes(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      matrix_.at(row(i) + axis, row(i) + axis) += shift * model_.rod.mass[i];
}

template <class Layout>
void ActiveSetSolver<Layout>::readMotion(ContactSolver::Motion& motion)
{
  for (int i = system_.first; i < model_.rod.nodes(); ++i)
  {
    const double* value = rhs_.data() + row(i);
    motion[i] = {value[0], value[1], value[2]};
  }
  if constexpr (Layout::kTurns)
    readTurns();
}

/** Copies positions and multipliers into the order of KktSystem, and the turns of edges and nodes. */
template <class Layout>
void ActiveSetSolver<Layout>::readTurns()
{
  const int n = model_.rod.nodes();
  solution_.resize(system_.rhs.size());
  turn_.assign(static_cast<std::size_t>(n - 1), 0.0);
  node_turn_.assign(static_cast<std::size_t>(n), 0.0);
  for (int i = system_.first; i < n; ++i)
    std::copy_n(rhs_.begin() + row(i), 4, solution_.begin() + system_.row(i));
  for (int j = system_.first; j + 1 < n; ++j)
    turn_[j] = rhs_[turnRow(j)];
  for (int i = system_.first; i < n; ++i)
  {
    if (i > system_.first)
      node_turn_[i] += twist_->weight[i][0] * turn_[i - 1];
    if (i + 1 < n)
      node_turn_[i] += twist_->weight[i][1] * turn_[i];
  }
}

template <class Layout>
bool ActiveSetSolver<Layout>::updateFriction(WallFriction& friction, const ContactSolver::Motion& motion, int pass)
{
  if constexpr (Layout::kTurns)
    return friction.updateWithTurns(motion, node_turn_, pass);
  return friction.update(motion, pass);
}

/** Builds the system with turns: that of the positions, and the twist.
 *  @param coupled with the mixed derivatives; their exact Hessian is indefinite beyond a snap-through */
template <class Layout>
void ActiveSetSolver<Layout>::buildBase(const SurfaceTwist& twist, double dt, bool coupled)
{
  spreadSystem();
  addTwist(twist, dt);
  if (!coupled)
    return;
  addMixedDerivatives(twist, dt);
  addEdgeStiffness(twist, dt);
}

template <class Layout>
void ActiveSetSolver<Layout>::addMixedDerivatives(const SurfaceTwist& twist, double dt)
{
  const int n = model_.rod.nodes();
  for (int j = system_.first; j + 1 < n; ++j)
    for (int place = 0; twist.unknown[j] != 0 && place < 4; ++place)
    {
      const int node = j - 1 + place;
      if (node < system_.first || node >= n)
        continue;
      for (int axis = 0; axis < 3; ++axis)
      {
        const int r = row(node) + axis;
        base_.at(std::max(r, turnRow(j)), std::min(r, turnRow(j))) += dt * dt * twist.mixed[j][place][axis];
      }
    }
}

template <class Layout>
void ActiveSetSolver<Layout>::addEdgeStiffness(const SurfaceTwist& twist, double dt)
{
  for (int i = system_.first + 1; i + 1 < model_.rod.nodes(); ++i)
  {
    const Eigen::Matrix3d before = dt * dt * twist.stiffness[i].before;
    const Eigen::Matrix3d after = dt * dt * twist.stiffness[i].after;
    const Eigen::Matrix3d across = dt * dt * twist.stiffness[i].across.transpose();
    addBlock(i - 1, i - 1, before);
    addBlock(i, i - 1, across - before);
    addBlock(i + 1, i - 1, -across);
    addBlock(i, i, before - across - across.transpose() + after);
    addBlock(i + 1, i, across - after);
    addBlock(i + 1, i + 1, after);
  }
}

/** Adds a block of two nodes' positions; of a diagonal block, the lower triangle. */
template <class Layout>
void ActiveSetSolver<Layout>::addBlock(int row_node, int column_node, const Eigen::Matrix3d& block)
{
  const int r = row(row_node);
  const int c = row(column_node);
  for (int col = 0; col < 3; ++col)
    for (int line = row_node == column_node ? col : 0; line < 3; ++line)
      base_.at(r + line, c + col) += block(line, col);
}

/** Copies the system of positions and multipliers into the layout with turns. */
template <class Layout>
void ActiveSetSolver<Layout>::spreadSystem()
{
  constexpr int kNarrow = 4;
  const int nodes = model_.rod.nodes() - system_.first;
  base_.resize(Layout::kPeriod * nodes);
  base_rhs_.assign(static_cast<std::size_t>(base_.size()), 0.0);
  for (int i = 0; i < nodes; ++i)
  {
    std::fill_n(base_.column(Layout::kPeriod * i), Layout::kPeriod * Matrix::kStride, 0.0);
    for (int place = 0; place < kNarrow; ++place)
    {
      const int begin = kNarrow * i;
      base_rhs_[Layout::kPeriod * i + place] = system_.rhs[begin + place];
      double* target = base_.column(Layout::kPeriod * i + place) - place;
      // Positions and multipliers of a node act on those of the next two.
      const int last = std::min({place + KktSystem::kBandwidth, 3 * kNarrow - 1, system_.matrix.size() - 1 - begin});
      for (int below = place; below <= last; ++below)
        target[below + below / kNarrow] = system_.matrix.at(begin + below, begin + place);
    }
  }
}

template <class Layout>
void ActiveSetSolver<Layout>::addTwist(const SurfaceTwist& twist, double dt)
{
  const int n = model_.rod.nodes();
  base_.at(turnRow(n - 1), turnRow(n - 1)) = system_.scale;  // idle
  for (int j = system_.first; j + 1 < n; ++j)
  {
    const int r = turnRow(j);
    if (twist.unknown[j] == 0)
    {
      base_.at(r, r) = system_.scale;
      continue;
    }
    base_.at(r, r) = dt * dt * twist.diagonal[j];
    base_rhs_[r] = -dt * dt * twist.gradient[j];
    if (j + 2 < n && twist.unknown[j + 1] != 0)
      base_.at(turnRow(j + 1), r) = dt * dt * twist.upper[j];
  }
}

template <class Layout>
void ActiveSetSolver<Layout>::correctLengths(const State& state, ContactSolver::Motion& motion)
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
    correction_[multiplierRow(j)] = -system_.scale * stretch;
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
template <class Layout>
bool ActiveSetSolver<Layout>::canRewind(const State& state) const
{
  if (model_.settings.linear_solver == LinearSolver::kSparse || !model_.boundary.introducer ||
      model_.boundary.distal != EndHold::kFree)
    return false;
  return row(model_.conditions.firstFreeNode(state)) + Layout::kBandwidth <= Matrix::kMarkEvery;
}

template <class Layout>
void ActiveSetSolver<Layout>::addContact(const contact::Feature& feature, const ContactSolver::Spring& contact,
                                         double dt)
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

/** Adds the turn of the normal with the motion of the wire across itself: at a node for the last wall force, between
 *  nodes for the present force of the spring. */
template <class Layout>
void ActiveSetSolver<Layout>::addCurvature(const contact::Feature& feature, const ContactSolver::Spring& contact,
                                           double dt)
{
  if (!(feature.clearance_radius > 0.0))  // the wall is not concave
    return;
  const bool at_second = contact.weight0 <= 0.0;
  const bool between = !at_second && contact.weight1 > 0.0;
  if (between && !Layout::kTurns)
    return;
  const int node = contact.node + (at_second ? 1 : 0);
  const double force = between ? -contact.stiffness * contact.gap : feature.normal.dot(state_->wall_force[node]);
  if (force <= 0.0)
    return;
  const int before = std::max(node - 1, system_.first);
  const int after = std::min(node + 1, model_.rod.nodes() - 1);
  const Eigen::Vector3d across = feature.normal.cross(state_->position[after] - state_->position[before]).normalized();
  const double stiffness = dt * dt * force / feature.clearance_radius;
  const std::array<double, 2> weight = {between ? contact.weight0 : 1.0, between ? contact.weight1 : 0.0};
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b <= a; ++b)
      for (int col = 0; col < 3 && weight[a] * weight[b] != 0.0; ++col)
        for (int line = a == b ? col : 0; line < 3; ++line)
          addEntry(row(node + a) + line, row(node + b) + col,
                   stiffness * weight[a] * weight[b] * across[line] * across[col]);
}

template <class Layout>
void ActiveSetSolver<Layout>::addFriction(const WallFriction::Term& term, double dt)
{
  const int r = row(term.node);
  for (int col = 0; col < 3; ++col)
  {
    rhs_[r + col] -= dt * dt * term.pull[col];
    for (int line = col; line < 3 && r >= fresh_; ++line)
      matrix_.at(r + line, r + col) += dt * dt * term.stiffness(line, col);
  }
  if constexpr (Layout::kTurns)
    addFrictionAboutAxis(term, dt);
}

/** Adds the derivatives of friction by the turns of both edges of a node. */
template <class Layout>
void ActiveSetSolver<Layout>::addFrictionAboutAxis(const WallFriction::Term& term, double dt)
{
  const int r = row(term.node);
  const std::array<double, 2>& weight = twist_->weight[term.node];
  const std::array<int, 2> turn_row = {turnRow(term.node - 1), turnRow(term.node)};
  const Eigen::Vector3d across = dt * dt * (term.stiffness * term.around);
  const double about = across.dot(term.around);
  for (int side = 0; side < 2; ++side)
  {
    if (weight[side] == 0.0)
      continue;
    rhs_[turn_row[side]] -= dt * dt * weight[side] * term.around.dot(term.pull);
    for (int axis = 0; axis < 3; ++axis)
      addEntry(turn_row[side], r + axis, weight[side] * across[axis]);
    addEntry(turn_row[side], turn_row[side], weight[side] * weight[side] * about);
  }
  if (weight[0] != 0.0 && weight[1] != 0.0)
    addEntry(turn_row[1], turn_row[0], weight[0] * weight[1] * about);
}

/** Adds to an entry of the matrix, unless its column still holds valid factors. */
template <class Layout>
void ActiveSetSolver<Layout>::addEntry(int a, int b, double value)
{
  if (std::min(a, b) >= fresh_)
    matrix_.at(std::max(a, b), std::min(a, b)) += value;
}

template <class Layout>
void ActiveSetSolver<Layout>::prescribeNodes(const State& state)
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
    {
      std::fill_n(rhs_.begin() + row(i), 3, 0.0);
      if (next_too)
        rhs_[multiplierRow(i)] = 0.0;
    }
    else
    {
      for (int axis = 0; axis < 3; ++axis)
        matrix_.prescribe(row(i) + axis, 0.0, system_.scale, rhs_);
      if (next_too)
        matrix_.prescribe(multiplierRow(i), 0.0, -system_.scale, rhs_);
    }
  }
}

template <class Layout>
bool ActiveSetSolver<Layout>::factoriseAndSolve(const State& state, StepReport& report)
{
  prescribeNodes(state);
  ++report.factorisations;
  if (model_.settings.linear_solver == LinearSolver::kSparse)
  {
    if (!klu_.factorise(sparseFromBand(matrix_)))
      return false;
    // KLU does not tell the inertia.
    if (Layout::kTurns && Matrix(matrix_).factorise() != model_.rod.nodes() - system_.first)
      return false;
  }
  else if (matrix_.factorise() != model_.rod.nodes() - system_.first)
    return false;
  solveWithFactors(rhs_);
  return isSmall();
}

/** Tensions may be huge for one solve, where a straight wire is shortened; motions may not. */
template <class Layout>
bool ActiveSetSolver<Layout>::isSmall() const
{
  for (std::size_t k = 0; k < rhs_.size(); ++k)
  {
    const bool multiplier = k % Layout::kPeriod == KktSystem::kIdleRow;
    if (!(std::abs(rhs_[k]) < (multiplier ? kLargestTension : kLargestMotion)))
      return false;
  }
  return true;
}

template <class Layout>
void ActiveSetSolver<Layout>::solveWithFactors(std::vector<double>& rhs)
{
  if (model_.settings.linear_solver == LinearSolver::kSparse)
    klu_.solve(rhs.data());
  else
    matrix_.solve(rhs);
}

template class ActiveSetSolver<PositionLayout>;
template class ActiveSetSolver<TurnLayout>;

}  // namespace endovascular_sim::rod
