#include "benchmark/sheet/channel_statics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

namespace endovascular_sim::benchmark
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kEdge = 0.5e-3;         // m
constexpr double kTipLength = 1e-3;      // m, length of wire that the contact of the tip represents
constexpr double kTolerance = 1e-9;      // of an equilibrium, over the length of the wire
constexpr int kRounds = 60;              // of the friction; the force on the hand is the mean of the second half
constexpr double kRelaxation = 0.3;      // of the friction in a round
constexpr double kFrictionError = 1e-3;  // of the sum of the friction forces that ends the rounds
constexpr double kLargestError = 0.05;   // of this sum in the last round
constexpr double kTravel = 1e-3;         // m, of the central difference of the energy
constexpr double kWallStiffness = 2e8;   // per length of wire [N/m²]: 5 µm at 1 N/mm
constexpr double kFirstStiffness = 2e5;  // of the first equilibrium, which begins far away [N/m²]
constexpr double kStiffening = 10.0;     // from one equilibrium to the next

/** Piece of the channel in the plane z = 0. */
struct Piece
{
  Vector3d begin = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitX();
  double length = 0.0;
  double curvature = 0.0;  ///< signed: positive turns from x to y [1/m]

  Vector3d left() const { return {-direction.y(), direction.x(), 0.0}; }
  Vector3d centre() const { return begin + left() / curvature; }

  Vector3d at(double s) const
  {
    if (curvature == 0.0)
      return begin + s * direction;
    const double turn = curvature * s;
    return begin + (std::sin(turn) * direction + (1.0 - std::cos(turn)) * left()) / curvature;
  }

  Vector3d directionAt(double s) const
  {
    return std::cos(curvature * s) * direction + std::sin(curvature * s) * left();
  }

  /** Arc length of the nearest point of the whole line or circle. */
  double arcLengthOf(const Vector3d& point) const
  {
    if (curvature == 0.0)
      return direction.dot(point - begin);
    const Vector3d from = point - centre();
    return std::atan2(from.dot(direction), std::copysign(1.0, -curvature) * from.dot(left())) / std::abs(curvature);
  }
};

std::vector<Piece> piecesOf(const std::vector<vessel::TubePiece>& shape)
{
  std::vector<Piece> pieces;
  Piece next;
  for (const vessel::TubePiece& piece : shape)
  {
    next.length = piece.length;
    next.curvature = std::cos(piece.plane_angle) > 0.0 ? piece.curvature : -piece.curvature;
    pieces.push_back(next);
    const Vector3d end = next.at(next.length);
    next.direction = next.directionAt(next.length);
    next.begin = end;
  }
  return pieces;
}

/** Point of the channel's axis. */
Vector3d axisAt(const std::vector<Piece>& pieces, double s)
{
  for (const Piece& piece : pieces)
  {
    if (s <= piece.length || &piece == &pieces.back())
      return piece.at(s);
    s -= piece.length;
  }
  return Vector3d::Zero();
}

/** Offset of a point from the channel's axis, its direction and derivative. */
struct Offset
{
  double distance = std::numeric_limits<double>::infinity();
  Vector3d outward = Vector3d::UnitY();
  Matrix3d turning = Matrix3d::Zero();
};

Offset offsetFrom(const std::vector<Piece>& pieces, const Vector3d& point)
{
  Offset nearest;
  for (std::size_t k = 0; k < pieces.size(); ++k)
  {
    const Piece& piece = pieces[k];
    const double s = piece.arcLengthOf(point);
    if ((s < 0.0 && k > 0) || (s > piece.length && k + 1 < pieces.size()))
      continue;
    Offset offset;
    if (piece.curvature == 0.0)
    {
      const double across = piece.left().dot(point - piece.begin);
      offset.distance = std::abs(across);
      offset.outward = across < 0.0 ? Vector3d(-piece.left()) : piece.left();
    }
    else
    {
      Vector3d from = point - piece.centre();
      from.z() = 0.0;
      const double radius = from.norm();
      const double beyond = radius - 1.0 / std::abs(piece.curvature);
      offset.distance = std::abs(beyond);
      offset.outward = (beyond < 0.0 ? -1.0 : 1.0) * from / radius;
      const Vector3d along(-from.y() / radius, from.x() / radius, 0.0);
      offset.turning = (beyond < 0.0 ? -1.0 : 1.0) * along * along.transpose() / radius;
    }
    if (offset.distance < nearest.distance)
      nearest = offset;
  }
  return nearest;
}

/** Potential of the walls on a node: ½ k (distance − clearance)², and of the plane. @param k stiffness [N/m] */
NodePotential wallPotential(const std::vector<Piece>& pieces, double clearance, double k, const Vector3d& point)
{
  NodePotential sum;
  const Offset offset = offsetFrom(pieces, point);
  const double excess = offset.distance - clearance;
  if (excess > 0.0)
  {
    sum.energy += 0.5 * k * excess * excess;
    sum.gradient += k * excess * offset.outward;
    sum.hessian += k * (offset.outward * offset.outward.transpose() + excess * offset.turning);
  }
  sum.energy += 0.5 * k * point.z() * point.z();
  sum.gradient.z() += k * point.z();
  sum.hessian(2, 2) += k;
  return sum;
}

/** Solver of one problem, with the equilibrium that it has reached. */
class Channel
{
public:
  explicit Channel(const ChannelProblem& problem)
    : problem_(problem), pieces_(piecesOf(problem.pieces)), nodes_(nodesOf(problem))
  {
    for (int i = 0; i < nodes_; ++i)
      equilibrium_.position.push_back(axisAt(pieces_, arcLength(i)));
    force_.assign(static_cast<std::size_t>(nodes_), Vector3d::Zero());
  }

  ChannelState solve()
  {
    loadTip();
    for (wall_stiffness_ = kFirstStiffness; wall_stiffness_ < kWallStiffness; wall_stiffness_ *= kStiffening)
      settle();
    wall_stiffness_ = kWallStiffness;
    settle();
    double sum = 0.0;  // of the force on the hand
    int summed = 0;
    for (int round = 0; round < kRounds && problem_.advance != 0.0 && problem_.friction > 0.0; ++round)
    {
      const double error = loadFriction();
      if (error > kLargestError && round + 1 == kRounds)
        throw std::runtime_error("channelStatics: friction and normal forces do not agree");
      if (error < kFrictionError)
        break;
      settle();
      sum += round >= kRounds / 2 ? hand_force_ : 0.0;
      summed += round >= kRounds / 2 ? 1 : 0;
    }
    if (summed > 0)
      hand_force_ = sum / summed;
    return state();
  }

private:
  static int nodesOf(const ChannelProblem& problem)
  {
    return static_cast<int>(std::lround((problem.inserted_length + problem.tail_length) / kEdge)) + 1;
  }

  double edge() const { return (problem_.inserted_length + problem_.tail_length) / (nodes_ - 1.5); }
  /** The clamp acts at the middle of the first edge. */
  double arcLength(int node) const { return (node - 0.5) * edge(); }
  double lengthOf(int node) const { return node + 1 < nodes_ ? edge() : kTipLength; }

  /** Part of the cell of a node that lies in the tail, 0 to 1. */
  double tailShare(int node) const
  {
    return std::clamp((arcLength(node) + 0.5 * edge() - problem_.inserted_length) / edge(), 0.0, 1.0);
  }

  /** Clearance of a node; within the cell of the sleeve's end it changes linearly. */
  double clearanceOf(int node) const
  {
    const double share = problem_.tail_length > 0.0 ? tailShare(node) : 0.0;
    return (1.0 - share) * problem_.clearance + share * problem_.tail_clearance;
  }

  /** Bending stiffness of a node: the compliances of its cell in series. */
  double stiffnessOf(int node) const
  {
    const double share = problem_.tail_length > 0.0 ? tailShare(node) : 0.0;
    return share > 0.0 ? 1.0 / ((1.0 - share) / problem_.bending_stiffness + share / problem_.tail_stiffness)
                       : problem_.bending_stiffness;
  }

  Vector3d tangent(int node) const
  {
    const int before = std::max(0, node - 1);
    const int after = std::min(nodes_ - 1, node + 1);
    return (equilibrium_.position[after] - equilibrium_.position[before]).normalized();
  }

  /** Normal force of the wall on a node. */
  Vector3d normal(int node) const
  {
    Vector3d force =
        -wallPotential(pieces_, clearanceOf(node), wall_stiffness_ * lengthOf(node), equilibrium_.position[node])
             .gradient;
    force.z() = 0.0;
    return force;
  }

  void loadTip() { force_.back() = -problem_.tip_force * tangent(nodes_ - 1); }

  /** Moves the friction of every node towards its limit, by a share: contacts that alternate between two nodes would
   *  alternate for ever. @return distance of the sum of all friction forces from its limit, over this limit */
  double loadFriction()
  {
    double present = 0.0;
    double limit = std::numeric_limits<double>::min();
    for (int i = 2; i < nodes_; ++i)
    {
      const Vector3d axial = tangent(i);
      const Vector3d other = i + 1 == nodes_ ? Vector3d(-problem_.tip_force * axial) : Vector3d::Zero();
      const Vector3d wanted = other - problem_.advance * problem_.friction * normal(i).norm() * axial;
      present += (force_[i] - other).norm();
      limit += (wanted - other).norm();
      force_[i] += kRelaxation * (wanted - force_[i]);
    }
    return std::abs(limit - present) / limit;
  }

  void settle()
  {
    EquilibriumProblem problem;
    rod::Section section;
    section.length = (nodes_ - 1) * edge();
    section.radius = 1e-4;
    section.density = 1000.0;
    section.bending_stiffness = section.torsional_stiffness = problem_.bending_stiffness;
    section.axial_stiffness = 1.0;
    rod::Wire wire;
    wire.sections = {section};
    problem.rod = rod::discretiseUniformly(wire, nodes_);
    for (int i = 0; i < nodes_; ++i)
      problem.rod.bending_stiffness[i] = stiffnessOf(i);
    problem.held.assign(static_cast<std::size_t>(nodes_), false);
    problem.held[0] = problem.held[1] = true;
    problem.force = force_;
    problem.tolerance = kTolerance;
    problem.node_potential = [this](int node, const Vector3d& position)
    { return wallPotential(pieces_, clearanceOf(node), wall_stiffness_ * lengthOf(node), position); };
    const EquilibriumSolver solver(problem);
    if (!solver.solve(equilibrium_))
      throw std::runtime_error("channelStatics: no equilibrium at " + std::to_string(1e3 * problem_.inserted_length) +
                               " mm");
    const Eigen::VectorXd forces = solver.forces(equilibrium_);
    hand_force_ = forces[0] + forces[3];
    energy_ = solver.potential(equilibrium_);
  }

  ChannelState state() const
  {
    ChannelState state;
    state.hand_force = hand_force_;
    state.energy = energy_;
    for (int i = 0; i < nodes_; ++i)
    {
      state.arc_length.push_back(arcLength(i));
      state.normal_force.push_back(i < 2 ? 0.0 : normal(i).norm());
    }
    return state;
  }

  const ChannelProblem& problem_;
  std::vector<Piece> pieces_;
  int nodes_;
  Equilibrium equilibrium_;
  std::vector<Vector3d> force_;
  double wall_stiffness_ = kWallStiffness;  ///< per length of wire [N/m²]
  double hand_force_ = 0.0;
  double energy_ = 0.0;
};

}  // namespace

double ChannelState::normalForceBefore(double end) const
{
  double sum = 0.0;
  for (std::size_t i = 0; i < normal_force.size(); ++i)
    sum += arc_length[i] < end ? normal_force[i] : 0.0;
  return sum;
}

ChannelState channelStatics(const ChannelProblem& problem)
{
  return Channel(problem).solve();
}

double trackingForce(const ChannelProblem& problem)
{
  ChannelProblem at = problem;
  at.advance = 0.0;
  const double reached = problem.inserted_length + problem.tail_length;
  const auto stateAt = [&at, reached](double inserted)
  {
    at.inserted_length = inserted;
    at.tail_length = reached - inserted;
    return channelStatics(at);
  };
  const double elastic =
      (stateAt(problem.inserted_length + kTravel).energy - stateAt(problem.inserted_length - kTravel).energy) /
      (2.0 * kTravel);
  const double normal = stateAt(problem.inserted_length).normalForceBefore(problem.inserted_length);
  return elastic + problem.advance * problem.friction * normal;
}

ChannelTorque channelTorque(const ChannelState& state, double friction, double radius, double torsional_stiffness)
{
  ChannelTorque result;
  const double share = friction / std::sqrt(1.0 + friction * friction);
  for (std::size_t i = 0; i < state.normal_force.size(); ++i)
  {
    const double torque = share * radius * state.normal_force[i];
    result.torque += torque;
    result.lag += torque * state.arc_length[i] / torsional_stiffness;
  }
  return result;
}

}  // namespace endovascular_sim::benchmark
