#include "rod/kkt/layer_stack.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rod/boundary/boundary_conditions.h"
#include "rod/twist/turn_coupling.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kTipTolerance = 1e-9;  // excess length of a layer over the reference [m]
constexpr int kFrictionIterations = 3;  // on the friction torques between layers, in one solve
constexpr double kOffsetTime = 0.1;     // s in which an offset of a handle's force fades to 1/e
constexpr double kNoOffset = 1e-9;      // N
constexpr int kYieldBisections = 12;    // of the friction that bounded handles leave

}  // namespace

LayerStack::LayerStack(const std::vector<Layer>& layers, KktModel& model)
  : model_(model),
    stack_(layers, model.rod.position),
    twists_(static_cast<int>(layers.size())),
    friction_(stack_, model),
    forces_(stack_, model, twists_),
    initial_twist_(layers.size()),
    motion_(layers.size()),
    behind_(layers.size(), 0.0),
    turn_(layers.size(), 0.0)
{
  if (model.boundary.distal_twist_held)
    throw std::invalid_argument("LayerStack: the twist of the distal end cannot be held");
}

State LayerStack::initialState(const std::vector<LayerInput>& layers) const
{
  if (layers.size() != motion_.size())
    throw std::invalid_argument("LayerStack: requires one insertion and rotation for every layer");
  const auto furthest =
      std::max_element(layers.begin(), layers.end(),
                       [](const LayerInput& a, const LayerInput& b) { return a.inserted_length < b.inserted_length; });
  State state = model_.conditions.initialState(furthest->inserted_length, furthest->rotation);
  state.reference = static_cast<int>(furthest - layers.begin());
  for (const LayerInput& input : layers)
  {
    state.layers.emplace_back();
    state.layers.back().inserted_length = input.inserted_length;
    state.layers.back().rotation = input.rotation;
    state.layers.back().load.assign(state.position.size(), 0.0);
    state.layers.back().bore_shift.assign(state.position.size(), Eigen::Vector3d::Zero());
    state.layers.back().twist_angle.assign(state.twist_angle.size(), input.rotation);
  }
  for (int k = 0; k < stack_.count(); ++k)
  {
    const int outer = friction_.nextOuter(k, state);
    if (outer >= 0)
      state.layers[k].friction_turn = layers[k].rotation - layers[outer].rotation;
  }
  return state;
}

State LayerStack::initialState(double inserted_length, double rotation) const
{
  std::vector<LayerInput> layers(motion_.size());
  for (LayerInput& layer : layers)
    layer.inserted_length = outsideInsertion(model_.rod, model_.boundary.guide_length);
  layers.front() = {inserted_length, rotation};
  return initialState(layers);
}

bool LayerStack::beginStep(State& state, const StepInput& input, double dt, WallFriction& friction)
{
  if (input.layers.size() != state.layers.size() || state.layers.size() != motion_.size())
    throw std::invalid_argument("LayerStack: requires one insertion and rotation for every layer");
  input_.drags = input.drags;
  input_.forces = input.forces;
  int furthest = state.reference;
  for (int k = 0; k < stack_.count(); ++k)
    if (input.layers[k].inserted_length > input.layers[furthest].inserted_length + kTipTolerance)
      furthest = k;
  if (furthest == state.reference)
    return false;
  changeReference(state, furthest, input, dt, friction);
  return true;
}

const StepInput& LayerStack::centrelineInput(const State& state, const StepInput& input)
{
  input_ = input;
  input_.inserted_length = input.layers[state.reference].inserted_length;
  input_.rotation = input.layers[state.reference].rotation;
  return input_;
}

void LayerStack::stop(State& state)
{
  for (LayerState& layer : state.layers)
    layer.speed = 0.0;
  place(state);  // the rejected step has placed the layers at its end
}

/** Changes the reference before a step in which another layer's tip passes that of the present one. The nodes move
 *  along the wire to the tip of the new reference, by less than the motion of the step, and then follow its material.
 *  The layers' forces depend slightly on the positions of the nodes; the difference fades.
 *  @param dt of the step [s] */
void LayerStack::changeReference(State& state, int k, const StepInput& input, double dt, WallFriction& friction)
{
  const double faster = state.layers[k].speed - state.layers[state.reference].speed;
  moveAlong(state, state.layers[k].inserted_length - state.layers[state.reference].inserted_length);
  for (int i = state.first_node; i < model_.rod.nodes(); ++i)
    state.velocity[i] += faster * tangentAt(state, i);
  state.reference = k;
  state.inserted_length = state.layers[k].inserted_length;
  state.rotation = state.layers[k].rotation;
  state.twist_angle = state.layers[k].twist_angle;
  for (int m = 0; m < stack_.count(); ++m)
    motion_[m] = {dt * state.layers[m].speed, 0.0};
  place(state);
  updateSlides(state);
  relaxAtRest(state, input, friction);
  force_before_.clear();
  for (const LayerState& layer : state.layers)
    force_before_.push_back(layer.hand_force);
  updateHandForces(state, dt);
  for (std::size_t m = 0; m < force_before_.size(); ++m)
  {
    state.layers[m].force_offset += force_before_[m] - state.layers[m].hand_force;
    state.layers[m].hand_force = force_before_[m];
  }
}

/** Moves the nodes along the wire by a short distance [m]. */
void LayerStack::moveAlong(State& state, double distance) const
{
  const int last = model_.rod.nodes() - 1;
  // Linear extrapolation: the last edge's direction is the mean of the tangents at its two nodes.
  const Eigen::Vector3d at_tip = 2.0 * tangentAt(state, last) - tangentAt(state, last - 1);
  Eigen::Vector3d along = tangentAt(state, state.first_node);
  for (int i = state.first_node; i <= last; ++i)
  {
    const Eigen::Vector3d next = i + 1 < last ? tangentAt(state, i + 1) : at_tip;
    state.position[i] += distance * along;
    along = next;
  }
}

void LayerStack::place(const State& state)
{
  for (int k = 0; k < stack_.count(); ++k)
    behind_[k] = std::max(0.0, state.layers[state.reference].inserted_length - state.layers[k].inserted_length);
  stack_.place(behind_, model_.rod);
}

void LayerStack::updateSlides(const State& state)
{
  slides_.surface.resize(state.position.size());
  slides_.mass.resize(state.position.size());
  sliding_ = false;
  const LayerMotion reference = motion_[state.reference];
  for (const LayerMotion& layer : motion_)
    sliding_ = sliding_ || layer.travel != reference.travel || layer.gained != reference.gained;
  for (int i = state.first_node; sliding_ && i < model_.rod.nodes(); ++i)
  {
    const double surface = motion_[stack_.surfaceLayer(i)].travel - reference.travel;
    double mass = 0.0;
    double mass_gained = 0.0;
    for (int k = 0; k < stack_.count(); ++k)
    {
      const double share = stack_.profile(k).rod().mass[i] / model_.rod.mass[i];
      mass += share * (motion_[k].travel - reference.travel);
      mass_gained += share * (motion_[k].gained - reference.gained);
    }
    const Eigen::Vector3d along = tangentAt(state, i);
    slides_.surface[i] = surface * along;
    slides_.mass[i] = {mass * along, mass_gained * along};
  }
  // Nodes that the step brings to the introducer.
  std::fill_n(slides_.surface.begin(), state.first_node, slides_.surface[state.first_node]);
  std::fill_n(slides_.mass.begin(), state.first_node, slides_.mass[state.first_node]);
}

bool LayerStack::advance(State& state, const StepInput& input, double dt)
{
  bool turned = false;
  for (int k = 0; k < stack_.count(); ++k)
  {
    turn_[k] = input.layers[k].rotation - state.layers[k].rotation;
    turned = turned || state.layers[k].rotation != input.layers[k].rotation;
    motion_[k].travel = input.layers[k].inserted_length - state.layers[k].inserted_length;
    motion_[k].gained = motion_[k].travel - dt * state.layers[k].speed;
  }
  place(state);  // at the positions of the last step, which another stepper may have done
  if (turned && isCurved())
    frame_turns_.begin(model_.rod, model_.conditions.twistBoundary(state, 0.0), state, firstCurved());
  else
    frame_turns_.neglect();
  updateSlides(state);
  friction_.drag(state, input);
  for (int k = 0; k < stack_.count(); ++k)
  {
    LayerState& layer = state.layers[k];
    initial_twist_[k] = layer.twist_angle;
    std::fill_n(initial_twist_[k].begin(), state.first_node, layer.rotation);
    layer.inserted_length = input.layers[k].inserted_length;
    layer.rotation = input.layers[k].rotation;
  }
  place(state);
  return turned;
}

/** Sets the torques about the axis of a layer's edges: those of the input on the outermost layer, and friction between
 *  layers.
 *  @return false when there are none */
bool LayerStack::setEdgeTorque(int k, const State& state, const StepInput& input)
{
  const bool outside = !input.edge_torque.empty();
  if (!outside && !friction_.hasTorques(k, state))
    return false;
  edge_torque_.assign(state.twist_angle.size(), 0.0);
  for (std::size_t j = 0; outside && j < edge_torque_.size(); ++j)
  {
    const int node = static_cast<int>(j);
    edge_torque_[j] = 0.5 * (stack_.outerShare(k, node) + stack_.outerShare(k, node + 1)) * input.edge_torque[j];
  }
  friction_.addTorques(k, state, edge_torque_);
  return true;
}

/** Boundary of one layer's twist. The wall holds the layer that it touches.
 *  @param boundary of the reference */
TwistBoundary LayerStack::layerBoundary(int k, const TwistBoundary& boundary, const State& state,
                                        const StepInput& input, const std::vector<TwistFriction>& friction)
{
  layer_friction_.clear();
  for (const TwistFriction& at_node : friction)
    if (stack_.surfaceLayer(at_node.node) == k)
      layer_friction_.push_back(at_node);
  TwistBoundary layer = boundary;
  layer.friction = &layer_friction_;
  layer.rotation = state.layers[k].rotation;
  layer.tip_torque = k == state.reference ? input.tip_torque : 0.0;
  layer.edge_torque = setEdgeTorque(k, state, input) ? &edge_torque_ : nullptr;
  return layer;
}

TwistAction LayerStack::relaxTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                                   PhaseTimer& timer)
{
  PhaseTimer::Scope scope(timer, Phase::kTwist);
  const TwistBoundary boundary = model_.conditions.twistBoundary(state, input);
  friction_.updateTorqueLimits(state);
  for (int iteration = 0; iteration < kFrictionIterations; ++iteration)
  {
    for (int k = 0; k < stack_.count(); ++k)
      twists_.relax(k, stack_.profile(k).rod(), layerBoundary(k, boundary, state, input, friction), state,
                    iteration > 0);
    if (iteration + 1 == kFrictionIterations || !friction_.updateTorques(state, boundary.position, iteration == 0))
      break;
  }
  sumTwists(state);
  return twists_.combine(stack_, model_.rod, state);
}

/** Sets the twist of the centreline to that of the reference, and its torque to the sum over the layers. */
void LayerStack::sumTwists(State& state) const
{
  double torque = 0.0;
  for (const LayerState& layer : state.layers)
    torque += layer.hand_torque;
  std::copy(state.layers[state.reference].twist_angle.begin(), state.layers[state.reference].twist_angle.end(),
            state.twist_angle.begin());
  state.hand_torque = torque;
  state.distal_torque = 0.0;
}

/** A single straight layer is predicted as a SingleLayer is. Several layers are relaxed, with the friction between
 *  them. */
TwistAction LayerStack::predictTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                                     bool first_solve, PhaseTimer& timer)
{
  boundary_ = model_.conditions.twistBoundary(state, input);
  wall_friction_ = &friction;
  if (stack_.count() > 1 || stack_.profile(0).rod().first_curved < model_.rod.nodes())
    return relaxTwist(state, input, friction, timer);
  PhaseTimer::Scope scope(timer, Phase::kTwist);
  twists_.rotate(0, stack_.profile(0).rod(), layerBoundary(0, boundary_, state, input_, friction),
                 first_solve ? turn_[0] : 0.0, state);
  sumTwists(state);
  return twists_.combine(stack_, model_.rod, state);
}

int LayerStack::firstCurved() const
{
  int first = model_.rod.nodes();
  for (int k = 0; k < stack_.count(); ++k)
    if (stack_.profile(k).rod().first_curved < stack_.profile(k).rod().nodes())
      first = std::min(first, stack_.profile(k).rod().first_curved);
  return first;
}

/** Layer whose turn is the unknown of an edge: that on the surface at the edge's distal node, or a curved layer inside
 *  it whose handle turns while that of the surface rests. */
int LayerStack::turningLayer(int edge) const
{
  const int surface = stack_.surfaceLayer(edge + 1);
  for (int k = 0; turn_[surface] == 0.0 && k < surface; ++k)
    if (turn_[k] != 0.0 && edge + 1 < stack_.profile(k).rod().nodes() &&
        edge + 1 >= stack_.profile(k).rod().first_curved)
      return k;
  return surface;
}

/** A node at whose distal edge another layer begins turns with its proximal edge. */
void LayerStack::lineariseTwist(const State& state, SurfaceTwist& twist)
{
  const int n = model_.rod.nodes();
  twist.reset(static_cast<std::size_t>(n - 1));
  edge_layer_.assign(static_cast<std::size_t>(n - 1), 0);
  for (int j = state.first_node; j + 1 < n; ++j)
    edge_layer_[j] = turningLayer(j);
  relaxed_ = state;
  for (int k = 0; k < stack_.count(); ++k)
    twists_.linearise(k, stack_.profile(k).rod(), layerBoundary(k, boundary_, state, input_, *wall_friction_), relaxed_,
                      edge_layer_, twist);
  if (isCurved())
  {
    TurnCoupling coupling(model_.rod, state, twists_.firstCurved(), twists_.restBinormals(), twist);
    for (int k = 0; k < stack_.count(); ++k)
      if (twists_.isActive(k))
        coupling.addLayer(stack_.profile(k).rod(), twists_.of(k), k, &edge_layer_);
  }
  for (int i = state.first_node; i < n; ++i)
  {
    const int before = std::max(i - 1, state.first_node);
    int after = std::min(i, n - 2);
    if (edge_layer_[after] != edge_layer_[before])
      after = before;
    for (const int edge : {before, after})
      if (twist.unknown[edge] != 0 && edge_layer_[edge] == stack_.surfaceLayer(i))
        twist.weight[i][edge == i ? 1 : 0] += 0.5;
  }
}

void LayerStack::turnSurface(State& state, const std::vector<double>& turns, double share)
{
  for (int k = 0; k < stack_.count(); ++k)
    twists_.turn(k, stack_.profile(k).rod(), layerBoundary(k, boundary_, state, input_, *wall_friction_), turns, share,
                 state);
  sumTwists(state);
}

void LayerStack::updateTorques(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                               PhaseTimer& timer)
{
  relaxed_ = state;
  relaxTwist(relaxed_, input, friction, timer);
  for (int k = 0; k < stack_.count(); ++k)
    state.layers[k].hand_torque = relaxed_.layers[k].hand_torque;
  state.hand_torque = relaxed_.hand_torque;
}

/** Relaxes the twists of a state that does not move. */
void LayerStack::relaxAtRest(State& state, const StepInput& input, WallFriction& friction)
{
  PhaseTimer unused;
  for (int k = 0; k < stack_.count(); ++k)
    initial_twist_[k] = state.layers[k].twist_angle;
  relaxTwist(state, input, frictionAtRest(*this, model_.rod, state, friction), unused);
}

double LayerStack::restForce(const State& state) const
{
  double force = 0.0;
  for (int k = 0; k < stack_.count(); ++k)
    if (twists_.isActive(k))
      force -= twists_.of(k).holdForce(stack_.profile(k).rod(), state);
  return force;
}

void LayerStack::surfaceAngles(const State& state, std::vector<double>& angle) const
{
  angle.assign(state.position.size(), 0.0);
  for (int i = state.first_node; i < model_.rod.nodes(); ++i)
    angle[i] = nodeAngle(state.layers[stack_.surfaceLayer(i)].twist_angle, i, state.first_node);
}

void LayerStack::initialSurfaceAngles(const State& state, std::vector<double>& angle) const
{
  angle.assign(state.position.size(), 0.0);
  const std::vector<double>& turn = frameTurns(state);
  if (!turn.empty())
    followed_twist_ = initial_twist_;
  for (std::size_t j = 0; j < turn.size(); ++j)
    for (std::vector<double>& twist : followed_twist_)
      twist[j] -= turn[j];
  const std::vector<std::vector<double>>& followed = turn.empty() ? initial_twist_ : followed_twist_;
  for (int i = state.first_node; i < model_.rod.nodes(); ++i)
    angle[i] = nodeAngle(followed[stack_.surfaceLayer(i)], i, state.first_node);
}

const std::vector<double>& LayerStack::frameTurns(const State& state) const
{
  return frame_turns_.since(model_.rod, model_.conditions.twistBoundary(state, 0.0), state);
}

/** Updates the forces on the handles of a state whose twist has been relaxed. That of the reference is the remainder of
 *  the force on the whole stack. */
void LayerStack::updateHandForces(State& state, double dt) const
{
  for (int k = 0; k < stack_.count(); ++k)
  {
    LayerState& layer = state.layers[k];
    layer.hand_force = layer.force_offset;
    if (k != state.reference)
      layer.hand_force += forces_.gradient(k, state) + forces_.wedging(k, state) + forces_.wallDrag(k, state) +
                          forces_.motionDrag(k, motion_[k], slides(), state, dt) +
                          forces_.streamDrag(k, input_.drags, slides(), state, dt) +
                          InsertionForces::loads(k, input_.forces, state);
  }
  for (int k = 0; k < stack_.count(); ++k)
  {
    const int outer = friction_.nextOuter(k, state);
    if (outer < 0)
      continue;
    const double force = friction_.axialForce(k, outer, state);
    state.layers[k].hand_force += force;
    state.layers[outer].hand_force -= force;
  }
  double others = 0.0;
  for (int k = 0; k < stack_.count(); ++k)
    others += k == state.reference ? 0.0 : state.layers[k].hand_force;
  state.layers[state.reference].hand_force = state.hand_force - others;
}

bool LayerStack::isBeyondBound(const State& state) const
{
  for (std::size_t k = 0; k < state.layers.size(); ++k)
    if (std::abs(state.layers[k].hand_force) > input_.layers[k].most_force)
      return true;
  return false;
}

/** Reduces the stretches of the friction between layers by a common factor, so that no handle bears more than its
 *  bound: the layers creep in each other. The sum over the handles is not changed. Near the lock-up of a wire in its
 *  bore, the friction turns by a slip of some micrometres, for which no position of a hand may be found. */
void LayerStack::yieldToBounds(State& state, double dt)
{
  if (!isBeyondBound(state))
    return;
  std::vector<double> stretch;
  for (const LayerState& layer : state.layers)
    stretch.push_back(layer.friction_stretch);
  const auto apply = [&](double share)
  {
    for (std::size_t k = 0; k < stretch.size(); ++k)
      state.layers[k].friction_stretch = share * stretch[k];
    friction_.updateLoads(state, twists_);
    updateHandForces(state, dt);
  };
  double within = 0.0;
  double beyond = 1.0;
  for (int k = 0; k < kYieldBisections; ++k)
  {
    const double share = 0.5 * (within + beyond);
    apply(share);
    (isBeyondBound(state) ? beyond : within) = share;
  }
  apply(within);
}

void LayerStack::finish(State& state, double dt)
{
  if (stack_.count() == 1)
  {
    state.layers[0].hand_force = state.hand_force;
    return;
  }
  for (int k = 0; k < stack_.count(); ++k)
    state.layers[k].speed = motion_[k].travel / dt;
  const double left = std::exp(-dt / kOffsetTime);
  for (LayerState& layer : state.layers)
    layer.force_offset = std::abs(layer.force_offset) < kNoOffset ? 0.0 : left * layer.force_offset;
  friction_.updateLoads(state, twists_);
  friction_.settle(state);
  updateHandForces(state, dt);
  yieldToBounds(state, dt);
}

Energy LayerStack::energy(const State& state, const StepInput& input, WallFriction& friction)
{
  State relaxed = state;
  place(state);
  relaxAtRest(relaxed, input, friction);
  Energy sum;
  for (int k = 0; k < stack_.count(); ++k)
  {
    const Discretisation& layer = stack_.profile(k).rod();
    if (layer.nodes() < state.first_node + 3)
      continue;
    const Energy energy = elasticEnergy(layer, state, twists_.isActive(k) ? &twists_.of(k) : nullptr);
    sum.bending += energy.bending;
    sum.twist += energy.twist;
    sum.stretch += energy.stretch;
  }
  return sum;
}

void LayerStack::addElasticEnergy(const State& state, PotentialEnergy& energy)
{
  place(state);
  TwistBoundary hold = model_.conditions.twistBoundary(state, 0.0);
  for (int k = 0; k < stack_.count(); ++k)
  {
    hold.rotation = state.layers[k].rotation;
    rod::addElasticEnergy(stack_.profile(k).rod(), hold, state, state.layers[k].twist_angle, energy);
  }
}

LayerFrictionWork LayerStack::frictionWork(const State& before, const State& after) const
{
  LayerFrictionWork work;
  for (int k = 0; k < stack_.count(); ++k)
  {
    const int outer = friction_.nextOuter(k, after);
    if (outer < 0)
      continue;
    const auto travel = [&](int m) { return after.layers[m].inserted_length - before.layers[m].inserted_length; };
    work.push += friction_.axialForce(k, outer, after) * (travel(k) - travel(outer));
    work.turn += friction_.turnWork(k, outer, before, after);
  }
  return work;
}

double LayerStack::insertionWork(const State& before, const State& after) const
{
  const auto travel = [&](int m) { return after.layers[m].inserted_length - before.layers[m].inserted_length; };
  double work = restForce(after) * travel(after.reference);
  for (int k = 0; k < stack_.count(); ++k)
    if (k != after.reference && travel(k) != travel(after.reference))
      work += forces_.gradient(k, after) * (travel(k) - travel(after.reference));
  return work;
}

double LayerStack::handleWork(const State& before, const State& after) const
{
  double work = 0.0;
  for (std::size_t k = 0; k < after.layers.size(); ++k)
  {
    const LayerState& layer = after.layers[k];
    work += std::abs(layer.hand_force * (layer.inserted_length - before.layers[k].inserted_length)) +
            std::abs(layer.hand_torque * (layer.rotation - before.layers[k].rotation));
  }
  return work;
}

}  // namespace endovascular_sim::rod
