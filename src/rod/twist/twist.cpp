#include "rod/twist/twist.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "rod/model/node_curvature.h"
#include "rod/twist/bishop_frames.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr int kMaxIterations = 200;
constexpr double kMaxTurn = 0.3;  // rad per iteration, so that a snap-through ends in the next minimum
// Newton step after which no other is needed: the error that it leaves is of the order of its square. With friction, a
// ten-thousandth of the rotation at which that slips.
constexpr double kConverged = 1e-8;      // rad
constexpr double kConvergedTip = 1e-12;  // rad: the torque on a held tip is that before the last step
constexpr double kBalanced = 1e-7;       // tolerated residual torque, relative to that of all friction
// Iterations with Newton's tangents, then as many with secants, which always descend.
constexpr int kNewtonIterations = 6;
// Omitted share of the Hessian's concave part: the first with which the Hessian is positive definite.
constexpr std::array<double, 5> kOmitted = {0.0, 1e-3, 1e-2, 0.1, 1.0};
constexpr double kMinLength = 1e-9;  // least length of the body, in edges: keeps the spring finite

double edgeMiddle(const Discretisation& rod, int edge)
{
  return 0.5 * (rod.position[edge] + rod.position[edge + 1]);
}

/** ∫ds/GJ between two arc lengths [1/(N·m)]. */
double torsionalCompliance(const Discretisation& rod, double begin, double end, int from_node)
{
  double sum = 0.0;
  for (int i = from_node; i < rod.nodes(); ++i)
  {
    const double cell_begin = i > 0 ? edgeMiddle(rod, i - 1) : rod.position[i];
    const double cell_end = i + 1 < rod.nodes() ? edgeMiddle(rod, i) : rod.position[i];
    if (cell_begin >= end)
      break;
    sum += std::max(0.0, std::min(end, cell_end) - std::max(begin, cell_begin)) / rod.torsional_stiffness[i];
  }
  return sum;
}

/** First node with two edges that a mouth touches, or that lies beyond it. */
int firstAtMouth(const Discretisation& rod, const Mouth& mouth, int first_node)
{
  int node = first_node + 1;
  while (node + 1 < rod.nodes() && rod.position[node + 1] <= mouth.begin())
    ++node;
  return node;
}

}  // namespace

bool QuasiStaticTwist::matters(const Discretisation& rod, const TwistBoundary& boundary)
{
  return rod.first_curved < rod.nodes() || boundary.tip_torque != 0.0 || boundary.hasEdgeTorque() ||
         boundary.hasFriction() || (boundary.held && boundary.tip_held);
}

void QuasiStaticTwist::solve(const Discretisation& rod, const TwistBoundary& boundary, State& state,
                             bool same_centreline)
{
  prepare(rod, boundary, state, same_centreline);
  if (first_own_ < rod.nodes())
    relax(rod, boundary, state);
  evaluate(rod, boundary, state);
}

void QuasiStaticTwist::evaluateAt(const Discretisation& rod, const TwistBoundary& boundary, State& state)
{
  prepare(rod, boundary, state, false);
  evaluate(rod, boundary, state);
}

QuasiStaticTwist::Model QuasiStaticTwist::linearise(const Discretisation& rod, const TwistBoundary& boundary,
                                                    const State& state)
{
  if (first_own_ < rod.nodes())
  {
    TwistBoundary without_friction = boundary;
    without_friction.friction = nullptr;
    assemble(rod, without_friction, state, false);
    double omitted = 0.0;
    for (std::size_t k = 0; k < kOmitted.size(); ++k)
    {
      omitted = kOmitted[k];
      if (solveForStep(first_own_ - 1, rod.nodes() - 2, omitted) >= 0.0)
        break;
    }
    for (int j = first_own_ - 1; omitted > 0.0 && j + 1 < rod.nodes(); ++j)
      diagonal_[j] += omitted * concave_[j];
  }
  return {gradient_, diagonal_, upper_};
}

void QuasiStaticTwist::turn(const Discretisation& rod, const TwistBoundary& boundary, const std::vector<double>& turns,
                            double share, State& state)
{
  for (int j = first_own_ - 1; j + 1 < rod.nodes(); ++j)
    state.twist_angle[j] += share * turns[j];
  if (first_curved_ < rod.nodes())
    followFrames(rod, boundary, state);
  evaluate(rod, boundary, state);
}

/** Transports the frame on a centreline that has moved, and subtracts its own turns from the twist angles: the material
 *  has followed the edges without them. */
void QuasiStaticTwist::followFrames(const Discretisation& rod, const TwistBoundary& boundary, State& state)
{
  bishop_before_.swap(bishop_);
  bishop_normal_before_.swap(bishop_normal_);
  bishop_.resize(bishop_before_.size());
  bishop_normal_.resize(bishop_before_.size());
  transportBishopFrame(rod, boundary, state);
  for (int j = std::max(first_curved_ - 1, first_edge_); j + 1 < rod.nodes(); ++j)
    state.twist_angle[j] -= frameTurn(bishop_before_[j], bishop_normal_before_[j], bishop_[j], bishop_normal_[j]);
}

/** Sizes the vectors, finds the edges with angles of their own, and transports the frame. */
void QuasiStaticTwist::prepare(const Discretisation& rod, const TwistBoundary& boundary, State& state,
                               bool same_centreline)
{
  const int n = rod.nodes();
  first_edge_ = state.first_node;
  while (first_edge_ + 2 < n && edgeMiddle(rod, first_edge_) < boundary.position)
    ++first_edge_;
  first_curved_ = std::max(rod.first_curved, first_edge_ + 1);
  if (boundary.hasMouth())
    first_curved_ = std::max(rod.first_curved, firstAtMouth(rod, boundary.mouth(), state.first_node));
  if (first_curved_ > n - 2)
    first_curved_ = n;
  first_own_ = first_curved_ < n ? std::max(first_curved_, first_edge_ + 1) : n;
  if (first_own_ > n - 2)
    first_own_ = n;
  if (boundary.hasFriction() && first_edge_ + 1 <= n - 2)
    first_own_ = std::min(first_own_, std::clamp(boundary.friction->front().node, first_edge_ + 1, n - 2));
  held_friction_ = held_rest_ = 0.0;
  last_body_ = std::min(first_own_ - 1, n - 2);
  bishop_.resize(n);
  bishop_normal_.resize(n);
  binormal_.resize(n);
  rest_binormal_.resize(n);
  cosine_.resize(n);
  sine_.resize(n);
  torque_.assign(n, 0.0);
  gradient_.resize(n);
  diagonal_.resize(n);
  upper_.resize(n);
  concave_.resize(n);
  pivot_.resize(n);
  step_.resize(n);
  prepareBody(rod, boundary);
  prepareMouth(rod, boundary);
  if (!same_centreline && (first_curved_ < n || boundary.tip_held))
    transportBishopFrame(rod, boundary, state);
  if (boundary.tip_held)
    placeTip(rod, boundary, state);
}

/** Prepares the rest curvature at the nodes that the mouth touches. */
void QuasiStaticTwist::prepareMouth(const Discretisation& rod, const TwistBoundary& boundary)
{
  mouth_begin_ = first_curved_;
  mouth_rest_.clear();
  straight_force_ = 0.0;
  if (!boundary.hasMouth() || rod.curved_parts.empty())
    return;
  const Mouth mouth = boundary.mouth();
  straight_force_ = straightEnergySlope(rod.curved_parts, mouth);
  for (int i = first_curved_; i + 1 < rod.nodes() && rod.position[i - 1] < mouth.end(); ++i)
    mouth_rest_.push_back(rod.restAt(i, mouth));
}

/** Prepares the straight body: a torsion spring between the hold and its last edge, loaded by the torques along it. */
void QuasiStaticTwist::prepareBody(const Discretisation& rod, const TwistBoundary& boundary)
{
  body_stiffness_ = 0.0;
  if (boundary.held)
  {
    const double compliance = torsionalCompliance(rod, boundary.position, edgeMiddle(rod, last_body_), first_edge_);
    body_stiffness_ =
        1.0 / std::max(compliance, kMinLength * rod.rest_length[last_body_] / rod.torsional_stiffness[last_body_]);
  }
  body_load_ = body_load_angle_ = 0.0;
  if (!boundary.hasEdgeTorque())
    return;
  double compliance = 0.0;
  double reached = boundary.position;
  for (int j = first_edge_; j < last_body_; ++j)
  {
    compliance += std::max(0.0, edgeMiddle(rod, j) - reached) / rod.torsional_stiffness[j];
    reached = std::max(reached, edgeMiddle(rod, j));
    body_load_ += boundary.edgeTorque(j);
    body_load_angle_ += compliance * boundary.edgeTorque(j);
  }
}

/** Torque at the body's last node, just before its last edge, when that edge has turned by @p angle [N·m]. */
double QuasiStaticTwist::bodyTorque(const TwistBoundary& boundary, double angle) const
{
  return boundary.held ? body_stiffness_ * (angle - boundary.rotation - body_load_angle_) : -body_load_;
}

/** Angle of a held last edge: from the transported frame to its director, on the branch nearest to the last one. */
void QuasiStaticTwist::placeTip(const Discretisation& rod, const TwistBoundary& boundary, State& state) const
{
  const double angle = std::atan2(boundary.tip_director.dot(tip_normal_), boundary.tip_director.dot(tip_bishop_));
  state.tip_transport = angle + 2.0 * M_PI * std::round((state.tip_transport - angle) / (2.0 * M_PI));
  state.twist_angle[rod.nodes() - 2] = state.tip_transport + boundary.tip_rotation;
}

void QuasiStaticTwist::transportBishopFrame(const Discretisation& rod, const TwistBoundary& boundary,
                                            const State& state)
{
  Eigen::Vector3d tangent = boundary.tangent;
  Eigen::Vector3d director = boundary.director;
  for (int j = std::clamp(first_curved_ - 1, state.first_node, first_edge_); j + 1 < rod.nodes(); ++j)
  {
    const Eigen::Vector3d next = (state.position[j + 1] - state.position[j]).normalized();
    // Parallel transport: the rotation about tangent × next that takes one to the other.
    director -= (director.dot(next) / (1.0 + tangent.dot(next))) * (tangent + next);
    tangent = next;
    if (j + 1 >= first_curved_)
    {
      bishop_[j] = director;
      bishop_normal_[j] = tangent.cross(director);
    }
  }
  tip_bishop_ = director;
  tip_normal_ = tangent.cross(director);
  for (int i = first_curved_; i + 1 < rod.nodes(); ++i)
    binormal_[i] = binormalAt(rod, state, i).value;
}

/** Assembles gradient and Hessian by the twist angles of the edges first_own_−1 … n−2, and separately the concave part
 *  of the Hessian's diagonal.
 *  @return the largest |gradient| */
double QuasiStaticTwist::assemble(const Discretisation& rod, const TwistBoundary& boundary, const State& state,
                                  bool secants)
{
  const int n = rod.nodes();
  const int first = first_own_ - 1;
  for (int j = first; j + 1 < n; ++j)
    gradient_[j] = diagonal_[j] = upper_[j] = concave_[j] = 0.0;
  turnFrames(boundary, state);
  gradient_[first] = bodyTorque(boundary, state.twist_angle[first]);
  for (int j = first; boundary.hasEdgeTorque() && j + 1 < n; ++j)
    gradient_[j] -= boundary.edgeTorque(j);
  // The tiny second term keeps the matrix regular where nothing holds the twist.
  diagonal_[first] = body_stiffness_ + 1e-9 * rod.torsional_stiffness[first_own_] / rod.cell_length[first_own_];
  gradient_[n - 2] -= boundary.tip_torque;
  for (int i = first_own_; i + 1 < n; ++i)
  {
    const double k = rod.torsional_stiffness[i] / rod.cell_length[i];
    const double m = state.twist_angle[i] - state.twist_angle[i - 1];
    gradient_[i] += k * m;
    gradient_[i - 1] -= k * m;
    diagonal_[i] += k;
    diagonal_[i - 1] += k;
    upper_[i - 1] -= k;
  }
  for (int i = first_curved_; i + 1 < n; ++i)
    addRestCurvature(rod, i);
  if (boundary.hasFriction())
    addFriction(boundary, state, secants);
  tip_gradient_ = gradient_[n - 2];
  if (boundary.tip_held)
  {
    gradient_[n - 2] = upper_[n - 3] = 0.0;
    diagonal_[n - 2] = 1.0;
  }
  double largest = 0.0;
  for (int j = first; j + 1 < n; ++j)
    largest = std::max(largest, std::abs(gradient_[j]));
  return largest;
}

/** Computes sines and cosines of the curved tip's edges, which two nodes each need. */
void QuasiStaticTwist::turnFrames(const TwistBoundary& boundary, const State& state)
{
  for (int j = first_curved_ - 1; j + 1 < static_cast<int>(cosine_.size()); ++j)
  {
    const double angle = edgeAngle(boundary, state, j);
    cosine_[j] = std::cos(angle);
    sine_[j] = std::sin(angle);
  }
}

/** Adds the bending of a node of the curved tip. */
void QuasiStaticTwist::addRestCurvature(const Discretisation& rod, int node)
{
  const double b = 0.5 * rod.bending_stiffness[node] / rod.cell_length[node];
  const Eigen::Vector2d& rest = restCurvature(rod, node);
  for (int j = node - 1; j <= node; ++j)
  {
    const double c = cosine_[j];
    const double s = sine_[j];
    const double along1 = binormal_[node].dot(bishop_[j]);
    const double along2 = binormal_[node].dot(bishop_normal_[j]);
    const Eigen::Vector2d omega(c * along2 - s * along1, -(c * along1 + s * along2));
    if (j < first_own_ - 1)
      continue;  // turns with the handle
    gradient_[j] += b * (rest.y() * omega.x() - rest.x() * omega.y());
    diagonal_[j] += b * rest.dot(omega);
    concave_[j] += b * std::max(0.0, -rest.dot(omega));
  }
}

/** Adds friction. A node turns by the mean of its edges; an edge before the hold turns with the handle, which carries
 * its share of the torque. */
void QuasiStaticTwist::addFriction(const TwistBoundary& boundary, const State& state, bool secants)
{
  const int last = static_cast<int>(state.twist_angle.size()) - 1;
  const auto angle = [&](int edge) { return edge < first_edge_ ? boundary.rotation : state.twist_angle[edge]; };
  held_friction_ = 0.0;
  for (const TwistFriction& friction : *boundary.friction)
  {
    const int before = std::max(friction.node - 1, state.first_node);
    const int after = std::min(friction.node, last);
    const double turn = 0.5 * (angle(before) + angle(after)) - friction.begin_angle;
    const double pull = 0.5 * friction.pull(turn);
    const double stiffness = 0.25 * (secants ? friction.secant(turn) : friction.stiffness(turn));
    for (const int edge : {before, after})
    {
      if (edge < first_edge_)
      {
        held_friction_ += pull;
        continue;
      }
      gradient_[edge] += pull;
      diagonal_[edge] += stiffness;
    }
    if (before == after)
      diagonal_[before] += 2.0 * stiffness;
    else if (before >= first_edge_)
      upper_[before] += stiffness;
  }
}

/** Tolerated residual torque on an edge [N·m]. */
double QuasiStaticTwist::balanced(const TwistBoundary& boundary) const
{
  double sum = 0.0;
  for (std::size_t k = 0; boundary.hasFriction() && k < boundary.friction->size(); ++k)
    sum += (*boundary.friction)[k].limit * (*boundary.friction)[k].arm;
  return kBalanced * sum;
}

/** Solves the tridiagonal system for the Newton step, a share of the concave part omitted.
 *  @return the largest step, or a negative number when the matrix is not positive definite */
double QuasiStaticTwist::solveForStep(int first, int last, double omitted)
{
  for (int j = first; j <= last; ++j)
  {
    pivot_[j] = diagonal_[j] + omitted * concave_[j];
    step_[j] = gradient_[j];
    if (j > first)
    {
      const double factor = upper_[j - 1] / pivot_[j - 1];
      pivot_[j] -= factor * upper_[j - 1];
      step_[j] -= factor * step_[j - 1];
    }
    if (!(pivot_[j] > 0.0))
      return -1.0;
  }
  double largest = 0.0;
  for (int j = last; j >= first; --j)
  {
    step_[j] = (step_[j] - (j < last ? upper_[j] * step_[j + 1] : 0.0)) / pivot_[j];
    largest = std::max(largest, std::abs(step_[j]));
  }
  return largest;
}

/** Newton's method with the exact Hessian where that is positive definite. Beyond a snap-through it is indefinite: the
 *  least sufficient share of its concave part is omitted, and the angles descend to the next minimum. */
void QuasiStaticTwist::relax(const Discretisation& rod, const TwistBoundary& boundary, State& state)
{
  const int first = first_own_ - 1;
  const int last = rod.nodes() - 2;
  const double tolerated = balanced(boundary);
  const double converged = boundary.tip_held ? kConvergedTip : kConverged;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration)
  {
    const bool secants = iteration / kNewtonIterations % 2 == 1;
    if (assemble(rod, boundary, state, secants) <= tolerated)
      return;
    double largest = -1.0;
    for (std::size_t k = 0; k < kOmitted.size() && largest < 0.0; ++k)
      largest = solveForStep(first, last, kOmitted[k]);
    const double scale = largest > kMaxTurn ? kMaxTurn / largest : 1.0;
    for (int j = first; j <= last; ++j)
      state.twist_angle[j] -= scale * step_[j];
    if (largest < converged)
      return;
  }
}

void QuasiStaticTwist::evaluate(const Discretisation& rod, const TwistBoundary& boundary, State& state)
{
  energy_ = 0.0;
  evaluateBody(rod, boundary, state);
  evaluateTip(rod, boundary, state);
  if (boundary.held)
    state.hand_torque += held_rest_;
  state.distal_torque = 0.0;
  if (!boundary.tip_held)
    return;
  // The last assembly has computed it where edges have their own angles; a straight wire transmits the body's torque.
  state.distal_torque = tip_gradient_;
  if (first_own_ == rod.nodes())
    state.distal_torque = torque_[last_body_] - boundary.edgeTorque(last_body_) - boundary.tip_torque;
}

/** Computes torques, energy and angles of the straight body. */
void QuasiStaticTwist::evaluateBody(const Discretisation& rod, const TwistBoundary& boundary, State& state)
{
  const bool known = first_own_ < rod.nodes() || boundary.tip_held;  // the angle of the body's last edge
  const double end_angle = state.twist_angle[last_body_];
  double torque = known ? bodyTorque(boundary, end_angle) : boundary.tip_torque + boundary.edgeTorque(last_body_);
  torque += body_load_;
  state.hand_torque = boundary.held ? held_friction_ - torque : 0.0;
  double angle = boundary.rotation;
  double reached = boundary.position;
  for (int j = state.first_node; j <= last_body_; ++j)
  {
    if (j > first_edge_)
      torque -= boundary.edgeTorque(j - 1);
    if (j > first_edge_ || edgeMiddle(rod, j) > boundary.position)
    {
      const double turn = torque * std::max(0.0, edgeMiddle(rod, j) - reached) / rod.torsional_stiffness[j];
      angle += turn;
      energy_ += 0.5 * torque * turn;
      reached = edgeMiddle(rod, j);
      torque_[j] = torque;
    }
    if (j < last_body_ || !known)
      state.twist_angle[j] = angle;
  }
  if (boundary.held || !known)
    return;
  // Nothing holds the proximal end: the body turns with its last edge.
  for (int j = state.first_node; j < last_body_; ++j)
    state.twist_angle[j] += end_angle - angle;
}

/** Computes torques, energy and rest curvature beyond the body. */
void QuasiStaticTwist::evaluateTip(const Discretisation& rod, const TwistBoundary& boundary, State& state)
{
  const int n = rod.nodes();
  const int free = first_own_ < n ? first_own_ - 1 : n;  // first edge that does not turn with the handle
  held_rest_ = 0.0;
  turnFrames(boundary, state);
  for (int i = first_own_; i + 1 < n; ++i)
  {
    const double m = state.twist_angle[i] - state.twist_angle[i - 1];
    const double k = rod.torsional_stiffness[i] / rod.cell_length[i];
    torque_[i] = k * m;
    energy_ += 0.5 * k * m * m;
  }
  for (int i = first_curved_; i + 1 < n; ++i)
  {
    rest_binormal_[i].setZero();
    for (int j = i - 1; j <= i; ++j)
    {
      const Eigen::Vector3d rest = binormalOnEdge(restCurvature(rod, i), j, cosine_[j], sine_[j]);
      rest_binormal_[i] += rest;
      if (j < free)
        held_rest_ -= rod.bending_stiffness[i] / rod.cell_length[i] * binormal_[i].dot(edgeTangent(j).cross(rest));
    }
  }
}

Eigen::Vector3d QuasiStaticTwist::restCurvatureOnEdge(const Discretisation& rod, int node, int edge) const
{
  return binormalOnEdge(restCurvature(rod, node), edge, cosine_[edge], sine_[edge]);
}

double QuasiStaticTwist::holdForce(const Discretisation& rod, const State& state) const
{
  double force = straight_force_;
  for (std::size_t k = 0; k < mouth_rest_.size(); ++k)
  {
    const int i = mouth_begin_ + static_cast<int>(k);
    const Eigen::Vector3d bent = binormalAt(rod, state, i).value - state.curvature_offset[i];
    double by_length = -mouth_rest_[k].curvature.dot(mouth_rest_[k].slope);
    for (int j = i - 1; j <= i; ++j)
      by_length += bent.dot(binormalOnEdge(mouth_rest_[k].slope, j, cosine_[j], sine_[j]));
    force += rod.bending_stiffness[i] / rod.cell_length[i] * by_length;
  }
  return force;
}

/** Half of a node's rest curvature binormal in the material frame of one of its two edges. */
Eigen::Vector3d QuasiStaticTwist::binormalOnEdge(const Eigen::Vector2d& rest_curvature, int edge, double cosine,
                                                 double sine) const
{
  const Eigen::Vector3d m1 = cosine * bishop_[edge] + sine * bishop_normal_[edge];
  const Eigen::Vector3d m2 = cosine * bishop_normal_[edge] - sine * bishop_[edge];
  return 0.5 * (rest_curvature.x() * m2 - rest_curvature.y() * m1);
}

Eigen::Vector3d QuasiStaticTwist::binormalOf(const Eigen::Vector2d& rest_curvature, int node,
                                             const std::vector<double>& twist_angle) const
{
  Eigen::Vector3d binormal = Eigen::Vector3d::Zero();
  for (int j = node - 1; j <= node; ++j)
    binormal += binormalOnEdge(rest_curvature, j, std::cos(twist_angle[j]), std::sin(twist_angle[j]));
  return binormal;
}

}  // namespace endovascular_sim::rod
