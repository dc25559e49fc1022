#include "rod/kkt/kkt_assembly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace endovascular_sim::rod
{
namespace
{

using Matrix = KktSystem::Matrix;

/** Compliance of an edge times Δt² [s²]: negligible, but it keeps the pivots away from zero. */
constexpr double kEdgeCompliance = 1e-16;

}  // namespace

void KktAssembly::addDiagonal(int node, double value)
{
  const int r = system_.row(node);
  for (int axis = 0; axis < 3; ++axis)
    system_.matrix.at(r + axis, r + axis) += value;
}

void KktAssembly::addBlock(int node, const Eigen::Matrix3d& block)
{
  const int r = system_.row(node);
  for (int col = 0; col < 3; ++col)
    for (int line = col; line < 3; ++line)
      system_.matrix.at(r + line, r + col) += block(line, col);
}

void KktAssembly::assemble(const KktIterate& at)
{
  const int n = model_.rod.nodes();
  system_.reset(at.state.first_node, n);
  resistance_.coefficient.resize(static_cast<std::size_t>(n));
  resistance_.slide.resize(static_cast<std::size_t>(n));
  addAllBending(at);
  for (int j = system_.first; j + 1 < n; ++j)
    addConstraint(j, at);
  for (int i = system_.first; i < n; ++i)
    addNodeTerms(i, at);
  if (model_.boundary.introducer)
    addIntroducer(at);
  for (const NodalForce& load : at.forces)
    if (load.node >= system_.first)
      for (int axis = 0; axis < 3; ++axis)
        system_.rhs[system_.row(load.node) + axis] += at.dt * at.dt * load.force[axis];
  for (const NodalDrag& drag : at.drags)
    if (drag.node >= system_.first && !drag.coefficient.isZero(0.0))
      addStream(drag, at);
}

/** Input of the bending of two neighbouring nodes; @p second equals @p first at the last node of an odd number. */
BendingPairInput KktAssembly::bendingInput(int first, int second, const KktIterate& at) const
{
  const Discretisation& rod = model_.rod;
  const TwistAction& twist = at.twist;
  const double dt = at.dt;
  const std::vector<Eigen::Vector3d>& x = at.state.position;
  BendingPairInput in;
  in.e = PairVector::of(x[first] - x[first - 1], x[second] - x[second - 1]);
  in.g = PairVector::of(x[first + 1] - x[first], x[second + 1] - x[second]);
  const Pair before{rod.rest_length[first - 1], rod.rest_length[second - 1]};
  const Pair after{rod.rest_length[first], rod.rest_length[second]};
  in.rest_product = before * after;
  in.weight = dt * dt * Pair{rod.bending_stiffness[first], rod.bending_stiffness[second]} /
              Pair{rod.cell_length[first], rod.cell_length[second]};
  Eigen::Vector3d first_rest = at.state.curvature_offset[first];
  Eigen::Vector3d second_rest = at.state.curvature_offset[second];
  if (!twist.active)
  {
    in.rest = PairVector::of(first_rest, second_rest);
    in.torque_before = in.torque_after = Pair{0.0, 0.0};
    return in;
  }
  if (first >= twist.first_curved)
    first_rest += twist.rest_binormal[first];
  if (second >= twist.first_curved)
    second_rest += twist.rest_binormal[second];
  in.rest = PairVector::of(first_rest, second_rest);
  // Gradient of the twist by the centreline (Bergou et al. 2010, eq. 7): ∂m/∂e = κb/(2|ē|) for both edges.
  const Pair torque = 0.5 * dt * dt * Pair{twist.torque[first], twist.torque[second]};
  in.torque_before = torque / before;
  in.torque_after = torque / after;
  return in;
}

void KktAssembly::addAllBending(const KktIterate& at)
{
  const int last = model_.rod.nodes() - 2;
  for (int i = system_.first + 1; i <= last; i += 2)
    addBending(i, std::min(i + 1, last), BendingPair(bendingInput(i, std::min(i + 1, last), at)));
}

/** Adds the terms of the first node, and of the second where it differs. */
void KktAssembly::addBending(int first, int second, const BendingPair& bending)
{
  const auto& a = bending.before_before;
  const auto& b = bending.before_after;
  const auto& c = bending.after_after;
  for (int lane = 0; lane <= second - first; ++lane)
  {
    const int proximal_row = system_.row(first + lane - 1);
    double* rhs = system_.rhs.data() + proximal_row;
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
      // Entries from the column's diagonal on; a node's rows lie 4 below those of the preceding node.
      double* from0 = system_.matrix.column(proximal_row) + static_cast<std::ptrdiff_t>(col) * Matrix::kStride - col;
      double* from1 = from0 + std::ptrdiff_t{4} * Matrix::kStride;
      double* from2 = from1 + std::ptrdiff_t{4} * Matrix::kStride;
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

void KktAssembly::addConstraint(int edge, const KktIterate& at)
{
  const State& state = at.state;
  const double dt = at.dt;
  const double scale = system_.scale;
  const Eigen::Vector3d e = state.position[edge + 1] - state.position[edge];
  const double length = e.norm();
  const double inverse = 1.0 / length;
  const Eigen::Vector3d direction = inverse * e;
  const int r0 = system_.row(edge);
  const int rm = system_.multiplierRow(edge);
  const double tension = std::max(0.0, state.tension[edge]) * dt * dt * inverse;
  double* column0 = system_.matrix.column(r0);
  double* column1 = system_.matrix.column(r0 + 4);
#pragma GCC unroll 3
  for (int col = 0; col < 3; ++col)
  {
    double* from0 = column0 + static_cast<std::ptrdiff_t>(col) * Matrix::kStride - col;
    double* from1 = column1 + static_cast<std::ptrdiff_t>(col) * Matrix::kStride - col;
    from0[7] = -scale * direction[col];
    from1[3] = scale * direction[col];
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
  system_.matrix.at(rm, rm) = -(kEdgeCompliance / (dt * dt)) * scale;
  system_.rhs[rm] = -scale * (length - model_.rod.rest_length[edge]);
}

void KktAssembly::addNodeTerms(int node, const KktIterate& at)
{
  const double dt = at.dt;
  const double mass = model_.rod.mass[node];
  const Eigen::Vector3d travel = at.state.position[node] - at.begin[node];
  Eigen::Vector3d residual = mass * (travel - dt * at.state.velocity[node]);
  if (!model_.environment.gravity.isZero(0.0))
    residual -= (dt * dt * model_.immersedMass(node)) * model_.environment.gravity;
  const double damped = mass * dt * model_.environment.damping;
  residual += damped * travel;
  addDiagonal(node, mass + damped);
  resistance_.coefficient[node] = damped;
  resistance_.slide[node].setZero();
  Eigen::Vector3d velocity = at.first_solve ? at.state.velocity[node] : Eigen::Vector3d(travel / dt);
  if (at.slides != nullptr)
  {
    const MassSlide& slide = at.slides->mass[node];
    residual += mass * slide.gained;
    resistance_.slide[node] = damped * slide.travel;
    velocity += at.slides->surface[node] / dt;
  }
  if (at.wall != nullptr)
    velocity -= at.wall->displacement[node] / dt;
  const double coefficient = model_.dragCoefficient(node, velocity.norm(), at.state);
  if (coefficient != 0.0)
  {
    const double drag = dt * coefficient;
    residual += drag * travel;
    addDiagonal(node, drag);
    resistance_.coefficient[node] += drag;
    if (at.slides != nullptr)
      resistance_.slide[node] += drag * at.slides->surface[node];
  }
  if (at.wall != nullptr)
    resistance_.slide[node] -= resistance_.coefficient[node] * at.wall->displacement[node];
  if (at.slides != nullptr || at.wall != nullptr)
    residual += resistance_.slide[node];
  for (int axis = 0; axis < 3; ++axis)
    system_.rhs[system_.row(node) + axis] -= residual[axis];
}

/** Adds the drag of a stream at the velocity at the end of the step, in which it is linear. */
void KktAssembly::addStream(const NodalDrag& drag, const KktIterate& at)
{
  const int i = drag.node;
  const Eigen::Vector3d travel = at.state.position[i] - at.begin[i] + surfaceSlide(at.slides, i);
  addForce(i, drag.force(travel, at.dt), at.dt * at.dt);
  addBlock(i, at.dt * drag.coefficient);
}

/** Adds a block below the diagonal; @p row lies after @p col. */
void KktAssembly::addAcross(int row, int col, const Eigen::Matrix3d& block)
{
  for (int k = 0; k < 3; ++k)
    for (int line = 0; line < 3; ++line)
      system_.matrix.at(system_.row(row) + line, system_.row(col) + k) += block(line, k);
}

/** Adds a force on a node [N]. */
void KktAssembly::addForce(int node, const Eigen::Vector3d& force, double factor)
{
  for (int axis = 0; axis < 3; ++axis)
    system_.rhs[system_.row(node) + axis] += factor * force[axis];
}

/** Adds the potentials of the introducer's guide and of its sheath. */
void KktAssembly::addIntroducer(const KktIterate& at)
{
  configurational_force_ = 0.0;
  const double factor = at.dt * at.dt;
  const auto add = [this, factor](int edge, bool both, const GuidedEdge& term)
  {
    for (int end = 0; end < (both ? 2 : 1); ++end)
    {
      configurational_force_ += model_.boundary.direction.dot(term.gradient[end]);
      addForce(edge + end, term.gradient[end], -factor);
    }
    addBlock(edge, factor * term.first);
    if (!both)
      return;
    addBlock(edge + 1, factor * term.second);
    addAcross(edge + 1, edge, factor * term.across);
  };
  visitSheath(at.state, add);
  if (!CurvedGuide::matters(model_.rod, at.state))
  {
    guide_.forEachEdge(model_.rod, at.state, [&add](int edge, const GuidedEdge& term) { add(edge, true, term); });
    return;
  }
  curved_guide_.forEachEdge(model_.rod, model_.conditions.twistBoundary(at.state, 0.0), at.state,
                            [&](int edge, const CurvedGuideTerm& term)
                            {
                              add(edge, true, term.edge);
                              addBow(edge, term, factor);
                            });
}

/** Adds the terms of an edge's bow, which depends on the positions of four nodes. Its own second derivatives, 1/256 of
 *  those of the chord, are left out: they would couple four nodes. */
void KktAssembly::addBow(int edge, const CurvedGuideTerm& term, double factor)
{
  const std::array<double, 4>& spread = term.spread;
  for (int k = 0; k < 4; ++k)
    if (spread[k] != 0.0)
      addForce(edge - 1 + k, term.edge.by_bow.even, -factor * spread[k]);
  const Eigen::Matrix3d first = factor * term.edge.first_even;
  const Eigen::Matrix3d second = factor * term.edge.second_even;
  addBlock(edge, 2.0 * spread[1] * first);
  addBlock(edge + 1, 2.0 * spread[2] * second);
  addAcross(edge + 1, edge, spread[2] * first + spread[1] * second);
  if (spread[0] != 0.0)
  {
    addAcross(edge, edge - 1, spread[0] * first);
    addAcross(edge + 1, edge - 1, spread[0] * second);
  }
  if (spread[3] != 0.0)
  {
    addAcross(edge + 2, edge, spread[3] * first);
    addAcross(edge + 2, edge + 1, spread[3] * second);
  }
}

/** Calls visit(edge, both, term) with the terms of the sheath; both: the term acts on both nodes of the edge. */
template <typename Visit>
void KktAssembly::visitSheath(const State& state, Visit visit) const
{
  const Discretisation& rod = model_.rod;
  GuidedEdge term;
  for (int edge = state.first_node; edge < rod.nodes() && sheath_.isInside(state.position[edge]); ++edge)
  {
    if (sheath_.evaluateNode(state.position[edge], rod.cell_length[edge], term))
      visit(edge, false, term);
    if (edge + 1 < rod.nodes() && sheath_.evaluateRim(state.position[edge], state.position[edge + 1], term))
      visit(edge, true, term);
  }
}

double KktAssembly::introducerEnergy(const State& state) const
{
  double energy = 0.0;
  if (!model_.boundary.introducer)
    return energy;
  visitSheath(state, [&energy](int /*edge*/, bool /*both*/, const GuidedEdge& term) { energy += term.energy; });
  if (CurvedGuide::matters(model_.rod, state))
    curved_guide_.forEachEdge(model_.rod, model_.conditions.twistBoundary(state, 0.0), state,
                              [&energy](int /*edge*/, const CurvedGuideTerm& term) { energy += term.edge.energy; });
  else
    guide_.forEachEdge(model_.rod, state, [&energy](int /*edge*/, const GuidedEdge& term) { energy += term.energy; });
  return energy;
}

double KktAssembly::guideRestForce(const State& state) const
{
  if (!model_.boundary.introducer || !CurvedGuide::matters(model_.rod, state))
    return 0.0;
  return curved_guide_.forceAtMouth(model_.rod, model_.conditions.twistBoundary(state, 0.0), state);
}

}  // namespace endovascular_sim::rod
