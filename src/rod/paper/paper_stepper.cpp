#include "rod/paper/paper_stepper.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rod/boundary/reaction_forces.h"
#include "rod/contact/contact_margins.h"
#include "rod/model/bending.h"
#include "rod/model/node_curvature.h"
#include "rod/model/stretching.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLargestMotion = 1e3;   // m: beyond it a solution counts as failed
constexpr double kLargestStrain = 1e-2;  // accepted after a projection that has not converged

}  // namespace

PaperStepper::PaperStepper(Discretisation rod, Boundary boundary, Environment environment, StepperSettings settings)
  : rod_(std::move(rod)), boundary_(std::move(boundary)), environment_(std::move(environment)), settings_(settings)
{
}

State PaperStepper::initialState(double inserted_length, double rotation) const
{
  return conditions().initialState(inserted_length, rotation);
}

StepReport PaperStepper::step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                              contact::ContactSource* contacts, PhaseTimer& timer)
{
  if (!input.drags.empty())
    throw std::invalid_argument("PaperStepper: this scheme has no drag of streams");
  if (input.step != step_ || input.substep == 0)
    step_is_stale_ = false;
  source_ = contacts;
  timer_ = &timer;
  pass_ = &pass;
  step_ = input.step;
  substep_ = input.substep;
  last_tip_torque_ = input.tip_torque;
  StepReport report;
  backup_ = state;
  if (!haveContacts(state, report))
    hold(state);
  else if (!advanceOrRetry(state, input, dt, report))
  {
    report.solved = false;
    hold(state);
  }
  else if (source_)
    detect(state, report);
  report.max_strain = maxStrain(rod_, state);
  return report;
}

/** Invalidates the contacts: the wire waits for new ones before it moves. */
bool PaperStepper::resample(const Discretisation& rod)
{
  rod_ = rod;
  contacts_.features.clear();
  contacts_valid_ = false;
  return true;
}

void PaperStepper::hold(State& state)
{
  state = backup_;
  for (Eigen::Vector3d& velocity : state.velocity)
    velocity.setZero();
  contacts_valid_ = false;
}

bool PaperStepper::haveContacts(const State& state, StepReport& report)
{
  if (!source_)
    return true;
  if (!contacts_valid_ || contacts_.stale)
    detect(state, report);
  return !contacts_.stale;
}

void PaperStepper::detect(const State& state, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  query_.step = step_;
  query_.substep = substep_;
  query_.pass = *pass_;
  conditions().describe(state, query_);
  uniformMargin(settings_.contact_margin).apply(query_);
  // After a missing answer the rest of the step uses the stale set: a replay then needs one number only.
  contacts_.stale = step_is_stale_;
  if (!step_is_stale_)
    source_->detect(query_, contacts_);
  if (contacts_.stale && !step_is_stale_)
    report.first_stale_pass = *pass_;
  step_is_stale_ = contacts_.stale;
  contacts_valid_ = true;
  ++*pass_;
}

/** Far from the introducer's axis the guide's axial force changes too fast for a linear step. The step is then repeated
 *  without it. */
bool PaperStepper::advanceOrRetry(State& state, const StepInput& input, double dt, StepReport& report)
{
  guide_form_ = GuideStiffness::kSemiDefinite;
  if (advance(state, input, dt, report))
    return true;
  state = backup_;
  guide_form_ = GuideStiffness::kLateral;
  return advance(state, input, dt, report);
}

bool PaperStepper::advance(State& state, const StepInput& input, double dt, StepReport& report)
{
  beginStep(state, input, dt);
  twist_active_ = conditions().relaxTwist(twist_, state, input.tip_torque, *timer_);
  {
    PhaseTimer::Scope scope(*timer_, Phase::kAssembly);
    assemble(state, input, dt);
  }
  PhaseTimer::Scope scope(*timer_, Phase::kSolve);
  return solve(state, dt, report) && project(state, dt, report);
}

/** Sets the velocities of prescribed nodes; all forces are evaluated at the positions before the step. */
void PaperStepper::beginStep(State& state, const StepInput& input, double dt)
{
  const BoundaryConditions held = conditions();
  held.placePrescribedNodes(state, input.inserted_length, dt);
  state.rotation = input.rotation;
  first_ = state.first_node;
  inverse_mass_.resize(rod_.mass.size());
  for (int i = first_; i < rod_.nodes(); ++i)
  {
    const bool prescribed = held.isPrescribed(i, state);
    inverse_mass_[i] = prescribed ? 0.0 : 1.0 / rod_.mass[i];
    if (prescribed)
      state.position[i] -= dt * state.velocity[i];
  }
  begin_ = state.position;
}

Eigen::Vector3d PaperStepper::displacement(int node) const
{
  const double* value = rhs_.data() + row(node);
  return {value[0], value[1], value[2]};
}

/** Assembles the linear step for the displacements Δt v⁺, its rows multiplied by Δt: matrix in kg, right-hand side in
 *  kg·m. */
void PaperStepper::assemble(const State& state, const StepInput& input, double dt)
{
  const int n = rod_.nodes();
  matrix_.reset(3 * (n - first_));
  rhs_.assign(static_cast<std::size_t>(matrix_.size()), 0.0);
  for (int i = first_ + 1; i + 1 < n; ++i)
    addBending(i, state, dt);
  for (int j = first_; j + 1 < n; ++j)
    addStretch(j, state, dt);
  friction_.collect(state, begin_, nullptr, dt, true);  // with the normal forces of the last step
  friction_.linearise();
  for (std::size_t k = 0; k < friction_.count(); ++k)
  {
    const WallFriction::Term& term = friction_.term(k);
    addForce(term.node, -dt * dt * term.pull);
    addBlock(term.node, term.node, dt * dt * term.stiffness);
  }
  for (int i = first_; i < n; ++i)
    addNodeTerms(i, state, dt);
  addGuide(state, dt);
  addContacts(state, dt);
  for (const NodalForce& load : input.forces)
    if (load.node >= first_)
      addForce(load.node, dt * dt * load.force);
}

void PaperStepper::addForce(int node, const Eigen::Vector3d& force)
{
  for (int axis = 0; axis < 3; ++axis)
    rhs_[row(node) + axis] += force[axis];
}

/** Adds a block to the matrix.
 *  @param row_node not before @p col_node; of a diagonal block only the lower triangle is used */
void PaperStepper::addBlock(int row_node, int col_node, const Eigen::Matrix3d& block)
{
  const int r = row(row_node);
  const int c = row(col_node);
  for (int col = 0; col < 3; ++col)
    for (int line = row_node == col_node ? col : 0; line < 3; ++line)
      matrix_.at(r + line, c + col) += block(line, col);
}

void PaperStepper::addBending(int node, const State& state, double dt)
{
  const CurvatureBinormal kb = binormalAt(rod_, state, node);
  const double weight = dt * dt * rod_.bending_stiffness[node] / rod_.cell_length[node];
  Eigen::Vector3d strain = kb.value;
  if (twist_active_ && node >= twist_.firstCurved())
    strain -= twist_.restCurvatureBinormal(node);
  Eigen::Vector3d by_before = weight * kb.transposeBefore(strain);
  Eigen::Vector3d by_after = weight * kb.transposeAfter(strain);
  if (twist_active_ && twist_.torque(node) != 0.0)
  {
    // Gradient of the twist by the centreline (Bergou et al. 2010, eq. 7).
    const Eigen::Vector3d torque = (0.5 * dt * dt * twist_.torque(node)) * kb.value;
    by_before += torque / rod_.rest_length[node - 1];
    by_after += torque / rod_.rest_length[node];
  }
  addForce(node - 1, by_before);
  addForce(node, by_after - by_before);
  addForce(node + 1, -by_after);
  const BendingHessian hessian(kb, weight);
  const Eigen::Matrix3d& a = hessian.before_before;
  const Eigen::Matrix3d b = hessian.before_after.transpose();
  const Eigen::Matrix3d& c = hessian.after_after;
  addBlock(node - 1, node - 1, a);
  addBlock(node, node - 1, b - a);
  addBlock(node + 1, node - 1, -b);
  addBlock(node, node, a - b - b.transpose() + c);
  addBlock(node + 1, node, b - c);
  addBlock(node + 1, node + 1, c);
}

void PaperStepper::addStretch(int edge, const State& state, double dt)
{
  const Stretching stretch(state.position[edge + 1] - state.position[edge], rod_.rest_length[edge],
                           rod_.axial_stiffness[edge]);
  const Eigen::Vector3d force = (dt * dt) * stretch.gradient();
  addForce(edge, force);
  addForce(edge + 1, -force);
  const Eigen::Matrix3d hessian = (dt * dt) * stretch.positiveHessian();
  addBlock(edge, edge, hessian);
  addBlock(edge + 1, edge, -hessian);
  addBlock(edge + 1, edge + 1, hessian);
}

void PaperStepper::addNodeTerms(int node, const State& state, double dt)
{
  const BoundaryConditions held = conditions();
  const Eigen::Vector3d& velocity = state.velocity[node];
  const double mass = rod_.mass[node];
  const double area = M_PI * rod_.radius[node] * rod_.radius[node];
  const double displaced = environment_.fluid_density * area * rod_.cell_length[node];
  addForce(node, mass * dt * velocity + (dt * dt * (mass - displaced)) * environment_.gravity);
  double diagonal = mass * (1.0 + dt * environment_.damping);
  if (!boundary_.introducer || held.bodyPosition(node, state.inserted_length) >= 0.0)
    diagonal += dt * environment_.fluid_density * environment_.drag_coefficient * rod_.radius[node] *
                rod_.cell_length[node] * velocity.norm();
  Eigen::Matrix3d block = diagonal * Eigen::Matrix3d::Identity();
  addBlock(node, node, block);
}

void PaperStepper::addGuide(const State& state, double dt)
{
  const double factor = dt * dt;
  guide_.forEachEdge(
      rod_, state,
      [this, factor](int edge, const GuidedEdge& term)
      {
        addForce(edge, -factor * term.gradient[0]);
        addForce(edge + 1, -factor * term.gradient[1]);
        addBlock(edge, edge, factor * term.first);
        addBlock(edge + 1, edge, factor * term.across);
        addBlock(edge + 1, edge + 1, factor * term.second);
      },
      guide_form_);
}

/** Prescribes nodes, factorises and solves. */
bool PaperStepper::solve(const State& state, double dt, StepReport& report)
{
  base_.copyFrom(matrix_);
  base_rhs_ = rhs_;
  for (int i = first_; i < rod_.nodes(); ++i)
    for (int axis = 0; inverse_mass_[i] == 0.0 && axis < 3; ++axis)
      matrix_.prescribe(row(i) + axis, dt * state.velocity[i][axis], rod_.mass[i], rhs_);
  ++report.solves;
  ++report.factorisations;
  if (settings_.linear_solver == LinearSolver::kSparse)
  {
    if (!cholmod_.factorise(sparseFromBand(matrix_)))
      return false;
    cholmod_.solve(rhs_.data());
  }
  else
  {
    if (matrix_.factorise() != 0)
      return false;
    matrix_.solve(rhs_);
  }
  return std::all_of(rhs_.begin(), rhs_.end(), [](double value) { return std::abs(value) < kLargestMotion; });
}

/** Applies the linear step, restores the lengths of the edges, and updates velocities and forces. */
bool PaperStepper::project(State& state, double dt, StepReport& report)
{
  for (int j = first_; j + 1 < rod_.nodes(); ++j)
  {
    const Stretching stretch(begin_[j + 1] - begin_[j], rod_.rest_length[j], rod_.axial_stiffness[j]);
    state.tension[j] = stretch.tension + stretch.axial_stiffness / stretch.rest_length *
                                             stretch.direction.dot(displacement(j + 1) - displacement(j));
  }
  for (int i = first_; i < rod_.nodes(); ++i)
    state.position[i] = begin_[i] + displacement(i);
  if (!projection_.project(rod_, first_, inverse_mass_, settings_.strain_tolerance, state.position))
  {
    if (!(maxStrain(rod_, state) < kLargestStrain))
      return false;
    ++report.hit_iteration_limit;
  }
  for (int j = first_; j + 1 < rod_.nodes(); ++j)
    state.tension[j] += projection_.tension(j) / (dt * dt);
  for (int i = first_; i < rod_.nodes(); ++i)
    state.velocity[i] = (state.position[i] - begin_[i]) / dt;
  updateEndForces(
      state, boundary_, [this](int node) { return inverse_mass_[node] == 0.0; },
      [this, dt](int node) { return forceOnHold(node, dt); });
  updateWallForces(state, dt);
  friction_.finish(state, begin_);
  return true;
}

/** Force of the wire on the hold of a node [N]: the remainder of its equation in the linear step, and the tensions of
 *  the projection along the edges before it. */
Eigen::Vector3d PaperStepper::forceOnHold(int node, double dt) const
{
  Eigen::Vector3d force = remainder(base_, Eigen::Vector3d(base_rhs_.data() + row(node)), rhs_, row(node));
  for (int edge = std::max(first_, node - 1); edge <= std::min(node, rod_.nodes() - 2); ++edge)
  {
    const Eigen::Vector3d found = begin_[edge + 1] + displacement(edge + 1) - begin_[edge] - displacement(edge);
    force += (edge == node ? 1.0 : -1.0) * projection_.tension(edge) * found.normalized();
  }
  return force / (dt * dt);
}

Energy PaperStepper::energy(const State& state)
{
  State relaxed = state;
  PhaseTimer unused;
  const bool active = conditions().relaxTwist(twist_, relaxed, last_tip_torque_, unused);
  return elasticEnergy(rod_, state, active ? &twist_ : nullptr);
}

}  // namespace endovascular_sim::rod
