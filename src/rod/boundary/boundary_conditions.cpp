#include "rod/boundary/boundary_conditions.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "rod/model/node_curvature.h"
#include "rod/model/stretching.h"

namespace endovascular_sim::rod
{
namespace
{

// Half width of the introducer's mouth over the decay length of its guide: within that length, the guide does not tell
// where the wire begins to be straight.
constexpr double kHalfWidth = 0.5;
constexpr double kShortestDecay = 1e-6;            // m, of a mouth as sharp as that of a clamp
constexpr double kLongestHiddenPart = 1.0 - 1e-6;  // of an edge: a shorter visible rest is neglected

/** Rotation from the wire's first direction to that of its clamped distal end. */
Eigen::Matrix3d distalRotation(const EndMotion& distal)
{
  const double angle = distal.tilt.norm();
  if (angle == 0.0)
    return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, distal.tilt / angle).toRotationMatrix();
}

}  // namespace

bool BoundaryConditions::isPrescribed(int node, const State& state) const
{
  if (isDistalHeld(node))
    return true;
  if (boundary_.introducer)
    return (clamped_ == ClampedNodes::kNode && node == state.first_node) ||
           bodyPosition(node, state.inserted_length) < -boundary_.guide_length;
  return (boundary_.proximal != EndHold::kFree && node == 0) || (node == 1 && clampsEdge(boundary_.proximal));
}

int BoundaryConditions::firstFreeNode(const State& state) const
{
  int free = state.first_node;
  while (free < rod_.nodes() && isPrescribed(free, state) && !isDistalHeld(free))
    ++free;
  return free;
}

int BoundaryConditions::firstSimulatedNode(double inserted_length) const
{
  int first = 0;
  if (boundary_.introducer)
    while (first + 3 < rod_.nodes() && bodyPosition(first + 2, inserted_length) < -boundary_.guide_length)
      ++first;
  return first;
}

State BoundaryConditions::initialState(double inserted_length, double rotation) const
{
  State state;
  const auto n = static_cast<std::size_t>(rod_.nodes());
  state.inserted_length = inserted_length;
  state.rotation = rotation;
  state.position.resize(n);
  state.velocity.assign(n, Eigen::Vector3d::Zero());
  state.tension.assign(n - 1, 0.0);
  state.twist_angle.assign(n - 1, rotation);
  state.wall_force.assign(n, Eigen::Vector3d::Zero());
  state.friction_coefficient.assign(n, 0.0);
  state.wall_offset.assign(n, 0.0);
  state.curvature_offset.assign(n, Eigen::Vector3d::Zero());
  state.friction_stretch.assign(n, Eigen::Vector3d::Zero());
  for (int i = 0; i < rod_.nodes(); ++i)
    state.position[i] = boundary_.origin + bodyPosition(i, inserted_length) * boundary_.direction;
  state.first_node = firstSimulatedNode(inserted_length);
  const Eigen::Vector3d& last = state.position[n - 1];
  state.distal_anchor =
      boundary_.distal == EndHold::kClamped ? Eigen::Vector3d(0.5 * (last + state.position[n - 2])) : last;
  return state;
}

PlacedNodes BoundaryConditions::placePrescribedNodes(State& state, double inserted_length, double dt) const
{
  const int old_first = state.first_node;
  const double speed = (inserted_length - state.inserted_length) / dt;
  state.inserted_length = inserted_length;
  if (!boundary_.introducer)
    return {};
  state.first_node = firstSimulatedNode(inserted_length);
  PlacedNodes placed{state.first_node, state.first_node, state.first_node};
  for (int i = state.first_node; i < rod_.nodes() && (i < old_first || isPrescribed(i, state)); ++i)
  {
    if (isDistalHeld(i))
      break;
    state.position[i] = boundary_.origin + bodyPosition(i, inserted_length) * boundary_.direction;
    state.velocity[i] = speed * boundary_.direction;
    state.wall_force[i].setZero();
    placed.end = i + 1;
    if (i < old_first)
      placed.born = i + 1;
  }
  return placed;
}

void BoundaryConditions::placeDistalEnd(State& state, const EndMotion& motion, double dt) const
{
  state.distal = motion;
  if (boundary_.distal == EndHold::kFree)
    return;
  const int last = rod_.nodes() - 1;
  const Eigen::Vector3d anchor = state.distal_anchor + motion.displacement;
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  if (boundary_.distal == EndHold::kClamped)
    half = (0.5 * rod_.rest_length[last - 1]) * (distalRotation(state.distal) * boundary_.direction);
  for (int i = last; i >= 0 && isDistalHeld(i); --i)
  {
    const Eigen::Vector3d target = i == last ? Eigen::Vector3d(anchor + half) : Eigen::Vector3d(anchor - half);
    state.velocity[i] = (target - state.position[i]) / dt;
    state.position[i] = target;
  }
}

TwistBoundary BoundaryConditions::twistBoundary(const State& state, double tip_torque) const
{
  TwistBoundary twist;
  twist.held = boundary_.introducer || boundary_.proximal == EndHold::kClamped;
  twist.tangent = boundary_.direction;
  twist.director = boundary_.director;
  const double clamp = clamped_ == ClampedNodes::kEdge ? 0.5 * rod_.rest_length[0] : 0.0;
  twist.position = boundary_.introducer ? rod_.length() - state.inserted_length : clamp;
  twist.half_width = boundary_.introducer ? kHalfWidth * std::max(boundary_.guide_decay, kShortestDecay) : 0.0;
  twist.rotation = state.rotation;
  twist.tip_torque = tip_torque;
  return twist;
}

TwistBoundary BoundaryConditions::twistBoundary(const State& state, const StepInput& input) const
{
  TwistBoundary twist = twistBoundary(state, input.tip_torque);
  twist.edge_torque = &input.edge_torque;
  twist.tip_held = boundary_.distal == EndHold::kClamped && boundary_.distal_twist_held;
  twist.tip_director = distalRotation(state.distal) * boundary_.director;
  twist.tip_rotation = state.distal.rotation;
  return twist;
}

bool BoundaryConditions::relaxTwist(QuasiStaticTwist& twist, State& state, double tip_torque, PhaseTimer& timer) const
{
  const TwistBoundary boundary = twistBoundary(state, tip_torque);
  if (!QuasiStaticTwist::matters(rod_, boundary))
  {
    std::fill(state.twist_angle.begin() + state.first_node, state.twist_angle.end(), state.rotation);
    state.hand_torque = 0.0;
    return false;
  }
  PhaseTimer::Scope scope(timer, Phase::kTwist);
  twist.solve(rod_, boundary, state);
  return true;
}

void BoundaryConditions::describe(const State& state, contact::Query& query) const
{
  query.first_node = state.first_node;
  while (query.first_node < rod_.nodes() && boundary_.introducer &&
         bodyPosition(query.first_node, state.inserted_length) < 0.0)
    ++query.first_node;
  query.nodes.assign(state.position.begin() + query.first_node, state.position.end());
  query.radius.assign(rod_.radius.begin() + query.first_node, rod_.radius.end());
}

double BoundaryConditions::describeMouth(const State& state, contact::Query& query) const
{
  const int edge = query.first_node - 1;
  if (!boundary_.introducer || query.nodes.empty() || edge < state.first_node)
    return 0.0;
  const double t = -bodyPosition(edge, state.inserted_length) / rod_.rest_length[edge];
  if (t > kLongestHiddenPart)
    return 0.0;
  query.nodes.insert(query.nodes.begin(), (1.0 - t) * state.position[edge] + t * state.position[edge + 1]);
  query.radius.insert(query.radius.begin(), (1.0 - t) * rod_.radius[edge] + t * rod_.radius[edge + 1]);
  query.first_node = edge;
  return t;
}

Energy elasticEnergy(const Discretisation& rod, const State& state, const QuasiStaticTwist* twist)
{
  Energy energy;
  energy.twist = twist ? twist->energy() : 0.0;
  for (int i = state.first_node + 1; i + 1 < rod.nodes(); ++i)
  {
    const Eigen::Vector3d kb = binormalAt(rod, state, i).value;
    double strain = kb.squaredNorm();
    if (twist && i >= twist->firstCurved())
      strain += twist->restCurvature(rod, i).squaredNorm() - 2.0 * kb.dot(twist->restCurvatureBinormal(i));
    energy.bending += 0.5 * rod.bending_stiffness[i] / rod.cell_length[i] * strain;
  }
  for (int j = state.first_node; j + 1 < rod.nodes(); ++j)
    energy.stretch +=
        Stretching(state.position[j + 1] - state.position[j], rod.rest_length[j], rod.axial_stiffness[j]).energy();
  return energy;
}

double outsideInsertion(const Discretisation& rod, double guide_length)
{
  return -guide_length - 2.0 * rod.rest_length.front();
}

double maxInsertion(double length, const Discretisation& rod, double guide_length)
{
  return length - guide_length - 3.0 * rod.rest_length.front();
}

}  // namespace endovascular_sim::rod
