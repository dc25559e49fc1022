#include "rod/kkt/interlayer_loads.h"

#include <algorithm>
#include <cmath>

#include "rod/model/node_curvature.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr std::size_t kLeastNodes = 5;      // of the solution in a bore
constexpr double kLargestTension = 1e3;     // N, beyond every hand
constexpr double kMostYield = 5e-5;         // m, of the bore under a whole node, in a shift of the last step
constexpr double kTensionTolerance = 1e-3;  // N, change of the tension that needs no further solution
constexpr double kRelativeTolerance = 0.01;
constexpr int kMaxSolutions = 12;

}  // namespace

void InterlayerLoads::update(const std::vector<LayerPair>& pairs, const std::vector<double>& vessel_share,
                             const LayerTwists& twists, State& state)
{
  if (std::all_of(pairs.begin(), pairs.end(), [](const LayerPair& pair) { return pair.friction <= 0.0; }))
    return;
  end_ = 0;
  for (const LayerPair& pair : pairs)
    end_ = std::max(end_, lastCommonNode(pair, state) + 2);
  end_ = std::min(end_, model_.rod.nodes());
  updateCentreline(state);
  updateMoments(twists, state);
  updateStackTension(state);
  for (auto pair = pairs.rbegin(); pair != pairs.rend(); ++pair)
    updatePair(*pair, vessel_share, state);
}

/** Updates curvature and frames of the centreline in the layers. */
void InterlayerLoads::updateCentreline(const State& state)
{
  const int n = model_.rod.nodes();
  const int first = state.first_node;
  for (std::vector<Eigen::Vector3d>* values : {&tangent_, &director_, &normal_})
    values->resize(static_cast<std::size_t>(n));
  binormal_.assign(static_cast<std::size_t>(n), Eigen::Vector3d::Zero());
  curvature_.clear();
  Eigen::Vector3d before = (state.position[first + 1] - state.position[first]).normalized();
  for (int i = first; i < end_; ++i)
  {
    const Eigen::Vector3d after = i + 1 < n ? (state.position[i + 1] - state.position[i]).normalized() : before;
    tangent_[i] = (before + after).normalized();
    if (i > first && i + 1 < n)
    {
      curvature_.push_back(binormalAt(model_.rod, state, i));
      binormal_[i] = curvature_.back().value;
    }
    if (i == first)
      director_[i] = tangent_[i].unitOrthogonal();
    else
    {
      const Eigen::Vector3d& from = director_[i - 1];
      const double turn = from.dot(tangent_[i]) / (1.0 + tangent_[i - 1].dot(tangent_[i]));
      director_[i] = (from - turn * (tangent_[i - 1] + tangent_[i])).normalized();
    }
    normal_[i] = tangent_[i].cross(director_[i]);
    before = after;
  }
}

void InterlayerLoads::updateMoments(const LayerTwists& twists, const State& state)
{
  moment_.resize(static_cast<std::size_t>(stack_.count()));
  for (int k = 0; k < stack_.count(); ++k)
  {
    const Discretisation& layer = stack_.profile(k).rod();
    std::vector<Eigen::Vector3d>& moment = moment_[k];
    if (k > 0)
      moment = moment_[k - 1];
    else
      moment.assign(state.position.size(), Eigen::Vector3d::Zero());
    for (int i = state.first_node + 1; i < std::min(end_, model_.rod.nodes() - 1); ++i)
    {
      if (layer.bending_stiffness[i] <= 0.0)
        continue;
      Eigen::Vector3d strain = binormal_[i] - state.curvature_offset[i];
      if (twists.isActive(k) && i >= twists.of(k).firstCurved() && i + 1 < layer.nodes())
        strain -= twists.of(k).restCurvatureBinormal(i);
      moment[i] += (layer.bending_stiffness[i] / layer.cell_length[i]) * strain;
    }
  }
}

/** Updates the axial force of all layers together: the multiplier, and the derivative of bending by the edge's length.
 */
void InterlayerLoads::updateStackTension(const State& state)
{
  const int n = model_.rod.nodes();
  const std::vector<Eigen::Vector3d>& moment = moment_.back();
  const int inner = state.first_node + 1;
  tension_.assign(static_cast<std::size_t>(n - 1), 0.0);
  for (int j = state.first_node; j + 1 < end_; ++j)
  {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    if (j > state.first_node)
      force += curvature_[j - inner].transposeAfter(moment[j]);
    if (j + 2 < n)
      force += curvature_[j + 1 - inner].transposeBefore(moment[j + 1]);
    tension_[j] = state.tension[j] + (state.position[j + 1] - state.position[j]).normalized().dot(force);
  }
}

/** Components across the centreline in the Bishop frame. */
Eigen::Vector2d InterlayerLoads::across(const Eigen::Vector3d& vector, int node) const
{
  return {director_[node].dot(vector), normal_[node].dot(vector)};
}

/** Part of a node that a layer or one inside it covers, 0 to 1. */
double InterlayerLoads::groupCover(int k, int node) const
{
  double cover = 0.0;
  for (int m = 0; m <= k; ++m)
    cover = std::max(cover, stack_.profile(m).cover(node));
  return cover;
}

/** Radius of a layer, or of those inside it where it ends [m]. */
double InterlayerLoads::groupRadius(int k, int node) const
{
  double radius = 0.0;
  for (int m = 0; m <= k; ++m)
    radius += stack_.profile(m).cover(node) * (stack_.profile(m).rod().radius[node] - radius);
  return radius;
}

/** Last node at which the outer layer of a pair covers layers inside it. */
int InterlayerLoads::lastCommonNode(const LayerPair& pair, const State& state) const
{
  int last = std::min(model_.rod.nodes(), stack_.profile(pair.outer).rod().nodes()) - 1;
  while (last > state.first_node &&
         (stack_.profile(pair.outer).cover(last) <= 0.0 || groupCover(pair.inner, last) <= 0.0))
    --last;
  return last;
}

/** 1 where the layers inside continue beyond the outer one, 0 where they end in it. */
double InterlayerLoads::protrusion(const LayerPair& pair, int end) const
{
  double tip = 0.0;
  for (int m = 0; m <= pair.inner; ++m)
    tip = std::max(tip, stack_.profile(m).tip());
  return std::clamp((tip - stack_.profile(pair.outer).tip()) / model_.rod.cell_length[end], 0.0, 1.0);
}

/** Sets the nodes of a pair, without tension. @param end last common node */
void InterlayerLoads::placeNodes(const LayerPair& pair, int end, const State& state)
{
  const int first = state.first_node;
  const double continued = protrusion(pair, end);
  nodes_.assign(static_cast<std::size_t>(end - first + 2), BoreNode());
  for (int i = first; i <= std::min(end + 1, model_.rod.nodes() - 1); ++i)
  {
    BoreNode& node = nodes_[i - first];
    node.cell = model_.rod.cell_length[i];
    node.edge = i + 1 < model_.rod.nodes() ? model_.rod.rest_length[i] : node.cell;
    const double share = i < end ? 1.0 : continued;
    // The end of the outer layer bears no moment: there the wire has that of the stack.
    const Eigen::Vector3d& moment = moment_[i < end ? pair.inner : pair.outer][i];
    node.moment = share * across(moment.cross(tangent_[i]), i);
    node.curvature = across(binormal_[i].cross(tangent_[i]) / node.cell, i);
    if (i > end)
      continue;
    for (int m = 0; m <= pair.inner; ++m)
      node.stiffness += stack_.profile(m).rod().bending_stiffness[i];
    node.wall = std::min(stack_.profile(pair.outer).cover(i), groupCover(pair.inner, i));
    node.clearance = std::max(0.0, stack_.layer(pair.outer).lumen - groupRadius(pair.inner, i));
    node.shift = across(state.layers[pair.inner].bore_shift[i], i);
    const double distance = node.shift.norm();
    if (node.wall * (distance - node.clearance) > kMostYield)
      node.shift *= (node.clearance + kMostYield / node.wall) / distance;
    // A wire on the inner side of a bend is bent more than the centreline.
    const Eigen::Vector2d sharper = node.curvature.dot(node.shift) * node.curvature;
    node.curvature += sharper;
    node.moment += node.stiffness * sharper;
  }
}

/** Tension before a node, and the load of the node with it.
 *
 *  Under the compression C the wire lies in its bore as a helix where r C²/(4 B) exceeds the load of the solution in
 * the bore. The helix precesses, so that the wire slips along the axis: C' = μ r C²/(4 B), and C/(1 − μ r h C/(4 B))
 * after the length h. Beyond the pole of this solution no force of the hand reaches the end of the wire:
 * kLargestTension.
 *  @param tension, after after the node, without and with the change by bending [N]
 *  @param friction coefficient times mobilised part times length [m] */
double InterlayerLoads::tensionBefore(std::size_t i, double tension, double after, double friction, double fit_load)
{
  const BoreLoad& bore = bore_load_[i];
  const double slope = 0.5 * bore.slope;
  const double implicit =
      (fit_load + bore.value + slope * (tension + after - 2.0 * bore.tension)) / (1.0 + slope * friction);
  double load = std::max(fit_load, implicit);
  const double helix = nodes_[i].stiffness > 0.0 ? nodes_[i].clearance / (4.0 * nodes_[i].stiffness) : 0.0;
  if (after < 0.0 && helix * after * after > load)
    load = helix * after * after / std::max(-after / kLargestTension, 1.0 + friction * helix * after);
  if (friction != 0.0)
    load = std::min(load, std::max(0.0, kLargestTension + std::copysign(after, after * friction)) / std::abs(friction));
  load_[i] = load - fit_load;
  return std::clamp(after - friction * load, -kLargestTension, kLargestTension);
}

/** Updates tension and loads from the end to the introducer: T' = −M'·κ less the friction, for M and κ of the shifted
 *  wire.
 *  @return largest change of the tension [N] */
double InterlayerLoads::updateTension(const LayerPair& pair, int end, int first,
                                      const std::vector<double>& vessel_share)
{
  const auto last = static_cast<std::size_t>(end - first);
  const auto moment = [&](std::size_t i) -> Eigen::Vector2d
  { return nodes_[i].moment + nodes_[i].stiffness * BoreContact::bend(nodes_, i); };
  double tension = end + 1 < model_.rod.nodes() ? protrusion(pair, end) * tension_[end] : 0.0;
  double change = 0.0;
  Eigen::Vector2d beyond = nodes_.back().moment;
  Eigen::Vector2d here = moment(last);
  for (std::size_t i = last;; --i)
  {
    change = std::max(change, std::abs(tension - nodes_[i].tension));
    nodes_[i].tension = tension;
    if (i == 0)
      return change;
    const int node = first + static_cast<int>(i);
    const Eigen::Vector2d before = moment(i - 1);
    const Eigen::Vector2d curvature = nodes_[i].curvature + BoreContact::bend(nodes_, i);
    const double length = vessel_share[node] * stack_.overlap(pair.inner, pair.outer, node) * nodes_[i].cell;
    tension = tensionBefore(i, tension, tension + 0.5 * curvature.dot(beyond - before),
                            pair.mobilised * pair.friction * length, stack_.layer(pair.inner).fit_load);
    beyond = here;
    here = before;
  }
}

/** Takes over the loads of a solution in the bore, per length of wall. They change with the tension by the curvature
 * towards the side on which the wire bears. */
void InterlayerLoads::updateBoreLoads()
{
  for (std::size_t i = 1; i < bore_load_.size(); ++i)
  {
    const BoreNode& node = nodes_[i];
    const double load = node.wall > 0.0 ? bore_.load()[i] / node.wall : 0.0;
    bore_load_[i].value = load;
    bore_load_[i].tension = 0.5 * (nodes_[i - 1].tension + node.tension);
    bore_load_[i].slope = load > 0.0 ? node.curvature.dot(node.shift) / node.shift.norm() : 0.0;
  }
}

/** Solves for tension and loads of a pair together. */
void InterlayerLoads::updatePair(const LayerPair& pair, const std::vector<double>& vessel_share, State& state)
{
  const int first = state.first_node;
  const int end = lastCommonNode(pair, state);
  LayerState& layer = state.layers[pair.inner];
  placeNodes(pair, end, state);
  load_.assign(nodes_.size() - 1, 0.0);
  bore_load_.assign(nodes_.size() - 1, BoreLoad());
  for (int i = first; i <= end; ++i)
    bore_load_[i - first].value = layer.load[i];
  double change = updateTension(pair, end, first, vessel_share);
  const bool bears = pair.friction > 0.0 && nodes_.size() >= kLeastNodes;
  for (int solution = 0; bears && solution < kMaxSolutions && (solution == 0 || change > tolerance()); ++solution)
  {
    bore_.solve(nodes_);
    updateBoreLoads();
    change = updateTension(pair, end, first, vessel_share);
  }
  std::fill(layer.load.begin(), layer.load.end(), 0.0);
  std::fill(layer.bore_shift.begin(), layer.bore_shift.end(), Eigen::Vector3d::Zero());
  for (int i = first; i <= end && i < static_cast<int>(tension_.size()); ++i)
    tension_[i] = nodes_[i - first].tension;
  for (int i = first; bears && i <= end; ++i)
  {
    const Eigen::Vector2d& shift = nodes_[i - first].shift;
    layer.load[i] = load_[i - first];
    layer.bore_shift[i] = shift.x() * director_[i] + shift.y() * normal_[i];
  }
}

/** Change of the tension below which tension and loads agree [N]. */
double InterlayerLoads::tolerance() const
{
  double largest = 0.0;
  for (const BoreNode& node : nodes_)
    largest = std::max(largest, std::abs(node.tension));
  return kTensionTolerance + kRelativeTolerance * largest;
}

}  // namespace endovascular_sim::rod
