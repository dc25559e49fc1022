#include "rod/kkt_stepper.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "rod/held_wire.h"
#include "rod/resampling.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr int kMaxHalvings = 3;
constexpr int kIdleRow = 3;  // after the first node's, where a multiplier would stand
/** m of stretch per N of tension and kg of a node [s²]: nothing, but no zero pivot. */
constexpr double kEdgeCompliance = 1e-16;
constexpr double kEnergyGrowth = 1.1;
constexpr int kMaxRestoringSolves = 4;
constexpr double kRestoringFraction = 0.03;  // of the time step: elastic forces move next to nothing in it
constexpr double kLargestMotion = 1e3;       // m: beyond it a solution counts as failed
constexpr double kLargestStrain = 1e-2;      // that a step may leave, e.g. of a straight wire that is shortened
constexpr double kSheathStiffness = 4e7;     // N/m², of the introducer's wall per length of wire
constexpr double kMouthLength = 2.5e-3;      // m, of wire that the rim of its mouth stands for
constexpr double kLargestTension = 1e9;      // the same, in units of the multiplier

}  // namespace

void StepReport::add(const StepReport& other)
{
  solved = solved && other.solved;
  solves += other.solves;
  factorisations += other.factorisations;
  truncations += other.truncations;
  halvings += other.halvings;
  capped += other.capped;
  max_strain = std::max(max_strain, other.max_strain);
  first_stale_pass = std::min(first_stale_pass, other.first_stale_pass);
}

KktStepper::KktStepper(Discretisation rod, Boundary boundary, Environment environment, StepperSettings settings)
  : rod_(std::move(rod)), boundary_(std::move(boundary)), environment_(std::move(environment)), settings_(settings)
{
  scale_ = rod_.mass[static_cast<std::size_t>(rod_.nodes() / 2)];
}

double KktStepper::bodyPosition(int node, double inserted_length) const
{
  return HeldWire(rod_, boundary_).bodyPosition(node, inserted_length);
}

State KktStepper::initialState(double inserted_length, double rotation) const
{
  State state = HeldWire(rod_, boundary_).initialState(inserted_length, rotation);
  const Eigen::Vector3d& last = state.position.back();
  const Eigen::Vector3d& before = state.position[state.position.size() - 2];
  state.distal_anchor = boundary_.distal == EndHold::kClamped ? Eigen::Vector3d(0.5 * (last + before)) : last;
  return state;
}

bool KktStepper::isPrescribed(int node, const State& state) const
{
  if (isDistalHeld(node))
    return true;
  if (boundary_.introducer)
    return bodyPosition(node, state.inserted_length) < -boundary_.guide_length;
  return (boundary_.proximal != EndHold::kFree && node == 0) || (boundary_.proximal == EndHold::kClamped && node == 1);
}

void KktStepper::placePrescribedNodes(State& state, double inserted_length, double dt)
{
  const int old_first = state.first_node;
  const double speed = (inserted_length - state.inserted_length) / dt;
  state.inserted_length = inserted_length;
  if (boundary_.introducer)
  {
    state.first_node = HeldWire(rod_, boundary_).firstSimulatedNode(inserted_length);
    for (int i = state.first_node; i < rod_.nodes() && (i < old_first || isPrescribed(i, state)); ++i)
    {
      if (isDistalHeld(i))
        break;
      state.position[i] = boundary_.origin + bodyPosition(i, inserted_length) * boundary_.direction;
      state.velocity[i] = speed * boundary_.direction;
      begin_[i] = state.position[i] - dt * state.velocity[i];  // a node that was not simulated yet has no other
      if (i < old_first)
        begin_twist_[i] = state.rotation;
      state.wall_force[i].setZero();
    }
  }
  first_ = state.first_node;
}

TwistBoundary KktStepper::twistBoundary(const State& state, const StepInput& input) const
{
  TwistBoundary twist = HeldWire(rod_, boundary_).twistBoundary(state, input.tip_torque);
  twist.edge_torque = &input.edge_torque;
  twist.tip_held = boundary_.distal == EndHold::kClamped && boundary_.distal_twist_held;
  twist.tip_director = distalRotation(state) * boundary_.director;
  twist.tip_rotation = state.distal.rotation;
  return twist;
}

KktStepper::TwistAction KktStepper::relaxTwist(State& state, const StepInput& input,
                                               const std::vector<TwistFriction>& friction)
{
  TwistBoundary boundary = twistBoundary(state, input);
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
  return advance(state, input, dt, 0, report);
}

void KktStepper::refreshRod(State& /*state*/, const StepInput& /*input*/, double /*dt*/) {}

void KktStepper::complete(State& /*state*/, double /*dt*/) {}

/** Twist was relaxed with the hand turned on already and the centreline not yet: while a hand turns, that torque is too
 *  large by the bent tip's stiffness times the turn of a step. */
void KktStepper::renewTorques(State& state, const StepInput& input)
{
  kept_twist_ = state.twist_angle;
  relaxTwist(state, input, friction_.aboutAxis());
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

bool KktStepper::advance(State& state, const StepInput& input, double dt, int depth, StepReport& report)
{
  if (static_cast<int>(backup_.size()) <= depth)
    backup_.resize(static_cast<std::size_t>(depth) + 1);
  backup_[depth] = state;
  if (solveStep(state, input, dt, report) && (depth == kMaxHalvings || !gainedEnergy(state, depth, dt)))
    return true;
  state = backup_[depth];
  contacts_.invalidate();
  if (depth == kMaxHalvings)
  {
    hold(state, depth);
    return false;
  }
  ++report.halvings;
  StepInput half = input;
  half.inserted_length = 0.5 * (state.inserted_length + input.inserted_length);
  half.rotation = 0.5 * (state.rotation + input.rotation);
  half.distal = between(state.distal, input.distal, 0.5);
  for (std::size_t k = 0; k < half.layers.size(); ++k)
  {
    half.layers[k].inserted_length = 0.5 * (state.layers[k].inserted_length + input.layers[k].inserted_length);
    half.layers[k].rotation = 0.5 * (state.layers[k].rotation + input.layers[k].rotation);
  }
  if (advance(state, half, 0.5 * dt, depth + 1, report) && advance(state, input, 0.5 * dt, depth + 1, report))
    return true;
  hold(state, depth);
  return false;
}

/** Whether a step that was accepted unfinished has more energy than it began with and the hand gave: a snap that was
 *  too violent for the step. */
bool KktStepper::gainedEnergy(const State& state, int depth, double dt)
{
  if (!capped_)
    return false;
  const State& before = backup_[depth];
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

/** Refused: the wire stays where it was, at rest, and the caller is told. */
void KktStepper::hold(State& state, int depth)
{
  state = backup_[depth];
  for (Eigen::Vector3d& velocity : state.velocity)
    velocity.setZero();
  contacts_.invalidate();
  strain_ = maxStrain(rod_, state);
}

bool KktStepper::solveStep(State& state, const StepInput& input, double dt, StepReport& report)
{
  begin_ = state.position;
  begin_twist_ = state.twist_angle;
  const bool turned = turns(state, input);
  refreshRod(state, input, dt);
  placePrescribedNodes(state, input.inserted_length, dt);
  placeDistalEnd(state, input.distal, dt);
  state.rotation = input.rotation;
  contacts_.refresh(state, report);
  contacts_.settle(state);
  capped_ = false;
  for (int solve = 0; solve < settings_.max_solves; ++solve)
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
    const bool last = solve + 1 == settings_.max_solves;
    const double factor = move(state, truncation(state, report), report);
    if (factor == 1.0)
      accept(state, dt);
    if (contacts_.present() && contacts_.set().stale)
      break;  // one solve per step is all that old contacts are good for
    strain_ = maxStrain(rod_, state);
    if (factor == 1.0 && strain_ <= settings_.strain_tolerance && !contacts_.foundUnknown())
      break;
    capped_ = last;
    report.capped += last;
    if (last && (!restoreLengths(state, input, dt, report) || maxStrain(rod_, state) > kLargestStrain))
      return false;
  }
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
    const double fraction = kRestoringFraction * dt;
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
  for (int i = first_; i < rod_.nodes(); ++i)
    if (!isPrescribed(i, state))
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

void KktStepper::addDiagonal(int node, double value)
{
  const int r = row(node);
  for (int axis = 0; axis < 3; ++axis)
    base_.at(r + axis, r + axis) += value;
}

void KktStepper::addBlock(int node, const Eigen::Matrix3d& block)
{
  const int r = row(node);
  for (int col = 0; col < 3; ++col)
    for (int line = col; line < 3; ++line)
      base_.at(r + line, r + col) += block(line, col);
}

void KktStepper::assemble(const State& state, const StepInput& input, double dt, bool first_solve)
{
  const int n = rod_.nodes();
  base_.reset(4 * (n - first_));
  base_rhs_.assign(static_cast<std::size_t>(base_.size()), 0.0);
  base_.at(kIdleRow, kIdleRow) = -scale_;
  resistance_.resize(static_cast<std::size_t>(n));
  resisted_.resize(static_cast<std::size_t>(n));
  surfaceAngles(state, surface_angle_);
  const SurfaceMotion surface = surfaceMotion();
  friction_.linearise(&surface);
  addAllBending(state, dt);
  for (int j = first_; j + 1 < n; ++j)
    addConstraint(j, state, dt);
  for (int i = first_; i < n; ++i)
    addNodeTerms(i, state, dt, first_solve);
  if (boundary_.introducer)
    addMouth(state, dt);
  for (const NodalForce& load : input.forces)
    if (load.node >= first_)
      for (int axis = 0; axis < 3; ++axis)
        base_rhs_[row(load.node) + axis] += dt * dt * load.force[axis];
}

/** What the bending of a node and of the one after it depends on; @p second is the same node where none is left. */
BendingPairInput KktStepper::bendingInput(int first, int second, const State& state, double dt) const
{
  const std::vector<Eigen::Vector3d>& x = state.position;
  BendingPairInput in;
  in.e = PairVector::of(x[first] - x[first - 1], x[second] - x[second - 1]);
  in.g = PairVector::of(x[first + 1] - x[first], x[second + 1] - x[second]);
  const Pair before{rod_.rest_length[first - 1], rod_.rest_length[second - 1]};
  const Pair after{rod_.rest_length[first], rod_.rest_length[second]};
  in.rest_product = before * after;
  in.weight = dt * dt * Pair{rod_.bending_stiffness[first], rod_.bending_stiffness[second]} /
              Pair{rod_.cell_length[first], rod_.cell_length[second]};
  Eigen::Vector3d first_rest = state.curvature_offset[first];
  Eigen::Vector3d second_rest = state.curvature_offset[second];
  if (!action_.active)
  {
    in.rest = PairVector::of(first_rest, second_rest);
    in.torque_before = in.torque_after = Pair{0.0, 0.0};
    return in;
  }
  if (first >= action_.first_curved)
    first_rest += action_.rest_binormal[first];
  if (second >= action_.first_curved)
    second_rest += action_.rest_binormal[second];
  in.rest = PairVector::of(first_rest, second_rest);
  // Gradient of the twist by the centreline (Bergou et al. 2010, eq. 7): ∂m/∂e = κb/(2|ē|) for both edges.
  const Pair torque = 0.5 * dt * dt * Pair{action_.torque[first], action_.torque[second]};
  in.torque_before = torque / before;
  in.torque_after = torque / after;
  return in;
}

void KktStepper::addAllBending(const State& state, double dt)
{
  const int last = rod_.nodes() - 2;
  for (int i = first_ + 1; i <= last; i += 2)
    addBending(i, std::min(i + 1, last), BendingPair(bendingInput(i, std::min(i + 1, last), state, dt)));
}

/** Adds the first node's terms, and the second's where it is another node. */
void KktStepper::addBending(int first, int second, const BendingPair& bending)
{
  const auto& a = bending.before_before;
  const auto& b = bending.before_after;
  const auto& c = bending.after_after;
  for (int lane = 0; lane <= second - first; ++lane)
  {
    const int proximal_row = row(first + lane - 1);
    double* rhs = base_rhs_.data() + proximal_row;
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis)
    {
      rhs[axis] -= bending.proximal[axis][lane];
      rhs[axis + 4] += bending.proximal[axis][lane] + bending.distal[axis][lane];
      rhs[axis + 8] -= bending.distal[axis][lane];
    }
#pragma GCC unroll 3
    for (int col = 0; col < 3; ++col)
    {
      // Entry of a line below the column's diagonal; a node's rows lie 4 below those of the node before.
      double* from0 = base_.column(proximal_row) + col * Matrix::kStride - col;
      double* from1 = from0 + 4 * Matrix::kStride;
      double* from2 = from1 + 4 * Matrix::kStride;
#pragma GCC unroll 3
      for (int line = 0; line < 3; ++line)
      {
        const int low = std::max(line, col);
        const int high = std::min(line, col);
        const double across = b[col][line][lane];
        from0[line + 4] += across - a[low][high][lane];
        from0[line + 8] -= across;
        from1[line + 4] += across - c[low][high][lane];
        if (line < col)
          continue;
        from0[line] += a[line][col][lane];
        from1[line] += a[line][col][lane] - b[line][col][lane] - across + c[line][col][lane];
        from2[line] += c[line][col][lane];
      }
    }
  }
}

void KktStepper::addConstraint(int edge, const State& state, double dt)
{
  const Eigen::Vector3d e = state.position[edge + 1] - state.position[edge];
  const double length = e.norm();
  const double inverse = 1.0 / length;
  const Eigen::Vector3d direction = inverse * e;
  const int r0 = row(edge);
  const int rm = multiplierRow(edge);
  const double tension = std::max(0.0, state.tension[edge]) * dt * dt * inverse;
  double* column0 = base_.column(r0);
  double* column1 = base_.column(r0 + 4);
#pragma GCC unroll 3
  for (int col = 0; col < 3; ++col)
  {
    double* from0 = column0 + col * Matrix::kStride - col;
    double* from1 = column1 + col * Matrix::kStride - col;
    from0[7] = -scale_ * direction[col];
    from1[3] = scale_ * direction[col];
    if (tension <= 0.0)
      continue;
#pragma GCC unroll 3
    for (int line = 0; line < 3; ++line)
    {
      const double value = tension * ((line == col ? 1.0 : 0.0) - direction[line] * direction[col]);
      from0[line + 4] -= value;
      if (line < col)
        continue;
      from0[line] += value;
      from1[line] += value;
    }
  }
  base_.at(rm, rm) = -(kEdgeCompliance / (dt * dt)) * scale_;
  base_rhs_[rm] = -scale_ * (length - rod_.rest_length[edge]);
}

/** Where the wire passes the introducer's mouth, inside of an edge. */
void KktStepper::addMouth(const State& state, double dt)
{
  int edge = first_;
  while (edge + 2 < rod_.nodes() && bodyPosition(edge + 1, state.inserted_length) < 0.0)
    ++edge;
  const double share = -bodyPosition(edge, state.inserted_length) / rod_.rest_length[edge];
  if (share >= 0.0 && share <= 1.0)
    addSheath(edge, share, state, dt);
}

/** The introducer is a tube: a point of the wire in it, at a share of an edge, stays within the clearance or near
 *  it. */
void KktStepper::addSheath(int edge, double share, const State& state, double dt)
{
  const std::array<double, 2> weight = {1.0 - share, share};
  Eigen::Vector3d off = weight[0] * state.position[edge] - boundary_.origin;
  if (share > 0.0)
    off += share * state.position[edge + 1];
  const Eigen::Vector3d lateral = off - boundary_.direction.dot(off) * boundary_.direction;
  const double distance = lateral.norm();
  if (distance <= boundary_.sheath_clearance)
    return;
  const Eigen::Vector3d outward = lateral / distance;
  const double length = share > 0.0 ? kMouthLength : rod_.cell_length[edge];
  const double stiffness = dt * dt * kSheathStiffness * length;
  const double tilt = 1.0 - boundary_.sheath_clearance / distance;  // the normal turns with the point
  const Eigen::Matrix3d radial = outward * outward.transpose();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - boundary_.direction * boundary_.direction.transpose();
  const Eigen::Matrix3d hessian = stiffness * (radial + tilt * (across - radial));
  const Eigen::Vector3d force = (stiffness * (distance - boundary_.sheath_clearance)) * outward;
  for (int end = 0; end < (share > 0.0 ? 2 : 1); ++end)
  {
    for (int axis = 0; axis < 3; ++axis)
      base_rhs_[row(edge + end) + axis] -= weight[end] * force[axis];
    addBlock(edge + end, weight[end] * weight[end] * hessian);
  }
  for (int col = 0; share > 0.0 && col < 3; ++col)
    for (int line = 0; line < 3; ++line)
      base_.at(row(edge + 1) + line, row(edge) + col) += weight[0] * weight[1] * hessian(line, col);
}

/** Less the mass of the fluid that the node displaces [kg]. */
double KktStepper::heavyMass(int node) const
{
  const double displaced =
      environment_.fluid_density * M_PI * rod_.radius[node] * rod_.radius[node] * rod_.cell_length[node];
  return rod_.mass[node] - displaced;
}

double KktStepper::dragCoefficient(int node, double speed, const State& state) const
{
  if (environment_.fluid_density <= 0.0 || (boundary_.introducer && bodyPosition(node, state.inserted_length) < 0.0))
    return 0.0;
  return environment_.fluid_density * environment_.drag_coefficient * rod_.radius[node] * rod_.cell_length[node] *
         speed;
}

void KktStepper::addNodeTerms(int node, const State& state, double dt, bool first_solve)
{
  const double mass = rod_.mass[node];
  const Eigen::Vector3d travel = state.position[node] - begin_[node];
  Eigen::Vector3d residual = mass * (travel - dt * state.velocity[node]);
  if (!environment_.gravity.isZero(0.0))
    residual -= (dt * dt * heavyMass(node)) * environment_.gravity;
  const double damped = mass * dt * environment_.damping;
  residual += damped * travel;
  addDiagonal(node, mass + damped);
  resistance_[node] = damped;
  resisted_[node].setZero();
  const double beyond = bodyPosition(node, state.inserted_length);
  Eigen::Vector3d velocity = first_solve ? state.velocity[node] : Eigen::Vector3d(travel / dt);
  const bool slides = massSlide() != nullptr && !restoring_;
  if (slides)
  {
    const MassSlide& slide = (*massSlide())[node];
    residual += mass * slide.gained;
    resisted_[node] = damped * slide.travel;
    velocity += (*surfaceSlide())[node] / dt;
  }
  const double coefficient = dragCoefficient(node, velocity.norm(), state);
  if (coefficient != 0.0)
  {
    const double drag = dt * coefficient;
    residual += drag * travel;
    addDiagonal(node, drag);
    resistance_[node] += drag;
    if (slides)
      resisted_[node] += drag * (*surfaceSlide())[node];
  }
  if (slides)
    residual += resisted_[node];
  if (boundary_.introducer && beyond < 0.0 && beyond >= -boundary_.guide_length)
  {
    const double depth = beyond / boundary_.guide_length;
    const double stiffness = dt * dt * boundary_.guide_stiffness * rod_.cell_length[node] * depth * depth;
    const Eigen::Matrix3d across =
        stiffness * (Eigen::Matrix3d::Identity() - boundary_.direction * boundary_.direction.transpose());
    residual += across * (state.position[node] - boundary_.origin);
    addBlock(node, across);
    addSheath(node, 0.0, state, dt);
  }
  for (int axis = 0; axis < 3; ++axis)
    base_rhs_[row(node) + axis] -= residual[axis];
}

void KktStepper::prescribeNodes(const State& state)
{
  for (int i = first_; i < rod_.nodes(); ++i)
  {
    if (!isPrescribed(i, state))
    {
      if (boundary_.introducer && boundary_.distal == EndHold::kFree)
        break;
      continue;
    }
    const bool next_too = i + 1 < rod_.nodes() && isPrescribed(i + 1, state);
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
    klu_.solve(rhs_.data());
  }
  else
  {
    if (matrix_.factorise() != rod_.nodes() - first_)
      return false;
    matrix_.solve(rhs_);
  }
  // Tensions may be huge for one solve, where a straight wire is shortened; motions may not.
  for (std::size_t k = 0; k < rhs_.size(); ++k)
  {
    const bool multiplier = k % 4 == kIdleRow;
    if (!(std::abs(rhs_[k]) < (multiplier ? kLargestTension : kLargestMotion)))
      return false;
  }
  return true;
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
