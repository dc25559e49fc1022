#include "rod/mixed/mixed_twist.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "rod/model/rod_edge_frames.h"
#include "rod/model/turning_angle.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMaxIterations = 200;
constexpr double kMaxTurn = 0.3;     // rad per iteration, so that a snap-through ends in the next minimum
constexpr double kConverged = 1e-8;  // rad
constexpr double kRigid = 1e-6;      // factor on the twist flexibility of edges that turn with the handle
constexpr int kTipPasses = 3;        // on the direction of a torque at the tip; each reduces the error by T h/(3EI)

Vector3d across(const Vector3d& v, const Vector3d& axis)
{
  return v - v.dot(axis) * axis;
}

/** Turning angle vector between unit vectors [rad]. */
Vector3d turnBetween(const Vector3d& from, const Vector3d& to)
{
  return AngleOverSine(std::max(TurningAngle::kFolded, from.dot(to))).value * from.cross(to);
}

void add(std::vector<double>& vector, int row, const Vector3d& value)
{
  for (int axis = 0; axis < 3; ++axis)
    vector[static_cast<std::size_t>(row) + static_cast<std::size_t>(axis)] += value[axis];
}

/** Part of an edge's twist at one of its ends, from the torques at both ends [rad]. */
double twistOfEdge(double h, double flexibility, double near, double far)
{
  return h * flexibility / 6.0 * (2.0 * near + far);
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
      Edge& e = edges_[j];
      const Vector3d chord = state.position[j + 1] - state.position[j];
      e.inverse = 1.0 / chord.norm();
      const Vector3d next = e.inverse * chord;
      director -= (director.dot(next) / (1.0 + tangent.dot(next))) * (tangent + next);
      tangent = next;
      e.tangent = tangent;
      e.bishop = director;
      e.bishop_normal = tangent.cross(director);
      e.share = std::max(0.0, std::min(1.0, (begin + edge.length - boundary.position) / edge.length));
      e.flexibility = edge.twist_flexibility * std::max(kRigid, e.share);
      e.rest_curvature = e.share * Vector3d(-edge.material_curvature.y(), edge.material_curvature.x(), 0.0);
      e.angle = state.twist_angle[j];
      e.load_torque = 0.0;
    }
    begin += edge.length;
  }
}

/** Computes τ, a weighted mean of the chords' directions: the tangent up to terms of the order h². */
void MixedTwist::findAxes(const MixedRod& rod, const State& state)
{
  const int last = rod.nodes() - 1;
  for (int i = first_ + 1; i < last; ++i)
    axis_[i] =
        (rod.edges()[i].length * edges_[i - 1].tangent + rod.edges()[i - 1].length * edges_[i].tangent).normalized();
  axis_[first_] = rod.proximal().hold == EndHold::kClamped ? rod.proximal().tangent : edges_[first_].tangent;
  if (rod.distal().hold == EndHold::kClamped)
  {
    axis_[last] = rod.distal().tangent;
    return;
  }
  axis_[last] = edges_[last - 1].tangent;
  moment_[last] = torque_[last] * axis_[last];
  for (int pass = 0; torque_[last] != 0.0 && pass < kTipPasses; ++pass)
  {
    moment_[last - 1] = state.moment[last - 1] + torque_[last] * axis_[last - 1];
    shapeEdge(rod, state, last - 1);
    axis_[last] = edges_[last - 1].end[1].col(2);
    moment_[last] = torque_[last] * axis_[last];
  }
}

/** Computes T from the balance of moments about the chords, from the tip on. */
void MixedTwist::findTorque(const State& state, double tip_torque)
{
  const int last = static_cast<int>(state.position.size()) - 1;
  torque_[last] = tip_torque;
  for (int j = last - 1; j >= first_; --j)
  {
    const Vector3d& u = edges_[j].tangent;
    const double bending = (state.moment[j + 1] - state.moment[j]).dot(u) - edges_[j].load_torque;
    torque_[j] = (torque_[j + 1] * axis_[j + 1].dot(u) + bending) / axis_[j].dot(u);
    edges_[j].rise = torque_[j + 1] - torque_[j];
  }
}

void MixedTwist::findMoments(const MixedRod& rod, const State& state)
{
  for (int i = first_; i < rod.nodes(); ++i)
    moment_[i] = state.moment[i] + torque_[i] * axis_[i];
}

/** Computes the material frames at the ends of an edge and the curvature in its middle. */
void MixedTwist::shapeEdge(const MixedRod& rod, const State& state, int j)
{
  const MixedEdge& edge = rod.edges()[j];
  Edge& e = edges_[j];
  const double c = std::cos(state.twist_angle[j]);
  const double s = std::sin(state.twist_angle[j]);
  Matrix3d frame;
  frame << c * e.bishop + s * e.bishop_normal, c * e.bishop_normal - s * e.bishop, e.tangent;
  EdgeLoad load;
  load.length = edge.length;
  load.flexibility = edge.flexibility;
  load.twist_flexibility = e.flexibility;
  load.rest_curvature = e.rest_curvature;
  load.tension = state.tension[j];
  load.load = frame.transpose() * edge.load;
  load.moment = {frame.transpose() * moment_[j], frame.transpose() * moment_[j + 1]};
  const RodEdgeFrames shape(load);
  e.end = {frame * shape.turn[0], frame * shape.turn[1]};
  e.curvature = frame * shape.curvature;
  e.energy.bending = shape.bending_energy;
  e.energy.twist = shape.twist_energy;
}

/** Angle about the tangent from the frame before a node to the frame after it, without full turns [rad]. */
double MixedTwist::twistMismatch(const TwistBoundary& boundary, int node) const
{
  const Matrix3d& after = edges_[node].end[0];
  Vector3d tangent, director;
  if (node > first_)
  {
    tangent = edges_[node - 1].end[1].col(2);
    director = edges_[node - 1].end[1].col(0);
  }
  else
  {
    tangent = boundary.tangent;
    director = std::cos(boundary.rotation) * boundary.director +
               std::sin(boundary.rotation) * boundary.tangent.cross(boundary.director);
  }
  director -= (director.dot(after.col(2)) / (1.0 + tangent.dot(after.col(2)))) * (tangent + after.col(2));
  return std::atan2(director.cross(after.col(0)).dot(after.col(2)), director.dot(after.col(0)));
}

/** Twist at a node by the angles of its edges less that by the torques [rad]. */
double MixedTwist::twistBetween(const MixedRod& rod, const State& state, int node) const
{
  double twist = state.twist_angle[node] - (node > first_ ? state.twist_angle[node - 1] : angle_before_);
  twist -= twistOfEdge(rod.edges()[node].length, edges_[node].flexibility, torque_[node], torque_[node + 1]);
  if (node > first_)
    twist -= twistOfEdge(rod.edges()[node - 1].length, edges_[node - 1].flexibility, torque_[node], torque_[node - 1]);
  return twist;
}

/** Computes one Newton step of torques and angles, in rhs_. */
void MixedTwist::solve(const MixedRod& rod, const TwistBoundary& boundary, const State& state)
{
  const int last = rod.nodes() - 2;
  matrix_.reset(2 * (last + 1 - first_));
  rhs_.assign(static_cast<std::size_t>(matrix_.size()), 0.0);
  for (int j = first_; j <= last; ++j)
  {
    const int rt = 2 * (j - first_);
    const Edge& e = edges_[j];
    const double third = rod.edges()[j].length * e.flexibility / 3.0;
    const double turn = state.twist_angle[j] - e.angle;
    const double half = std::sin(0.5 * turn);
    const double s = 2.0 * half * std::cos(0.5 * turn);
    // Row of T_j: the missing twist. Row of θ^j: the unbalanced torque.
    rhs_[rt] = missing_[j] - twistBetween(rod, state, j);
    rhs_[rt + 1] = torque_[j + 1] - torque_[j] - e.rise - e.cosine * s - 2.0 * e.sine * half * half;
    matrix_.at(rt, rt) -= third;
    matrix_.at(rt + 1, rt) += 1.0;
    matrix_.at(rt + 1, rt + 1) += std::max(0.0, e.cosine * (1.0 - 2.0 * half * half) + e.sine * s);
    if (j < last)
    {
      matrix_.at(rt + 2, rt + 2) -= third;
      matrix_.at(rt + 2, rt) -= 0.5 * third;
      matrix_.at(rt + 2, rt + 1) -= 1.0;
    }
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

/** Computes torques, moments and frames for the present angles. */
void MixedTwist::evaluate(const MixedRod& rod, const State& state, double tip_torque)
{
  findAxes(rod, state);
  const bool loaded = std::any_of(rod.edges().begin() + first_, rod.edges().end(),
                                  [](const MixedEdge& edge) { return !edge.load.isZero(0.0); });
  for (int pass = 0; pass < (loaded ? 2 : 1); ++pass)
  {
    findTorque(state, tip_torque);
    findMoments(rod, state);
    for (int j = first_; j + 1 < rod.nodes(); ++j)
    {
      shapeEdge(rod, state, j);
      const double h = rod.edges()[j].length;
      edges_[j].load_torque =
          h * h * h / 12.0 * rod.edges()[j].load.dot(across(edges_[j].curvature, edges_[j].tangent));
    }
  }
}

/** Linearises the relation of torques and angles about the present angles. */
void MixedTwist::linearise(const MixedRod& rod, const TwistBoundary& boundary, const State& state)
{
  for (int j = first_; j + 1 < rod.nodes(); ++j)
  {
    Edge& e = edges_[j];
    const Vector3d rest = 0.5 * (e.end[0] + e.end[1]) * e.rest_curvature;
    const double weight = rod.edges()[j].length / rod.edges()[j].flexibility;
    e.cosine = weight * e.curvature.dot(rest);
    e.sine = weight * e.tangent.dot(rest.cross(e.curvature));
    // The angle between frames contains no full turns.
    missing_[j] = std::remainder(twistBetween(rod, state, j) - twistMismatch(boundary, j), 2.0 * M_PI);
  }
}

void MixedTwist::relax(MixedRod& rod, const TwistBoundary& boundary, State& state)
{
  const int n = rod.nodes();
  first_ = state.first_node;
  angle_before_ = boundary.rotation;
  edges_.resize(static_cast<std::size_t>(n));
  missing_.resize(static_cast<std::size_t>(n));
  axis_.resize(static_cast<std::size_t>(n));
  moment_.resize(static_cast<std::size_t>(n));
  torque_.assign(static_cast<std::size_t>(n), boundary.tip_torque);
  transportBishopFrame(rod, boundary, state);
  evaluate(rod, state, boundary.tip_torque);
  linearise(rod, boundary, state);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration)
  {
    solve(rod, boundary, state);
    double largest = 0.0;
    for (int j = first_; j + 1 < n; ++j)
      largest = std::max(largest, std::abs(rhs_[2 * (j - first_) + 1]));
    const double scale = largest > kMaxTurn ? kMaxTurn / largest : 1.0;
    for (int j = first_; j + 1 < n; ++j)
    {
      torque_[j] += scale * rhs_[2 * static_cast<std::size_t>(j - first_)];
      state.twist_angle[j] += scale * rhs_[2 * (j - first_) + 1];
    }
    if (largest < kConverged || !(largest < 1e300))
      break;
  }
  findMoments(rod, state);
  for (int j = first_; j + 1 < n; ++j)
  {
    shapeEdge(rod, state, j);
    torque_[j] = moment_[j].dot(edges_[j].end[0].col(2));
    for (int side = 0; side < 2; ++side)
      rod.edge(j).rest_curvature[side] = edges_[j].end[side] * edges_[j].rest_curvature;
  }
  state.hand_torque = boundary.held ? -moment_[first_].dot(boundary.tangent) : 0.0;
}

/** Adds the force of an edge from the exact balance of moments; assembleNode() subtracts that of L. */
void MixedTwist::assembleForce(const MixedRod& rod, const State& state, int j, std::vector<double>& gradient) const
{
  const Edge& e = edges_[j];
  const Vector3d force = e.inverse * e.tangent.cross(moment_[j + 1] - moment_[j]);
  add(gradient, rod.positionRow(state, j), -force);
  add(gradient, rod.positionRow(state, j + 1), force);
}

/** Contribution of an edge to the gradient of L by M at one of its ends, without the tiny bow compliance [rad]. */
Vector3d MixedTwist::bendOfEdge(const MixedRod& rod, const State& state, int j, int side) const
{
  const MixedEdge& edge = rod.edges()[j];
  const double h = edge.length;
  const double c = edge.flexibility;
  const Vector3d near = c * state.moment[j + side] + edge.rest_curvature[side];
  const Vector3d far = c * state.moment[j + 1 - side] + edge.rest_curvature[1 - side];
  const double bow = state.tension[j] * h * h * c / 720.0;
  return h * ((1.0 / 3.0 - 16.0 * bow) * near + (1.0 / 6.0 - 14.0 * bow) * far -
              (h * h * c / 24.0) * edges_[j].tangent.cross(edge.load));
}

/** Replaces the gradient of L by M, across the tangent, by the rotation from the frame before a node to the one after
 *  it, and subtracts the forces of M·Φ. */
void MixedTwist::assembleNode(const MixedRod& rod, const State& state, int i, std::vector<double>& gradient) const
{
  const bool has_before = i > first_;
  const bool has_after = i + 1 < rod.nodes();
  const Vector3d frame_before = has_before ? Vector3d(edges_[i - 1].end[1].col(2)) : rod.proximal().tangent;
  const Vector3d frame_after = has_after ? Vector3d(edges_[i].end[0].col(2)) : rod.distal().tangent;
  const TurningAngle chords(has_before ? Vector3d(state.position[i] - state.position[i - 1]) : rod.proximal().tangent,
                            has_after ? Vector3d(state.position[i + 1] - state.position[i]) : rod.distal().tangent);
  Vector3d tilt = turnBetween(frame_before, frame_after) - chords.value;
  Vector3d force = Vector3d::Zero();
  if (has_before)
  {
    tilt += bendOfEdge(rod, state, i - 1, 1);
    const Vector3d bending = chords.transposeBefore(state.moment[i]);
    add(gradient, rod.positionRow(state, i - 1), bending);
    force -= bending;
  }
  if (has_after)
  {
    tilt += bendOfEdge(rod, state, i, 0);
    const Vector3d bending = chords.transposeAfter(state.moment[i]);
    add(gradient, rod.positionRow(state, i + 1), -bending);
    force += bending;
  }
  add(gradient, rod.positionRow(state, i), force);
  add(gradient, rod.momentRow(state, i), across(tilt, axis_[i]));
}

/** Adds ∂²L/∂M∂e = t (∫hat κ̄)ᵀ/|e|: the rest curvature stays perpendicular to the chord. */
void MixedTwist::assembleRestCurvature(const MixedRod& rod, const State& state, int j, MixedRod::Matrix& hessian) const
{
  const MixedEdge& edge = rod.edges()[j];
  const Edge& e = edges_[j];
  const int x0 = rod.positionRow(state, j);
  const int x1 = rod.positionRow(state, j + 1);
  for (int side = 0; side < 2; ++side)
  {
    const int rm = rod.momentRow(state, j + side);
    const Vector3d rest =
        (edge.length * e.inverse / 6.0) * (edge.rest_curvature[0] + edge.rest_curvature[1] + edge.rest_curvature[side]);
    const Vector3d turn = across(rest, e.tangent);
    for (int row = 0; row < 3; ++row)
      for (int col = 0; col < 3; ++col)
      {
        hessian.at(rm + row, x0 + col) -= e.tangent[row] * turn[col];
        if (side == 0)
          hessian.at(x1 + col, rm + row) += e.tangent[row] * turn[col];
        else
          hessian.at(rm + row, x1 + col) += e.tangent[row] * turn[col];
      }
  }
}

void MixedTwist::assemble(const MixedRod& rod, const State& state, std::vector<double>& gradient,
                          MixedRod::Matrix& hessian) const
{
  const int last = rod.nodes() - 1;
  for (int i = first_; i <= last; ++i)
  {
    const bool turns_freely = (i == first_ && rod.proximal().hold != EndHold::kClamped) ||
                              (i == last && rod.distal().hold != EndHold::kClamped);
    if (!turns_freely)
      assembleNode(rod, state, i, gradient);
    if (i == last)
      break;
    assembleForce(rod, state, i, gradient);
    if (!edges_[i].rest_curvature.isZero(0.0))
      assembleRestCurvature(rod, state, i, hessian);
  }
}

Energy MixedTwist::energy(const State& state) const
{
  Energy energy;
  for (std::size_t j = static_cast<std::size_t>(state.first_node); j + 1 < edges_.size(); ++j)
  {
    energy.bending += edges_[j].energy.bending;
    energy.twist += edges_[j].energy.twist;
  }
  return energy;
}

}  // namespace endovascular_sim::rod
