#include "rod/kkt/single_layer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rod/twist/turn_coupling.h"

namespace endovascular_sim::rod
{
namespace
{

void nodeAngles(const std::vector<double>& twist_angle, int first_node, std::vector<double>& angle)
{
  angle.resize(twist_angle.size() + 1);
  for (int i = first_node; i < static_cast<int>(angle.size()); ++i)
    angle[i] = nodeAngle(twist_angle, i, first_node);
}

}  // namespace

State SingleLayer::initialState(const std::vector<LayerInput>& layers) const
{
  if (layers.size() != 1)
    throw std::invalid_argument("SingleLayer: requires one insertion and rotation");
  return initialState(layers.front().inserted_length, layers.front().rotation);
}

State SingleLayer::initialState(double inserted_length, double rotation) const
{
  return model_.conditions.initialState(inserted_length, rotation);
}

bool SingleLayer::advance(State& state, const StepInput& input, double /*dt*/)
{
  initial_twist_ = state.twist_angle;
  std::fill_n(initial_twist_.begin(), state.first_node, state.rotation);  // nodes that this step may bring in
  rotation_before_ = state.rotation;
  const bool turned = state.rotation != input.rotation;
  // A twist that is held at both ends refers to the frames of all edges: writhe turns them.
  const bool held = model_.boundary.distal_twist_held;
  if ((turned && isCurved()) || held)
    frame_turns_.begin(model_.rod, model_.conditions.twistBoundary(state, 0.0), state,
                       held ? 1 : model_.rod.first_curved);
  else
    frame_turns_.neglect();
  return turned;
}

TwistAction SingleLayer::relaxTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                                    PhaseTimer& timer)
{
  TwistBoundary boundary = model_.conditions.twistBoundary(state, input);
  boundary.friction = &friction;
  if (!QuasiStaticTwist::matters(model_.rod, boundary))
  {
    std::fill(state.twist_angle.begin() + state.first_node, state.twist_angle.end(), state.rotation);
    state.hand_torque = state.distal_torque = 0.0;
    return {};
  }
  PhaseTimer::Scope scope(timer, Phase::kTwist);
  twist_.solve(model_.rod, boundary, state);
  return {true, twist_.firstCurved(), twist_.restCurvatureBinormals().data(), twist_.torques().data()};
}

/** The twist energy of a straight wire is quadratic in its angles. Its prediction is therefore a rigid rotation, which
 *  keeps the torques of the last step, and the solve yields the angles. With rest curvature the twist is relaxed
 * before, so that it follows a snap-through. */
TwistAction SingleLayer::predictTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                                      bool first_solve, PhaseTimer& timer)
{
  boundary_ = model_.conditions.twistBoundary(state, input);
  boundary_.friction = &friction;
  if (model_.rod.first_curved < model_.rod.nodes())
    return relaxTwist(state, input, friction, timer);
  PhaseTimer::Scope scope(timer, Phase::kTwist);
  for (std::size_t j = static_cast<std::size_t>(state.first_node); first_solve && j < state.twist_angle.size(); ++j)
    state.twist_angle[j] += input.rotation - rotation_before_;
  twist_.evaluateAt(model_.rod, boundary_, state);
  return {true, twist_.firstCurved(), twist_.restCurvatureBinormals().data(), twist_.torques().data()};
}

void SingleLayer::lineariseTwist(const State& state, SurfaceTwist& twist)
{
  const QuasiStaticTwist::Model model = twist_.linearise(model_.rod, boundary_, state);
  const int n = model_.rod.nodes();
  twist.reset(static_cast<std::size_t>(n - 1));
  for (int j = std::max(twist_.firstUnknown(), state.first_node); j + 1 < n; ++j)
  {
    twist.unknown[j] = 1;
    twist.gradient[j] = model.gradient[j];
    twist.diagonal[j] = model.diagonal[j];
    twist.upper[j] = j + 2 < n ? model.upper[j] : 0.0;
  }
  if (isCurved())
    TurnCoupling(model_.rod, state, twist_.firstCurved(), twist_.restCurvatureBinormals(), twist)
        .addLayer(model_.rod, twist_, 0, nullptr);
  // A node turns by the mean of its edges.
  for (int i = state.first_node; i < n; ++i)
  {
    const int before = std::max(i - 1, state.first_node);
    const int after = std::min(i, n - 2);
    for (const int edge : {before, after})
      if (twist.unknown[edge] != 0)
        twist.weight[i][edge == i ? 1 : 0] += 0.5;
  }
}

void SingleLayer::turnSurface(State& state, const std::vector<double>& turns, double share)
{
  twist_.turn(model_.rod, boundary_, turns, share, state);
}

/** Recomputes the torques for the centreline at the end of the step; the twist angles are restored. */
void SingleLayer::updateTorques(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                                PhaseTimer& timer)
{
  saved_twist_ = state.twist_angle;
  relaxTwist(state, input, friction, timer);
  state.twist_angle.swap(saved_twist_);
}

void SingleLayer::surfaceAngles(const State& state, std::vector<double>& angle) const
{
  nodeAngles(state.twist_angle, state.first_node, angle);
}

void SingleLayer::initialSurfaceAngles(const State& state, std::vector<double>& angle) const
{
  followed_twist_ = initial_twist_;
  const std::vector<double>& turn = frameTurns(state);
  for (std::size_t j = 0; j < turn.size(); ++j)
    followed_twist_[j] -= turn[j];
  nodeAngles(followed_twist_, state.first_node, angle);
}

const std::vector<double>& SingleLayer::frameTurns(const State& state) const
{
  return frame_turns_.since(model_.rod, model_.conditions.twistBoundary(state, 0.0), state);
}

double SingleLayer::restForce(const State& state) const
{
  return model_.rod.first_curved < model_.rod.nodes() ? -twist_.holdForce(model_.rod, state) : 0.0;
}

double SingleLayer::insertionWork(const State& before, const State& after) const
{
  return restForce(after) * (after.inserted_length - before.inserted_length);
}

double SingleLayer::handleWork(const State& before, const State& after) const
{
  return std::abs(after.hand_force * (after.inserted_length - before.inserted_length)) +
         std::abs(after.hand_torque * (after.rotation - before.rotation));
}

void SingleLayer::addElasticEnergy(const State& state, PotentialEnergy& energy)
{
  rod::addElasticEnergy(model_.rod, model_.conditions.twistBoundary(state, 0.0), state, state.twist_angle, energy);
}

Energy SingleLayer::energy(const State& state, const StepInput& input, WallFriction& friction)
{
  State relaxed = state;
  PhaseTimer unused;
  const TwistAction action = relaxTwist(relaxed, input, frictionAtRest(*this, model_.rod, state, friction), unused);
  return elasticEnergy(model_.rod, state, action.active ? &twist_ : nullptr);
}

}  // namespace endovascular_sim::rod
