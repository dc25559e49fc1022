#include <algorithm>
#include <cmath>

#include "rod/kkt/stack_layers.h"
#include "rod/model/node_curvature.h"

// Friction between the layers of a stack, along the wire and about its axis. Inextensible layers on one centreline
// slide in each other by the same length everywhere, so that along the wire one stretch per pair of neighbours sticks
// or slides. About the axis a pair sticks at a mean angle between both, weighted with the friction.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLayerSlip = 20e-6;     // m that a layer is dragged in the next one before it slides
constexpr double kTurnTolerance = 1e-4;  // rad that stuck layers may turn on each other: 0.006°
// Bounds of how far a share of the friction turns a pair, against straight layers that nothing else holds.
constexpr double kLeastResponse = 0.2;
constexpr double kMostResponse = 3.0;
constexpr double kLeastTorque = 1e-12;  // N·m: a pair with less friction does not stick

}  // namespace

/** The next layer outside of one that is in the body too; −1 without. */
int StackStepper::nextOuter(int k, const State& state) const
{
  for (int m = k + 1; m < stack_.count() && state.layers[k].inserted_length > 0.0; ++m)
    if (state.layers[m].inserted_length > 0.0)
      return m;
  return -1;
}

void StackStepper::dragLayers(State& state, const StepInput& input) const
{
  for (int k = 0; k < stack_.count(); ++k)
  {
    LayerState& layer = state.layers[k];
    const int outer = nextOuter(k, state);
    const double pushed = input.layers[k].inserted_length - layer.inserted_length;
    const double carried = outer < 0 ? 0.0 : input.layers[outer].inserted_length - state.layers[outer].inserted_length;
    const double stretch = layer.friction_stretch + pushed - carried;
    layer.friction_stretch = outer < 0 ? 0.0 : std::max(-kLayerSlip, std::min(kLayerSlip, stretch));
  }
}

/** Loads between neighbours: what bends a layer, with those inside it, otherwise than it would bend on its own. */
void StackStepper::setLoads(State& state)
{
  int last = -1;  // layer that any friction is asked for
  for (int k = 0; k < stack_.count(); ++k)
    if (nextOuter(k, state) >= 0 && stack_.layer(k).friction > 0.0)
      last = k;
  if (last < 0)
    return;
  binormal_.resize(state.position.size());
  for (int i = state.first_node + 1; i + 1 < stack_rod().nodes(); ++i)
    binormal_[i] = binormalAt(stack_rod(), state, i).value;
  moment_.assign(state.position.size(), Eigen::Vector3d::Zero());
  for (int k = 0; k <= last; ++k)
  {
    addMoments(k, state);
    const int outer = nextOuter(k, state);
    if (outer >= 0 && stack_.layer(k).friction > 0.0)
      setLoad(state.layers[k].load, std::min(stack_rod().nodes() - 1, stack_.profile(outer).rod().nodes()), state);
  }
}

/** Adds the moments that bend a layer to those of the layers inside it. */
void StackStepper::addMoments(int k, const State& state)
{
  const Discretisation& layer = stack_.profile(k).rod();
  for (int i = state.first_node + 1; i + 1 < stack_rod().nodes(); ++i)
  {
    Eigen::Vector3d strain = binormal_[i];
    if (twisted_[k] && i >= twist_[k].firstCurved() && i + 1 < layer.nodes())
      strain -= twist_[k].restCurvatureBinormal(i);
    moment_[i] += (layer.bending_stiffness[i] / layer.cell_length[i]) * strain;
  }
}

/** @param end node before which the outer layer ends */
void StackStepper::setLoad(std::vector<double>& load, int end, const State& state) const
{
  std::fill(load.begin(), load.end(), 0.0);
  for (int i = state.first_node + 1; i < end; ++i)
  {
    const Eigen::Vector3d after = i + 1 < end ? moment_[i + 1] : Eigen::Vector3d::Zero();
    const Eigen::Vector3d force = (after - moment_[i]) / stack_rod().rest_length[i] -
                                  (moment_[i] - moment_[i - 1]) / stack_rod().rest_length[i - 1];
    load[i] = force.norm() / stack_rod().cell_length[i];
  }
}

void StackStepper::setBodyShares(const State& state)
{
  body_share_.assign(state.position.size(), 1.0);
  const double introducer = stack_rod().length() - state.inserted_length;
  for (int i = state.first_node + 1; boundary().introducer && i + 1 < stack_rod().nodes(); ++i)
  {
    body_share_[i] = stack_rod().shareBeyond(i, introducer);
    if (body_share_[i] >= 1.0)
      break;
  }
}

/** Normal force between two neighbours at a node [N]. */
double StackStepper::load(int k, int outer, int node, const State& state) const
{
  return body_share_[node] * stack_.overlap(k, outer, node) * stack_rod().cell_length[node] *
         (state.layers[k].load[node] + stack_.layer(k).fit_load);
}

/** Force along the wire of a layer's next outer one on it, against its insertion [N]. */
double StackStepper::axialFriction(int k, int outer, const State& state) const
{
  if (stack_.layer(k).friction <= 0.0)
    return 0.0;
  double sum = 0.0;
  for (int i = state.first_node + 1; i + 1 < stack_rod().nodes(); ++i)
    sum += load(k, outer, i, state);
  return stack_.layer(k).friction * sum * state.layers[k].friction_stretch / kLayerSlip;
}

/** Whether friction torques between a layer and the next outer one are possible. */
bool StackStepper::sticks(int k, const State& state) const
{
  return stack_.layer(k).friction > 0.0 && nextOuter(k, state) >= 0 && !torque_limit_[k].empty();
}

/** Largest friction torques between neighbours, at the inner one's surface; a node's goes to its edges by halves. */
void StackStepper::setTorqueLimits(const State& state)
{
  setBodyShares(state);
  for (int k = 0; k < stack_.count(); ++k)
  {
    const int outer = nextOuter(k, state);
    std::vector<double>& limit = torque_limit_[k];
    limit.clear();
    if (outer < 0 || stack_.layer(k).friction <= 0.0)
      continue;
    limit.assign(state.twist_angle.size(), 0.0);
    double sum = 0.0;
    for (int i = state.first_node + 1; i + 1 < stack_rod().nodes(); ++i)
    {
      const double torque = stack_.layer(k).friction * stack_.profile(k).rod().radius[i] * load(k, outer, i, state);
      limit[i - 1] += 0.5 * torque;
      limit[i] += 0.5 * torque;
      sum += torque;
    }
    if (sum < kLeastTorque)
      limit.clear();
  }
}

/** Mean angle of a layer in the next outer one, weighted with the friction between them [rad]. */
double StackStepper::meanTurn(int k, int outer, const State& state) const
{
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t j = 0; j < torque_limit_[k].size(); ++j)
  {
    sum += torque_limit_[k][j] * (state.layers[k].twist_angle[j] - state.layers[outer].twist_angle[j]);
    weight += torque_limit_[k][j];
  }
  return sum / weight;
}

/** Mean angle by which the whole friction torque would turn both layers back, were they straight [rad]. */
double StackStepper::turnCompliance(int k, int outer, double held) const
{
  const std::vector<double>& limit = torque_limit_[k];
  double beyond = 0.0;
  double turned = 0.0;
  for (int i = static_cast<int>(limit.size()) - 1; i > 0; --i)
  {
    beyond += limit[i];
    if (beyond <= 0.0)
      continue;
    const double length = stack_rod().cell_length[i] * stack_rod().shareBeyond(i, held);
    for (const int m : {k, outer})
      if (stack_.profile(m).rod().torsional_stiffness[i] > 0.0)
        turned += beyond * beyond * length / stack_.profile(m).rod().torsional_stiffness[i];
  }
  return turned / (beyond + limit[0]);
}

/** Change of a pair's mean turn per share of its friction torque: as the last change of the share in this solve has
 * shown, at first as of straight layers. Curved layers, and those that the wall holds, give way less. */
double StackStepper::turnPerShare(int k, double turn, double share, double compliance, bool first) const
{
  const double given = share - share_before_[k];
  const double slope = first || given == 0.0 ? compliance : (turn_before_[k] - turn) / given;
  return slope > 0.0 ? std::clamp(slope, kLeastResponse * compliance, kMostResponse * compliance) : compliance;
}

/** Changes the friction torques towards those with which every pair sticks where it did, as far as friction allows.
 *  @param first whether in this solve they have not been changed yet
 *  @return whether the twists must be relaxed again */
bool StackStepper::turnLayers(State& state, double held, bool first)
{
  bool changed = false;
  for (int k = 0; k < stack_.count(); ++k)
  {
    if (!sticks(k, state))
      continue;
    LayerState& layer = state.layers[k];
    const int outer = nextOuter(k, state);
    const double turn = meanTurn(k, outer, state) - layer.friction_turn;
    const double compliance = turnCompliance(k, outer, held);
    const double slope = turnPerShare(k, turn, layer.friction_share, compliance, first);
    turn_before_[k] = turn;
    share_before_[k] = layer.friction_share;
    if (std::abs(turn) <= kTurnTolerance || compliance <= 0.0)
      continue;
    const double share = std::max(-1.0, std::min(1.0, layer.friction_share + turn / slope));
    changed = changed || share != layer.friction_share;
    layer.friction_share = share;
  }
  return changed;
}

/** Where a pair slips, it will stick at the angle that it has come to. */
void StackStepper::settleTurns(State& state) const
{
  for (int k = 0; k < stack_.count(); ++k)
  {
    LayerState& layer = state.layers[k];
    const int outer = nextOuter(k, state);
    if (!sticks(k, state))
    {
      layer.friction_share = 0.0;
      layer.friction_turn = outer < 0 ? 0.0 : layer.rotation - state.layers[outer].rotation;
    }
    else if (std::abs(layer.friction_share) == 1.0)
    {
      // Friction that would push the pair back beyond where it stuck is too much of it, no slip.
      const double turned = meanTurn(k, outer, state);
      if ((turned - layer.friction_turn) * layer.friction_share >= 0.0)
        layer.friction_turn = turned;
    }
  }
}

}  // namespace endovascular_sim::rod
