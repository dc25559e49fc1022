#include "rod/mixed_twist.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMaxIterations = 200;
constexpr double kMaxTurn = 0.3;                 // rad per iteration: a snap-through is followed, not jumped over
constexpr double kConverged = 1e-8;              // rad
constexpr double kRigid = 1e-6;                  // of an edge's twist flexibility, where the hand turns it
constexpr double kGauss = 0.288675134594812882;  // √3/6: of an edge's length, from its middle

/** v turned by the rotation vector w. */
Vector3d turned(const Vector3d& v, const Vector3d& w)
{
  const double square = w.squaredNorm();
  double s, c;  // sin φ/φ and (1 − cos φ)/φ²
  if (square < 0.04)
  {
    s = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)));
    c = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0)));
  }
  else
  {
    const double angle = std::sqrt(square);
    s = std::sin(angle) / angle;
    c = (1.0 - std::cos(angle)) / square;
  }
  const Vector3d across = w.cross(v);
  return v + s * across + c * w.cross(across);
}

}  // namespace

bool MixedTwist::matters(const MixedRod& rod, double tip_torque)
{
  return tip_torque != 0.0 || std::any_of(rod.edges().begin(), rod.edges().end(),
                                          [](const MixedEdge& edge) { return !edge.material_curvature.isZero(0.0); });
}

void MixedTwist::transportBishopFrame(const MixedRod& rod, const TwistBoundary& boundary, const State& state)
{
  Vector3d tangent = boundary.tangent;
  Vector3d director = boundary.director;
  double begin = 0.0;
  for (int j = 0; j + 1 < rod.nodes(); ++j)
  {
    const MixedEdge& edge = rod.edges()[j];
    if (j >= first_)
    {
      const Vector3d next = (state.position[j + 1] - state.position[j]).normalized();
      director -= (director.dot(next) / (1.0 + tangent.dot(next))) * (tangent + next);
      tangent = next;
      edges_[j].tangent = tangent;
      edges_[j].bishop = director;
      edges_[j].bishop_normal = tangent.cross(director);
      const double share = (begin + edge.length - boundary.position) / edge.length;
      edges_[j].share = std::max(0.0, std::min(1.0, share));
      edges_[j].flexibility = edge.twist_flexibility * std::max(kRigid, edges_[j].share);
    }
    begin += edge.length;
  }
}

/** κ̄ at the Gauss points and at the ends of an edge, for the present angle, torque and moments. */
void MixedTwist::placeRestCurvature(const MixedRod& rod, const State& state, int j)
{
  const MixedEdge& edge = rod.edges()[j];
  Edge& e = edges_[j];
  if (edge.material_curvature.isZero(0.0) || e.share == 0.0)
  {
    e.gauss = e.end = {Vector3d::Zero(), Vector3d::Zero()};
    e.turn.setZero();
    return;
  }
  const double c = std::cos(state.twist_angle[j]);
  const double s = std::sin(state.twist_angle[j]);
  const Vector3d m1 = c * e.bishop + s * e.bishop_normal;
  const Vector3d m2 = c * e.bishop_normal - s * e.bishop;
  const Vector3d middle = e.share * (edge.material_curvature.x() * m2 - edge.material_curvature.y() * m1);
  const Vector3d bend = 0.5 * edge.flexibility * (state.moment[j] + state.moment[j + 1]) + middle;
  e.turn = kGauss * edge.length * bend;
  const double twist = 0.5 * e.flexibility * (torque_[j] + torque_[j + 1]);
  const Vector3d twisted = (kGauss * edge.length * twist) * e.tangent;
  e.gauss = {turned(turned(middle, -twisted), -e.turn), turned(turned(middle, twisted), e.turn)};
  extrapolate(e);
}

/** κ̄ at the ends, linear through the Gauss points. */
void MixedTwist::extrapolate(Edge& edge)
{
  const Vector3d mean = 0.5 * (edge.gauss[0] + edge.gauss[1]);
  const Vector3d slope = (3.0 * kGauss) * (edge.gauss[1] - edge.gauss[0]);
  edge.end = {mean - slope, mean + slope};
}

/** κ at the edges' ends from moment and rest curvature. At a node the torque acts along the chords' bisector, not the
 *  curve's tangent: M there is the bending moment less the torque times their difference. */
void MixedTwist::findCurvature(const MixedRod& rod, const State& state)
{
  const int last = rod.nodes() - 2;
  for (int j = first_; j <= last; ++j)
    for (int side = 0; side < 2; ++side)
    {
      edges_[j].curvature[side] = rod.edges()[j].flexibility * state.moment[j + side] + edges_[j].end[side];
    }
  for (int i = first_; i <= last; ++i)
  {
    Edge& after = edges_[i];
    const Vector3d before_tangent = i > first_ ? edges_[i - 1].tangent : rod.proximal().tangent;
    Vector3d tangent = before_tangent;
    if (i > first_)
    {
      const Edge& before = edges_[i - 1];
      tangent =
          0.5 *
          (turned(before.tangent, rod.edges()[i - 1].length / 6.0 * (before.curvature[0] + 2.0 * before.curvature[1])) +
           turned(after.tangent, -rod.edges()[i].length / 6.0 * (2.0 * after.curvature[0] + after.curvature[1])));
    }
    Vector3d apart = (before_tangent + after.tangent) / (1.0 + before_tangent.dot(after.tangent)) - tangent;
    apart = torque_[i] * (apart - apart.dot(tangent) * tangent);
    corrections_[i] = apart;
  }
  for (int j = first_; j <= last; ++j)
  {
    edges_[j].curvature[0] += rod.edges()[j].flexibility * corrections_[j];
    if (j < last)
      edges_[j].curvature[1] += rod.edges()[j].flexibility * corrections_[j + 1];
  }
}

/** C_i; adds −T_i ∂C_i/∂κ to the ends of the edges around the node. */
double MixedTwist::holonomy(const MixedRod& rod, int node)
{
  const double torque = torque_[node];
  Edge& after = edges_[node];
  const double hb = rod.edges()[node].length;
  const Vector3d& k1 = after.curvature[0];
  const Vector3d& k2 = after.curvature[1];
  const double b = hb * hb / 48.0;
  if (node == first_)
  {
    const Vector3d& t = after.tangent;
    after.by_end[0] -= torque * b * k2.cross(t);
    after.by_end[1] -= torque * b * t.cross(k1);
    return b * t.dot(k1.cross(k2));
  }
  Edge& before = edges_[node - 1];
  const double ha = rod.edges()[node - 1].length;
  const Vector3d t = (before.tangent + after.tangent).normalized();
  const Vector3d& k0 = before.curvature[1];
  const Vector3d& km = before.curvature[0];
  const double a = ha * ha / 48.0;
  const double d = ha * hb / 24.0;
  before.by_end[0] += torque * t.cross(a * k0 + d * k1);
  before.by_end[1] -= torque * (d * (k2 + k1) - a * km).cross(t);
  after.by_end[0] -= torque * ((b * k2 - d * km).cross(t) + d * t.cross(k0));
  after.by_end[1] -= torque * t.cross(b * k1 + d * k0);
  return t.dot(-a * k0.cross(km) + b * k1.cross(k2) + d * (k0.cross(k2) - k1.cross(km) + k0.cross(k1)));
}

/** Derivatives of L by rotations of the edges' frames. */
void MixedTwist::evaluate(const MixedRod& rod, const State& state)
{
  for (int j = first_; j + 1 < rod.nodes(); ++j)
    edges_[j].by_end = {Vector3d::Zero(), Vector3d::Zero()};
  for (int i = first_; i + 1 < rod.nodes(); ++i)
    rhs_[2 * (i - first_)] = holonomy(rod, i);
  for (int j = first_; j + 1 < rod.nodes(); ++j)
  {
    const MixedEdge& edge = rod.edges()[j];
    Edge& e = edges_[j];
    const double h = edge.length;
    const Vector3d& k0 = e.curvature[0];
    const Vector3d& k1 = e.curvature[1];
    const Vector3d middle = 0.5 * (k0 + k1);
    const Vector3d across = kGauss * (k1 - k0);
    const double weight = -0.5 * h / edge.flexibility;
    const Vector3d first = weight * e.gauss[0].cross(middle - across);
    const Vector3d second = weight * e.gauss[1].cross(middle + across);
    const double pull = state.tension[j] * h * h * h / 720.0;
    // A turn of the chord's frame turns the Gauss points' frames about their own tangents.
    e.spin = turned(first, e.turn) + turned(second, -e.turn) +
             e.end[0].cross(pull * (16.0 * k0 + 14.0 * k1) + e.by_end[0]) +
             e.end[1].cross(pull * (14.0 * k0 + 16.0 * k1) + e.by_end[1]);
  }
}

/** One Newton step for torques and angles, left in rhs_. */
void MixedTwist::solve(const MixedRod& rod, const TwistBoundary& boundary, const State& state)
{
  const int last = rod.nodes() - 2;
  matrix_.reset(2 * (last + 1 - first_));
  rhs_.assign(static_cast<std::size_t>(matrix_.size()), 0.0);
  evaluate(rod, state);
  double angle = boundary.rotation;
  for (int j = first_; j <= last; ++j)
  {
    const int rt = 2 * (j - first_);
    const Edge& e = edges_[j];
    const double h = rod.edges()[j].length;
    const double third = h * e.flexibility / 3.0;
    // rhs_ holds −∂L: by T_j the twist that is missing, by θ^j the torque that is not balanced.
    rhs_[rt] += angle - state.twist_angle[j] + third * (torque_[j] + 0.5 * torque_[j + 1]);
    rhs_[rt + 1] = torque_[j + 1] - torque_[j] - e.spin.dot(e.tangent);
    matrix_.at(rt, rt) -= third;
    matrix_.at(rt + 1, rt) += 1.0;
    const double weight = 0.5 * h / rod.edges()[j].flexibility;
    const double stiffness = weight * (e.gauss[0] + e.gauss[1]).dot(0.5 * (e.curvature[0] + e.curvature[1]));
    matrix_.at(rt + 1, rt + 1) += std::max(0.0, stiffness);
    if (j < last)
    {
      rhs_[rt + 2] += third * (torque_[j + 1] + 0.5 * torque_[j]);
      matrix_.at(rt + 2, rt + 2) -= third;
      matrix_.at(rt + 2, rt) -= 0.5 * third;
      matrix_.at(rt + 2, rt + 1) -= 1.0;
    }
    angle = state.twist_angle[j];
  }
  if (!boundary.held)
  {
    matrix_.prescribe(0, -torque_[first_], -1.0, rhs_);
    // The tiny term keeps the matrix regular where nothing holds the twist.
    matrix_.at(1, 1) += 1e-9 / (rod.length() * edges_[first_].flexibility);
  }
  matrix_.factorise();
  matrix_.solve(rhs_);
}

void MixedTwist::relax(MixedRod& rod, const TwistBoundary& boundary, State& state)
{
  const int n = rod.nodes();
  first_ = state.first_node;
  edges_.resize(static_cast<std::size_t>(n));
  corrections_.resize(static_cast<std::size_t>(n));
  rhs_.assign(static_cast<std::size_t>(2 * (n - first_)), 0.0);
  torque_.assign(static_cast<std::size_t>(n), boundary.tip_torque);
  transportBishopFrame(rod, boundary, state);
  // The torque that the angles as they are would have in equilibrium, then the curvature that belongs to both and to
  // the moments.
  for (int pass = 0; pass < 2; ++pass)
  {
    for (int j = first_; j + 1 < n; ++j)
      placeRestCurvature(rod, state, j);
    findCurvature(rod, state);
    if (pass == 0)
      evaluate(rod, state);
    for (int j = n - 2; pass == 0 && j >= first_; --j)
      torque_[j] = torque_[j + 1] - edges_[j].spin.dot(edges_[j].tangent);
  }
  for (int iteration = 0; iteration < kMaxIterations; ++iteration)
  {
    solve(rod, boundary, state);
    double largest = 0.0;
    for (int j = first_; j + 1 < n; ++j)
      largest = std::max(largest, std::abs(rhs_[2 * (j - first_) + 1]));
    const double scale = largest > kMaxTurn ? kMaxTurn / largest : 1.0;
    for (int j = first_; j + 1 < n; ++j)
    {
      torque_[j] += scale * rhs_[2 * (j - first_)];
      state.twist_angle[j] += scale * rhs_[2 * (j - first_) + 1];
    }
    for (int j = first_; j + 1 < n; ++j)
      placeRestCurvature(rod, state, j);
    if (largest < kConverged || !(largest < 1e300))
      break;
  }
  rhs_.resize(static_cast<std::size_t>(2 * (n - first_)));
  evaluate(rod, state);
  state.hand_torque = boundary.held ? -torque_[first_] : 0.0;
  for (int j = first_; j + 1 < n; ++j)
    rod.edge(j).rest_curvature = edges_[j].end;
}

void MixedTwist::assemble(const MixedRod& rod, const State& state, std::vector<double>& gradient,
                          MixedRod::Matrix& hessian) const
{
  for (int j = first_; j + 1 < rod.nodes(); ++j)
  {
    const MixedEdge& edge = rod.edges()[j];
    const Edge& e = edges_[j];
    const double inverse = 1.0 / (state.position[j + 1] - state.position[j]).norm();
    const int x0 = rod.positionRow(state, j);
    const int x1 = rod.positionRow(state, j + 1);
    Vector3d force = inverse * e.spin.cross(e.tangent);
    // Gradient of the twist by the centreline (Bergou et al. 2010, eq. 7): ∂m/∂e = κb/(2|e|) for both edges.
    const Vector3d before = j == first_ ? rod.proximal().tangent : edges_[j - 1].tangent;
    const bool turns = j > first_ || rod.proximal().hold == EndHold::kClamped;
    if (turns)
      force += (torque_[j] * inverse / (1.0 + before.dot(e.tangent))) * before.cross(e.tangent);
    if (j + 2 < rod.nodes())
      force += (torque_[j + 1] * inverse / (1.0 + e.tangent.dot(edges_[j + 1].tangent))) *
               e.tangent.cross(edges_[j + 1].tangent);
    if (j + 2 == rod.nodes())
    {
      // The torque at the tip acts about the tip's tangent: the chord turned by the end slope of the bow, whose
      // curvature is parabolic.
      const double h = edge.length;
      const Vector3d slope = (e.curvature[1] - e.curvature[0]) / h;
      Vector3d turn = (h / 6.0) * (e.curvature[0] + 2.0 * e.curvature[1]);
      if (j > first_)
      {
        const double before_h = rod.edges()[j - 1].length;
        const Vector3d before_slope = (edges_[j - 1].curvature[1] - edges_[j - 1].curvature[0]) / before_h;
        turn -= (h * h * h / (12.0 * (h + before_h))) * (slope - before_slope);
      }
      force += (torque_[j + 1] * inverse) * (turn - turn.dot(e.tangent) * e.tangent);
      const Vector3d moment = (torque_[j + 1] * edge.length * edge.flexibility / 12.0) * e.tangent.cross(turn);
      for (int axis = 0; axis < 3; ++axis)
        gradient[static_cast<std::size_t>(rod.momentRow(state, j) + axis)] += moment[axis];
    }
    for (int side = 0; side < 2; ++side)
    {
      const int rm = rod.momentRow(state, j + side);
      const Vector3d moment = edge.flexibility * e.by_end[side];
      // The rest curvature stays across the chord: ∂²L/∂M∂e = t (∫hat κ̄)ᵀ/|e|.
      const Vector3d rest =
          (edge.length * inverse / 6.0) * (edge.rest_curvature[0] + edge.rest_curvature[1] + edge.rest_curvature[side]);
      const Vector3d across = rest - rest.dot(e.tangent) * e.tangent;
      for (int row = 0; row < 3; ++row)
      {
        gradient[static_cast<std::size_t>(rm + row)] += moment[row];
        for (int col = 0; col < 3; ++col)
        {
          hessian.at(rm + row, x0 + col) -= e.tangent[row] * across[col];
          if (side == 0)
            hessian.at(x1 + col, rm + row) += e.tangent[row] * across[col];
          else
            hessian.at(rm + row, x1 + col) += e.tangent[row] * across[col];
        }
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      gradient[static_cast<std::size_t>(x0 + axis)] -= force[axis];
      gradient[static_cast<std::size_t>(x1 + axis)] += force[axis];
    }
  }
}

double MixedTwist::energy(const MixedRod& rod, const State& state) const
{
  double sum = 0.0;
  for (int j = state.first_node; j + 1 < rod.nodes(); ++j)
  {
    const double a = torque_[j];
    const double b = torque_[j + 1];
    sum += rod.edges()[j].length * edges_[j].flexibility / 6.0 * (a * a + a * b + b * b);
  }
  return sum;
}

}  // namespace endovascular_sim::rod
