#include "rod/kkt/interlayer_friction.h"

#include <algorithm>
#include <cmath>

#include "rod/friction/coulomb_law.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLayerSlip = 20e-6;     // m, stretch between two layers at which sliding begins
constexpr double kTurnTolerance = 1e-4;  // rad of relative rotation between stuck layers: 0.006°
// Bounds of the compliance of a pair (rotation per share of its friction torque), relative to straight free layers.
constexpr double kLeastResponse = 0.2;
constexpr double kMostResponse = 3.0;
constexpr double kLeastTorque = 1e-12;  // N·m: a pair with less friction does not stick

}  // namespace

InterlayerFriction::InterlayerFriction(const ConcentricStack& stack, const KktModel& model)
  : stack_(stack),
    model_(model),
    turn_before_(static_cast<std::size_t>(stack.count()), 0.0),
    share_before_(static_cast<std::size_t>(stack.count()), 0.0),
    torque_limit_(static_cast<std::size_t>(stack.count())),
    loads_(stack, model)
{
}

int InterlayerFriction::nextOuter(int k, const State& state) const
{
  for (int m = k + 1; m < stack_.count() && state.layers[k].inserted_length > 0.0; ++m)
    if (state.layers[m].inserted_length > 0.0)
      return m;
  return -1;
}

void InterlayerFriction::drag(State& state, const StepInput& input) const
{
  for (int k = 0; k < stack_.count(); ++k)
  {
    LayerState& layer = state.layers[k];
    const int outer = nextOuter(k, state);
    const double pushed = input.layers[k].inserted_length - layer.inserted_length;
    const double carried = outer < 0 ? 0.0 : input.layers[outer].inserted_length - state.layers[outer].inserted_length;
    const double stretch = layer.friction_stretch + pushed - carried;
    layer.friction_stretch = outer < 0 ? 0.0 : CoulombLaw{0.0, kLayerSlip}.returned(stretch);
  }
}

void InterlayerFriction::updateLoads(State& state, const LayerTwists& twists)
{
  updateVesselShares(state);
  pairs_.clear();
  for (int k = 0; k < stack_.count(); ++k)
  {
    const int outer = nextOuter(k, state);
    if (outer >= 0)
      pairs_.push_back({k, outer, stack_.layer(k).friction, state.layers[k].friction_stretch / kLayerSlip});
  }
  loads_.update(pairs_, vessel_share_, twists, state);
}

void InterlayerFriction::updateVesselShares(const State& state)
{
  vessel_share_.assign(state.position.size(), 1.0);
  const double introducer = model_.rod.length() - state.inserted_length;
  for (int i = state.first_node + 1; model_.boundary.introducer && i + 1 < model_.rod.nodes(); ++i)
  {
    vessel_share_[i] = model_.rod.shareBeyond(i, introducer);
    if (vessel_share_[i] >= 1.0)
      break;
  }
}

/** Normal force between two neighbours at a node [N]. */
double InterlayerFriction::load(int k, int outer, int node, const State& state) const
{
  return vessel_share_[node] * stack_.overlap(k, outer, node) * model_.rod.cell_length[node] *
         (state.layers[k].load[node] + stack_.layer(k).fit_load);
}

double InterlayerFriction::axialForce(int k, int outer, const State& state) const
{
  if (stack_.layer(k).friction <= 0.0)
    return 0.0;
  double sum = 0.0;
  for (int i = state.first_node + 1; i + 1 < model_.rod.nodes(); ++i)
    sum += load(k, outer, i, state);
  return CoulombLaw{stack_.layer(k).friction * sum, kLayerSlip}.force(state.layers[k].friction_stretch);
}

/** True where friction torques between a layer and the next outer one are possible. */
bool InterlayerFriction::canStick(int k, const State& state) const
{
  return stack_.layer(k).friction > 0.0 && nextOuter(k, state) >= 0 && !torque_limit_[k].empty();
}

/** Limits at the surface of the inner layer; both edges of a node get half of its torque. */
void InterlayerFriction::updateTorqueLimits(const State& state)
{
  updateVesselShares(state);
  for (int k = 0; k < stack_.count(); ++k)
  {
    const int outer = nextOuter(k, state);
    std::vector<double>& limit = torque_limit_[k];
    limit.clear();
    if (outer < 0 || stack_.layer(k).friction <= 0.0)
      continue;
    limit.assign(state.twist_angle.size(), 0.0);
    double sum = 0.0;
    for (int i = state.first_node + 1; i + 1 < model_.rod.nodes(); ++i)
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

/** Factor of the friction torque limit of pair m on layer k; 0: none. */
double InterlayerFriction::torqueShare(int m, int k, const State& state) const
{
  const double share = state.layers[m].friction_share;
  const double sign = m == k ? -share : nextOuter(m, state) == k ? share : 0.0;
  return sign == 0.0 || !canStick(m, state) ? 0.0 : sign;
}

bool InterlayerFriction::hasTorques(int k, const State& state) const
{
  for (int m = 0; m < stack_.count(); ++m)
    if (torqueShare(m, k, state) != 0.0)
      return true;
  return false;
}

void InterlayerFriction::addTorques(int k, const State& state, std::vector<double>& edge_torque) const
{
  for (int m = 0; m < stack_.count(); ++m)
  {
    const double sign = torqueShare(m, k, state);
    for (std::size_t j = 0; sign != 0.0 && j < edge_torque.size(); ++j)
      edge_torque[j] += sign * torque_limit_[m][j];
  }
}

double InterlayerFriction::turnWork(int k, int outer, const State& before, const State& after) const
{
  if (!canStick(k, after))
    return 0.0;
  double work = 0.0;
  for (std::size_t j = 0; j < torque_limit_[k].size(); ++j)
  {
    const auto turn = [&](int m) { return after.layers[m].twist_angle[j] - before.layers[m].twist_angle[j]; };
    work += after.layers[k].friction_share * torque_limit_[k][j] * (turn(k) - turn(outer));
  }
  return work;
}

/** Mean angle of a layer in the next outer one, weighted with the friction between them [rad]. */
double InterlayerFriction::meanTurn(int k, int outer, const State& state) const
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

/** Mean relative rotation of two straight layers under the whole friction torque [rad]. */
double InterlayerFriction::turnCompliance(int k, int outer, double held) const
{
  const std::vector<double>& limit = torque_limit_[k];
  double beyond = 0.0;
  double turned = 0.0;
  for (int i = static_cast<int>(limit.size()) - 1; i > 0; --i)
  {
    beyond += limit[i];
    if (beyond <= 0.0)
      continue;
    const double length = model_.rod.cell_length[i] * model_.rod.shareBeyond(i, held);
    for (const int m : {k, outer})
      if (stack_.profile(m).rod().torsional_stiffness[i] > 0.0)
        turned += beyond * beyond * length / stack_.profile(m).rod().torsional_stiffness[i];
  }
  return turned / (beyond + limit[0]);
}

/** Change of a pair's mean angle per share of its friction torque: the secant of the last change of the share in this
 *  solve, initially the value of straight layers. Curved layers and layers in contact with the wall are stiffer. */
double InterlayerFriction::turnPerShare(int k, double turn, double share, double compliance, bool first) const
{
  const double change = share - share_before_[k];
  const double slope = first || change == 0.0 ? compliance : (turn_before_[k] - turn) / change;
  return slope > 0.0 ? std::clamp(slope, kLeastResponse * compliance, kMostResponse * compliance) : compliance;
}

bool InterlayerFriction::updateTorques(State& state, double held, bool first)
{
  bool changed = false;
  for (int k = 0; k < stack_.count(); ++k)
  {
    if (!canStick(k, state))
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

void InterlayerFriction::settle(State& state) const
{
  for (int k = 0; k < stack_.count(); ++k)
  {
    LayerState& layer = state.layers[k];
    const int outer = nextOuter(k, state);
    if (!canStick(k, state))
    {
      layer.friction_share = 0.0;
      layer.friction_turn = outer < 0 ? 0.0 : layer.rotation - state.layers[outer].rotation;
    }
    else if (std::abs(layer.friction_share) == 1.0)
    {
      // A limit torque that rotates the pair back beyond the angle at which it stuck overestimates it: no slip.
      const double turned = meanTurn(k, outer, state);
      if ((turned - layer.friction_turn) * layer.friction_share >= 0.0)
        layer.friction_turn = turned;
    }
  }
}

}  // namespace endovascular_sim::rod
