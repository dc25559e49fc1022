#include "rod/kkt/stack_layers.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/archive.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kTipTolerance = 1e-9;  // m by which a layer may reach further than the reference
constexpr int kFrictionIterations = 3;  // on the friction torques between layers, in one solve

/** A rod with the stack's nodes; its properties are set when the layers are placed. */
Discretisation rodOf(const std::vector<Layer>& layers, const std::vector<double>& position)
{
  const auto longest = std::max_element(
      layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.wire.length() < b.wire.length(); });
  if (longest == layers.end() || position.size() < 3)
    throw std::invalid_argument("StackStepper: at least one layer and three nodes");
  return discretise(longest->wire, position);
}

}  // namespace

StackStepper::StackStepper(const std::vector<Layer>& layers, const std::vector<double>& position, Boundary boundary,
                           Environment environment, StepperSettings settings)
  : KktStepper(rodOf(layers, position), boundary, environment, settings),
    stack_(layers, position),
    twist_(layers.size()),
    twisted_(layers.size(), 0),
    turn_before_(layers.size(), 0.0),
    share_before_(layers.size(), 0.0),
    torque_limit_(layers.size()),
    begin_twist_(layers.size()),
    behind_(layers.size(), 0.0),
    moved_(layers.size(), 0.0),
    gained_(layers.size(), 0.0)
{
  if (boundary.distal_twist_held)
    throw std::invalid_argument("StackStepper: the far end's twist cannot be held");
}

State StackStepper::initialState(const std::vector<LayerInput>& layers) const
{
  if (layers.size() != twist_.size())
    throw std::invalid_argument("StackStepper: one insertion and rotation for every layer");
  const auto furthest =
      std::max_element(layers.begin(), layers.end(),
                       [](const LayerInput& a, const LayerInput& b) { return a.inserted_length < b.inserted_length; });
  State state = KktStepper::initialState(furthest->inserted_length, furthest->rotation);
  state.reference = static_cast<int>(furthest - layers.begin());
  for (const LayerInput& input : layers)
  {
    state.layers.emplace_back();
    state.layers.back().inserted_length = input.inserted_length;
    state.layers.back().rotation = input.rotation;
    state.layers.back().load.assign(state.position.size(), 0.0);
    state.layers.back().twist_angle.assign(state.twist_angle.size(), input.rotation);
  }
  for (int k = 0; k < stack_.count(); ++k)
  {
    const int outer = nextOuter(k, state);
    if (outer >= 0)
      state.layers[k].friction_turn = layers[k].rotation - layers[outer].rotation;
  }
  return state;
}

State StackStepper::initialState(double inserted_length, double rotation) const
{
  std::vector<LayerInput> layers(twist_.size());
  for (LayerInput& layer : layers)
    layer.inserted_length = outside();
  layers.front() = {inserted_length, rotation};
  return initialState(layers);
}

double StackStepper::maxInsertion(int k) const
{
  return stack_.profile(k).length() - boundary().guide_length - 3.0 * stack_rod().rest_length.front();
}

bool StackStepper::resample(const Discretisation& resampled)
{
  KktStepper::resample(resampled);
  stack_.setNodes(resampled.position);
  return true;
}

void StackStepper::archive(Archive& archive, const State& state)
{
  KktStepper::archive(archive, state);
  if (archive.reading())
    place(state);
}

void StackStepper::exchange(State& state, int k, Layer layer)
{
  if (k == state.reference || state.layers[k].inserted_length > outside() + kTipTolerance)
    throw std::invalid_argument("StackStepper: a layer can be exchanged when it is outside and another one is inside");
  if (layer.wire.length() > stack_rod().length() + kTipTolerance)
    throw std::invalid_argument("StackStepper: the new wire is longer than the nodes reach");
  stack_.exchange(k, std::move(layer));
  LayerState& gone = state.layers[k];
  gone.friction_stretch = gone.friction_turn = gone.friction_share = gone.force_offset = gone.speed = 0.0;
}

bool StackStepper::run(State& state, const StepInput& input, double dt, StepReport& report)
{
  if (input.layers.size() != state.layers.size() || state.layers.size() != twist_.size())
    throw std::invalid_argument("StackStepper: one insertion and rotation for every layer");
  int furthest = state.reference;
  for (int k = 0; k < stack_.count(); ++k)
    if (input.layers[k].inserted_length > input.layers[furthest].inserted_length + kTipTolerance)
      furthest = k;
  if (furthest != state.reference)
  {
    changeReference(state, furthest, dt);
    invalidateContacts();
  }
  input_ = input;
  input_.inserted_length = input.layers[state.reference].inserted_length;
  input_.rotation = input.layers[state.reference].rotation;
  if (advance(state, input_, dt, report))
    return true;
  for (LayerState& layer : state.layers)
    layer.speed = 0.0;  // refused: at rest
  return false;
}

/** Before a step in which another layer's tip passes the reference's. The nodes move along the wire to that layer's
 * tip, less than the step's motion, and go on with its material. What the nodes' spacing makes of the layers' forces is
 * not the same for both, so that the difference is left to fade.
 *  @param dt of the step [s] */
void StackStepper::changeReference(State& state, int k, double dt)
{
  const double faster = state.layers[k].speed - state.layers[state.reference].speed;
  moveAlong(state, state.layers[k].inserted_length - state.layers[state.reference].inserted_length);
  for (int i = state.first_node; i < stack_rod().nodes(); ++i)
    state.velocity[i] += faster * tangent(state, i);
  state.reference = k;
  state.inserted_length = state.layers[k].inserted_length;
  state.rotation = state.layers[k].rotation;
  state.twist_angle = state.layers[k].twist_angle;
  for (int m = 0; m < stack_.count(); ++m)
  {
    moved_[m] = dt * state.layers[m].speed;
    gained_[m] = 0.0;
  }
  place(state);
  setSlides(state);
  relaxFromHere(state);
  force_before_.clear();
  for (const LayerState& layer : state.layers)
    force_before_.push_back(layer.hand_force);
  setHandForces(state, dt);
  for (std::size_t m = 0; m < force_before_.size(); ++m)
  {
    state.layers[m].force_offset += force_before_[m] - state.layers[m].hand_force;
    state.layers[m].hand_force = force_before_[m];
  }
}

/** Moves the nodes along the wire by a short distance [m]. */
void StackStepper::moveAlong(State& state, double distance) const
{
  const int last = stack_rod().nodes() - 1;
  // The tangent at the tip is as far from the last edge's direction as that is from the tangent before.
  const Eigen::Vector3d at_tip = 2.0 * tangent(state, last) - tangent(state, last - 1);
  Eigen::Vector3d along = tangent(state, state.first_node);
  for (int i = state.first_node; i <= last; ++i)
  {
    const Eigen::Vector3d next = i + 1 < last ? tangent(state, i + 1) : at_tip;
    state.position[i] += distance * along;
    along = next;
  }
}

Eigen::Vector3d StackStepper::tangent(const State& state, int node) const
{
  const int before = std::max(state.first_node, node - 1);
  const int after = std::min(stack_rod().nodes() - 1, node + 1);
  return (state.position[after] - state.position[before]).normalized();
}

void StackStepper::place(const State& state)
{
  for (int k = 0; k < stack_.count(); ++k)
    behind_[k] = std::max(0.0, state.layers[state.reference].inserted_length - state.layers[k].inserted_length);
  stack_.place(behind_, rod());
}

/** How the layers move over the nodes in a step, which follow the reference. */
void StackStepper::setSlides(const State& state)
{
  surface_slide_.resize(state.position.size());
  mass_slide_.resize(state.position.size());
  slides_ = false;
  const double travel = moved_[state.reference];
  const double gained = gained_[state.reference];
  for (int k = 0; k < stack_.count(); ++k)
    slides_ = slides_ || moved_[k] != travel || gained_[k] != gained;
  for (int i = state.first_node; slides_ && i < stack_rod().nodes(); ++i)
  {
    const double surface = moved_[stack_.surfaceLayer(i)] - travel;
    double mass = 0.0;
    double mass_gained = 0.0;
    for (int k = 0; k < stack_.count(); ++k)
    {
      const double share = stack_.profile(k).rod().mass[i] / stack_rod().mass[i];
      mass += share * (moved_[k] - travel);
      mass_gained += share * (gained_[k] - gained);
    }
    const Eigen::Vector3d along = tangent(state, i);
    surface_slide_[i] = surface * along;
    mass_slide_[i] = {mass * along, mass_gained * along};
  }
  // Nodes that the step brings to the introducer.
  std::fill_n(surface_slide_.begin(), state.first_node, surface_slide_[state.first_node]);
  std::fill_n(mass_slide_.begin(), state.first_node, mass_slide_[state.first_node]);
}

void StackStepper::refreshRod(State& state, const StepInput& input, double dt)
{
  for (int k = 0; k < stack_.count(); ++k)
  {
    moved_[k] = input.layers[k].inserted_length - state.layers[k].inserted_length;
    gained_[k] = moved_[k] - dt * state.layers[k].speed;
  }
  place(state);  // where the last step, of any stepper, left the layers
  setSlides(state);
  dragLayers(state, input);
  for (int k = 0; k < stack_.count(); ++k)
  {
    LayerState& layer = state.layers[k];
    begin_twist_[k] = layer.twist_angle;
    std::fill_n(begin_twist_[k].begin(), state.first_node, layer.rotation);
    layer.inserted_length = input.layers[k].inserted_length;
    layer.rotation = input.layers[k].rotation;
  }
  place(state);
}

/** Torque from outside about the axis of every edge of a layer: what the step's input gives to the outermost, and
 *  friction between layers.
 *  @return false when there is none */
bool StackStepper::setEdgeTorque(int k, const State& state, const StepInput& input)
{
  bool any = !input.edge_torque.empty();
  edge_torque_.assign(state.twist_angle.size(), 0.0);
  for (std::size_t j = 0; any && j < edge_torque_.size(); ++j)
  {
    const int node = static_cast<int>(j);
    edge_torque_[j] = 0.5 * (stack_.outerShare(k, node) + stack_.outerShare(k, node + 1)) * input.edge_torque[j];
  }
  for (int m = 0; m < stack_.count(); ++m)
  {
    const double share = state.layers[m].friction_share;
    const double sign = m == k ? -share : nextOuter(m, state) == k ? share : 0.0;
    if (sign == 0.0 || !sticks(m, state))
      continue;
    any = true;
    for (std::size_t j = 0; j < edge_torque_.size(); ++j)
      edge_torque_[j] += sign * torque_limit_[m][j];
  }
  return any;
}

/** Twist of one layer over the shared centreline.
 *  @param again the centreline is that of the last call
 *  @return whether it acts on the centreline */
bool StackStepper::relaxLayer(int k, State& state, TwistBoundary boundary, const StepInput& input,
                              const std::vector<TwistFriction>& friction, bool again)
{
  setLayerFriction(k, friction);
  boundary.friction = &layer_friction_;
  LayerState& layer = state.layers[k];
  const Discretisation& rod = stack_.profile(k).rod();
  boundary.rotation = layer.rotation;
  boundary.tip_torque = k == state.reference ? input.tip_torque : 0.0;
  boundary.edge_torque = setEdgeTorque(k, state, input) ? &edge_torque_ : nullptr;
  if (rod.nodes() < state.first_node + 3 || !QuasiStaticTwist::matters(rod, boundary))
  {
    std::fill(layer.twist_angle.begin() + state.first_node, layer.twist_angle.end(), layer.rotation);
    layer.hand_torque = 0.0;
    return false;
  }
  std::swap(state.twist_angle, layer.twist_angle);
  twist_[k].solve(rod, boundary, state, again && twisted_[k]);
  layer.hand_torque = state.hand_torque;
  std::swap(state.twist_angle, layer.twist_angle);
  const auto last = layer.twist_angle.begin() + (rod.nodes() - 2);
  std::fill(last + 1, layer.twist_angle.end(), *last);
  return true;
}

/** The wall holds the layer that it touches. */
void StackStepper::setLayerFriction(int k, const std::vector<TwistFriction>& friction)
{
  layer_friction_.clear();
  for (const TwistFriction& whole : friction)
    if (stack_.surfaceLayer(whole.node) == k)
      layer_friction_.push_back(whole);
}

void StackStepper::surfaceAngles(const State& state, std::vector<double>& angle) const
{
  angle.assign(state.position.size(), 0.0);
  for (int i = state.first_node; i < stack_rod().nodes(); ++i)
    angle[i] = nodeAngle(state.layers[stack_.surfaceLayer(i)].twist_angle, i, state.first_node);
}

void StackStepper::surfaceBeginAngles(const State& state, std::vector<double>& angle) const
{
  angle.assign(state.position.size(), 0.0);
  for (int i = state.first_node; i < stack_rod().nodes(); ++i)
    angle[i] = nodeAngle(begin_twist_[stack_.surfaceLayer(i)], i, state.first_node);
}

/** Brings the twists of a state to rest that does not move any more. */
void StackStepper::relaxFromHere(State& state)
{
  for (int k = 0; k < stack_.count(); ++k)
    begin_twist_[k] = state.layers[k].twist_angle;
  relaxTwist(state, lastInput(), frictionAtRest(state));
}

/** At a fixed centreline no layer's twist depends on another's, but for the friction between them. */
KktStepper::TwistAction StackStepper::relaxTwist(State& state, const StepInput& input,
                                                 const std::vector<TwistFriction>& friction)
{
  const TwistBoundary boundary = conditions().twistBoundary(state, input);
  setTorqueLimits(state);
  for (int iteration = 0; iteration < kFrictionIterations; ++iteration)
  {
    for (int k = 0; k < stack_.count(); ++k)
      twisted_[k] = relaxLayer(k, state, boundary, input, friction, iteration > 0);
    if (iteration + 1 == kFrictionIterations || !turnLayers(state, boundary.position, iteration == 0))
      break;
  }
  double torque = 0.0;
  for (const LayerState& layer : state.layers)
    torque += layer.hand_torque;
  std::copy(state.layers[state.reference].twist_angle.begin(), state.layers[state.reference].twist_angle.end(),
            state.twist_angle.begin());
  state.hand_torque = torque;
  state.distal_torque = 0.0;
  first_curved_ = stack_rod().nodes();
  if (std::find(twisted_.begin(), twisted_.end(), 1) == twisted_.end())
    return {};
  combineTwists(state);
  return {true, first_curved_, rest_binormal_.data(), torque_.data()};
}

bool StackStepper::turns(const State& state, const StepInput& input) const
{
  for (int k = 0; k < stack_.count(); ++k)
    if (state.layers[k].rotation != input.layers[k].rotation)
      return true;
  return false;
}

void StackStepper::renewTorques(State& state, const StepInput& input)
{
  relaxed_ = state;
  relaxTwist(relaxed_, input, frictionAboutAxis());
  for (int k = 0; k < stack_.count(); ++k)
    state.layers[k].hand_torque = relaxed_.layers[k].hand_torque;
  state.hand_torque = relaxed_.hand_torque;
}

/** The rest curvature of all layers together, weighted with their stiffnesses, and the sum of their torques. */
void StackStepper::combineTwists(const State& state)
{
  const int n = stack_rod().nodes();
  rest_binormal_.resize(n);
  torque_.assign(n, 0.0);
  for (int k = 0; k < stack_.count(); ++k)
    if (twisted_[k])
      first_curved_ = std::min(first_curved_, twist_[k].firstCurved());
  for (int i = first_curved_; i < n; ++i)
    rest_binormal_[i].setZero();
  for (int k = 0; k < stack_.count(); ++k)
  {
    if (!twisted_[k])
      continue;
    const Discretisation& layer = stack_.profile(k).rod();
    for (int i = state.first_node; i + 1 < layer.nodes(); ++i)
      torque_[i] += twist_[k].torque(i);
    for (int i = twist_[k].firstCurved(); i + 1 < layer.nodes(); ++i)
      rest_binormal_[i] +=
          (layer.bending_stiffness[i] / stack_rod().bending_stiffness[i]) * twist_[k].restCurvatureBinormal(i);
  }
}

}  // namespace endovascular_sim::rod
