#include "rod/mixed/mixed_rod.h"

#include <algorithm>
#include <cmath>

#include "rod/model/turning_angle.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

// ∫y² over an edge whose deflection from the chord has y″ = κ: h⁵ (2/945 (|κ_j|² + |κ_{j+1}|²) + 31/7560 κ_j·κ_{j+1})
constexpr double kBowSame = 2.0 / 945.0;
constexpr double kBowOther = 31.0 / 7560.0;

/** Adds a block below the diagonal, its first entry at (row, col), row > col + 2. */
void addOffDiagonal(MixedRod::Matrix& matrix, int row, int col, const Matrix3d& block)
{
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      matrix.at(row + r, col + c) += block(r, c);
}

/** Adds the lower triangle of a symmetric block on the diagonal. */
void addDiagonal(MixedRod::Matrix& matrix, int row, const Matrix3d& block)
{
  for (int c = 0; c < 3; ++c)
    for (int r = c; r < 3; ++r)
      matrix.at(row + r, row + c) += block(r, c);
}

void add(std::vector<double>& vector, int row, const Vector3d& value)
{
  for (int axis = 0; axis < 3; ++axis)
    vector[static_cast<std::size_t>(row) + static_cast<std::size_t>(axis)] += value[axis];
}

/** Curvatures at an edge's ends [1/m]. */
struct EndCurvatures
{
  Vector3d first, second;

  EndCurvatures(const MixedEdge& edge, const Vector3d& m0, const Vector3d& m1)
    : first(edge.flexibility * m0 + edge.rest_curvature[0]), second(edge.flexibility * m1 + edge.rest_curvature[1])
  {
  }

  /** s of the class comment [m]. */
  double shortening(double h) const
  {
    return h * h * h * (8.0 * first.squaredNorm() + 14.0 * first.dot(second) + 8.0 * second.squaredNorm()) / 720.0;
  }

  /** b of the class comment [m/N]. */
  double bowCompliance(const MixedEdge& edge) const
  {
    const double h = edge.length;
    return h * h * h * h * h * edge.flexibility *
           (kBowSame * (first.squaredNorm() + second.squaredNorm()) + kBowOther * first.dot(second));
  }
};

}  // namespace

std::vector<MixedEdge> mixedEdges(const Wire& wire, const std::vector<double>& position)
{
  std::vector<MixedEdge> edges(position.size() - 1);
  for (std::size_t j = 0; j < edges.size(); ++j)
  {
    edges[j].length = position[j + 1] - position[j];
    double begin = 0.0;
    for (const Section& section : wire.sections)
    {
      const double end = begin + section.length;
      const double share =
          std::max(0.0, std::min(end, position[j + 1]) - std::max(begin, position[j])) / edges[j].length;
      edges[j].flexibility += share / section.bending_stiffness;
      edges[j].axial_compliance += share / section.axial_stiffness;
      edges[j].twist_flexibility += share / section.torsional_stiffness;
      edges[j].material_curvature += share * section.rest_curvature;
      edges[j].cross_section += share * M_PI * section.radius * section.radius;
      edges[j].linear_density += share * section.density * M_PI * section.radius * section.radius;
      begin = end;
    }
  }
  return edges;
}

MixedRod::MixedRod(std::vector<MixedEdge> edges, MixedEnd proximal, MixedEnd distal)
  : edges_(std::move(edges)), proximal_(std::move(proximal)), distal_(std::move(distal))
{
}

double MixedRod::length() const
{
  double sum = 0.0;
  for (const MixedEdge& edge : edges_)
    sum += edge.length;
  return sum;
}

State MixedRod::straight(const Vector3d& origin, const Vector3d& direction) const
{
  State state;
  const auto n = static_cast<std::size_t>(nodes());
  state.position.assign(n, origin);
  for (std::size_t i = 1; i < n; ++i)
    state.position[i] = state.position[i - 1] + edges_[i - 1].length * direction;
  state.velocity.assign(n, Vector3d::Zero());
  state.moment.assign(n, Vector3d::Zero());
  state.wall_force.assign(n, Vector3d::Zero());
  state.friction_coefficient.assign(n, 0.0);
  state.wall_offset.assign(n, 0.0);
  state.curvature_offset.assign(n, Eigen::Vector3d::Zero());
  state.friction_stretch.assign(n, Vector3d::Zero());
  state.tension.assign(n - 1, 0.0);
  state.twist_angle.assign(n - 1, 0.0);
  return state;
}

bool MixedRod::turnsFreely(const State& state, int node) const
{
  return (node == state.first_node && proximal_.hold != EndHold::kClamped) ||
         (node + 1 == nodes() && distal_.hold != EndHold::kClamped);
}

Vector3d MixedRod::chordBefore(const State& state, int node) const
{
  return node == state.first_node ? proximal_.tangent : Vector3d(state.position[node] - state.position[node - 1]);
}

Vector3d MixedRod::chordAfter(const State& state, int node) const
{
  return node + 1 == nodes() ? distal_.tangent : Vector3d(state.position[node + 1] - state.position[node]);
}

void MixedRod::assemble(const State& state, std::vector<double>& gradient, Matrix& hessian) const
{
  Chord before, after;
  for (int i = state.first_node; i < nodes(); ++i)
  {
    after = Chord();
    if (!turnsFreely(state, i))
      assembleNode(state, i, before, after, gradient, hessian);
    if (i > state.first_node)
      scatter(state, i - 1, before, gradient, hessian);
    if (i + 1 == nodes())
      break;
    assembleEdge(state, i, after, gradient, hessian);
    if (!edges_[i].load.isZero(0.0))
      assembleBow(state, i, after, gradient, hessian);
    before = after;
  }
}

/** Adds derivatives by the chord x_{j+1} − x_j to the rows of both nodes. */
void MixedRod::scatter(const State& state, int j, const Chord& chord, std::vector<double>& gradient, Matrix& hessian)
{
  const int first = positionRow(state, j);
  const int second = positionRow(state, j + 1);
  add(gradient, first, -chord.force);
  add(gradient, second, chord.force);
  addDiagonal(hessian, first, chord.hessian);
  addDiagonal(hessian, second, chord.hessian);
  addOffDiagonal(hessian, second, first, -chord.hessian);
}

/** Adds the terms of M_i·Φ_i. */
void MixedRod::assembleNode(const State& state, int node, Chord& before, Chord& after, std::vector<double>& gradient,
                            Matrix& hessian) const
{
  const TurningAngle phi(chordBefore(state, node), chordAfter(state, node));
  const Vector3d& m = state.moment[node];
  const TurningHessian h(phi, m);
  const int rm = momentRow(state, node);
  const int r1 = positionRow(state, node);
  add(gradient, rm, phi.value);
  const bool has_before = node > state.first_node;
  const bool has_after = node + 1 < nodes();
  if (has_before)
  {
    const int r0 = positionRow(state, node - 1);
    before.force += phi.transposeBefore(m);
    const Matrix3d by_before = phi.byBefore();
    before.hessian += h.before_before;
    addOffDiagonal(hessian, rm, r0, -by_before);
    addOffDiagonal(hessian, rm, r1, by_before);
  }
  if (has_after)
  {
    const int r2 = positionRow(state, node + 1);
    after.force += phi.transposeAfter(m);
    const Matrix3d by_after = phi.byAfter();
    after.hessian += h.after_after;
    addOffDiagonal(hessian, rm, r1, -by_after);
    addOffDiagonal(hessian, r2, rm, by_after.transpose());
  }
  if (has_before && has_after)
  {
    const int r0 = positionRow(state, node - 1);
    const int r2 = positionRow(state, node + 1);
    const Matrix3d across = h.before_after.transpose();
    addOffDiagonal(hessian, r1, r0, across);
    addOffDiagonal(hessian, r2, r0, -across);
    addOffDiagonal(hessian, r2, r1, across);
    addDiagonal(hessian, r1, -(h.before_after + across));
  }
}

/** Adds the terms of flexibility, rest curvature and arc length of an edge. */
void MixedRod::assembleEdge(const State& state, int j, Chord& chord, std::vector<double>& gradient,
                            Matrix& hessian) const
{
  const MixedEdge& edge = edges_[j];
  const double h = edge.length;
  const double c = edge.flexibility;
  const double tension = state.tension[j];
  const Vector3d& m0 = state.moment[j];
  const Vector3d& m1 = state.moment[j + 1];
  const Vector3d& k0 = edge.rest_curvature[0];
  const Vector3d& k1 = edge.rest_curvature[1];
  const EndCurvatures kappa(edge, m0, m1);
  const Vector3d span = state.position[j + 1] - state.position[j];
  const double chord_length = span.norm();
  const Vector3d t = span / chord_length;
  const int x0 = positionRow(state, j);
  const int x1 = positionRow(state, j + 1);
  const int r0 = momentRow(state, j);
  const int r1 = momentRow(state, j + 1);
  const int rt = tensionRow(state, j);
  const double cube = h * h * h * c / 720.0;
  const Vector3d s0 = cube * (16.0 * kappa.first + 14.0 * kappa.second);
  const Vector3d s1 = cube * (14.0 * kappa.first + 16.0 * kappa.second);
  const double fifth = tension * h * h * h * h * h * c * c;
  const Vector3d b0 = fifth * (2.0 * kBowSame * kappa.first + kBowOther * kappa.second);
  const Vector3d b1 = fifth * (kBowOther * kappa.first + 2.0 * kBowSame * kappa.second);
  const double compliance = h * edge.axial_compliance + kappa.bowCompliance(edge);
  add(gradient, r0, -(h / 6.0) * (c * (2.0 * m0 + m1) + 2.0 * k0 + k1) + tension * (s0 - 0.5 * b0));
  add(gradient, r1, -(h / 6.0) * (c * (m0 + 2.0 * m1) + k0 + 2.0 * k1) + tension * (s1 - 0.5 * b1));
  chord.force += tension * t;
  gradient[rt] += chord_length - h + kappa.shortening(h) - tension * compliance;

  const double same = -h * c / 3.0 + 16.0 * tension * cube * c - kBowSame * tension * fifth * c;
  const double other = -h * c / 6.0 + 14.0 * tension * cube * c - 0.5 * kBowOther * tension * fifth * c;
  for (int axis = 0; axis < 3; ++axis)
  {
    hessian.at(r0 + axis, r0 + axis) += same;
    hessian.at(r1 + axis, r1 + axis) += same;
    hessian.at(r1 + axis, r0 + axis) += other;
    hessian.at(rt, r0 + axis) += s0[axis] - b0[axis];
    hessian.at(rt, r1 + axis) += s1[axis] - b1[axis];
    hessian.at(rt, x0 + axis) -= t[axis];
    hessian.at(rt, x1 + axis) += t[axis];
  }
  hessian.at(rt, rt) -= compliance;
  const double pull = tension / chord_length;
  chord.hessian.noalias() -= (pull * t) * t.transpose();
  chord.hessian.diagonal().array() += pull;
}

/** Adds the work of the distributed force on the chord, and on the bow between chord and arc. */
void MixedRod::assembleBow(const State& state, int j, Chord& chord, std::vector<double>& gradient,
                           Matrix& hessian) const
{
  const MixedEdge& edge = edges_[j];
  const double h = edge.length;
  const EndCurvatures kappa(edge, state.moment[j], state.moment[j + 1]);
  const Vector3d span = state.position[j + 1] - state.position[j];
  const double inverse = 1.0 / span.norm();
  const Vector3d t = span * inverse;
  const int x0 = positionRow(state, j);
  const int x1 = positionRow(state, j + 1);
  const int r0 = momentRow(state, j);
  const int r1 = momentRow(state, j + 1);
  const double weight = h * h * h / 24.0;
  const Vector3d a = weight * edge.load.cross(kappa.first + kappa.second);  // the bow's work is −a·t
  chord.force += inverse * (a - a.dot(t) * t);
  add(gradient, x0, -(0.5 * h) * edge.load);
  add(gradient, x1, -(0.5 * h) * edge.load);
  const Vector3d by_moment = (weight * edge.flexibility) * t.cross(edge.load);
  add(gradient, r0, by_moment);
  add(gradient, r1, by_moment);

  chord.hessian += hessianByEdge(t, inverse, a, Vector3d::Zero(), Vector3d::Zero());
  const double factor = weight * edge.flexibility * inverse;
  Matrix3d mixed = (factor * edge.load.cross(t)) * t.transpose();  // ∂²/∂M∂e = −w c [q]× (I − ttᵀ)/|e|
  TurningAngle::addCross(mixed, -factor, edge.load);
  addOffDiagonal(hessian, r0, x0, -mixed);
  addOffDiagonal(hessian, x1, r0, mixed.transpose());
  addOffDiagonal(hessian, r1, x0, -mixed);
  addOffDiagonal(hessian, r1, x1, mixed);
}

void MixedRod::prescribe(int first_row, double pivot, Matrix& matrix, std::vector<double>& rhs)
{
  for (int axis = 0; axis < 3; ++axis)
    matrix.prescribe(first_row + axis, 0.0, pivot, rhs);
}

void MixedRod::prescribeEnds(const State& state, Matrix& matrix, std::vector<double>& rhs) const
{
  const int first = state.first_node;
  const int last = nodes() - 1;
  if (proximal_.hold != EndHold::kFree)
    prescribe(positionRow(state, first), 1.0, matrix, rhs);
  if (distal_.hold != EndHold::kFree)
    prescribe(positionRow(state, last), 1.0, matrix, rhs);
  for (const int node : {first, last})
    if (turnsFreely(state, node))
      prescribe(momentRow(state, node), -1.0, matrix, rhs);
}

double MixedRod::strain(const State& state, int j) const
{
  const MixedEdge& edge = edges_[j];
  const double h = edge.length;
  const EndCurvatures kappa(edge, state.moment[j], state.moment[j + 1]);
  const double chord = (state.position[j + 1] - state.position[j]).norm();
  const double compliance = h * edge.axial_compliance + kappa.bowCompliance(edge);
  return (chord + kappa.shortening(h) - state.tension[j] * compliance) / h - 1.0;
}

double MixedRod::bendingEnergy(const State& state) const
{
  double sum = 0.0;
  for (int j = state.first_node; j + 1 < nodes(); ++j)
  {
    const MixedEdge& edge = edges_[j];
    const double h = edge.length;
    const double c = edge.flexibility;
    const Vector3d& m0 = state.moment[j];
    const Vector3d& m1 = state.moment[j + 1];
    sum += h * c / 6.0 * (m0.squaredNorm() + m0.dot(m1) + m1.squaredNorm());
    // Between the nodes the moment deviates by that of tension and load about the bow.
    const EndCurvatures kappa(edge, m0, m1);
    const Vector3d t = (state.position[j + 1] - state.position[j]).normalized();
    const Vector3d pull = (h * h * h / 720.0 * state.tension[j]) * (16.0 * kappa.first + 14.0 * kappa.second);
    const Vector3d pull1 = (h * h * h / 720.0 * state.tension[j]) * (14.0 * kappa.first + 16.0 * kappa.second);
    const Vector3d weight = (h * h * h / 24.0) * t.cross(edge.load);
    sum -= c * (m0.dot(pull + weight) + m1.dot(pull1 + weight));
  }
  return sum;
}

}  // namespace endovascular_sim::rod
