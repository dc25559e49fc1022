#include <algorithm>
#include <cmath>

#include "rod/kkt/kkt_stepper.h"

// The part of the scheme that sets up a solve's system: bending, constraints, nodes' masses and loads, the introducer.

namespace endovascular_sim::rod
{
namespace
{

constexpr int kIdleRow = 3;  // after the first node's, where a multiplier would stand
/** m of stretch per N of tension and kg of a node [s²]: nothing, but no zero pivot. */
constexpr double kEdgeCompliance = 1e-16;
constexpr double kSheathStiffness = 4e7;  // N/m², of the introducer's wall per length of wire
constexpr double kMouthLength = 2.5e-3;   // m, of wire that the rim of its mouth stands for

}  // namespace

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
  while (edge + 2 < rod_.nodes() && conditions_.bodyPosition(edge + 1, state.inserted_length) < 0.0)
    ++edge;
  const double share = -conditions_.bodyPosition(edge, state.inserted_length) / rod_.rest_length[edge];
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
  if (environment_.fluid_density <= 0.0 ||
      (boundary_.introducer && conditions_.bodyPosition(node, state.inserted_length) < 0.0))
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
  const double beyond = conditions_.bodyPosition(node, state.inserted_length);
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

}  // namespace endovascular_sim::rod
