#include "rod/kkt/interlayer_loads.h"

#include <algorithm>
#include <cmath>

#include "rod/model/node_curvature.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr std::size_t kLeastNodes = 5;  // of the solution in a bore

}  // namespace

void InterlayerLoads::update(const std::vector<LayerPair>& pairs, const std::vector<double>& vessel_share,
                             const LayerTwists& twists, State& state)
{
  if (std::all_of(pairs.begin(), pairs.end(), [](const LayerPair& pair) { return pair.friction <= 0.0; }))
    return;
  updateCentreline(state);
  updateMoments(twists, state);
  updateStackTension(state);
  for (auto pair = pairs.rbegin(); pair != pairs.rend(); ++pair)
    updatePair(*pair, vessel_share, state);
}

/** Updates curvature and frames of the centreline. */
void InterlayerLoads::updateCentreline(const State& state)
{
  const int n = model_.rod.nodes();
  const int first = state.first_node;
  for (std::vector<Eigen::Vector3d>* values : {&binormal_, &tangent_, &director_, &normal_})
    values->assign(static_cast<std::size_t>(n), Eigen::Vector3d::Zero());
  Eigen::Vector3d before = (state.position[first + 1] - state.position[first]).normalized();
  for (int i = first; i < n; ++i)
  {
    const Eigen::Vector3d after = i + 1 < n ? (state.position[i + 1] - state.position[i]).normalized() : before;
    tangent_[i] = (before + after).normalized();
    if (i > first && i + 1 < n)
      binormal_[i] = binormalAt(model_.rod, state, i).value;
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
    for (int i = state.first_node + 1; i + 1 < model_.rod.nodes(); ++i)
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
  tension_.assign(static_cast<std::size_t>(n - 1), 0.0);
  for (int j = state.first_node; j + 1 < n; ++j)
  {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    if (j > state.first_node)
      force += binormalAt(model_.rod, state, j).transposeAfter(moment[j]);
    if (j + 2 < n)
      force += binormalAt(model_.rod, state, j + 1).transposeBefore(moment[j + 1]);
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
    node.moment = share * across(moment_[pair.inner][i].cross(tangent_[i]), i);
    node.curvature = across(binormal_[i].cross(tangent_[i]) / node.cell, i);
    if (i > end)
      continue;
    for (int m = 0; m <= pair.inner; ++m)
      node.stiffness += stack_.profile(m).rod().bending_stiffness[i];
    node.wall = std::min(stack_.profile(pair.outer).cover(i), groupCover(pair.inner, i));
    node.clearance = std::max(0.0, stack_.layer(pair.outer).lumen - groupRadius(pair.inner, i));
    node.shift = across(state.layers[pair.inner].bore_shift[i], i);
    // A wire on the inner side of a bend is bent more than the centreline.
    const Eigen::Vector2d sharper = node.curvature.dot(node.shift) * node.curvature;
    node.curvature += sharper;
    node.moment += node.stiffness * sharper;
  }
}

/** Updates the tension from the end to the introducer: T' = −M'·κ less the friction, for M and κ of the shifted wire.
 */
void InterlayerLoads::updateTension(const LayerPair& pair, int end, const std::vector<double>& vessel_share,
                                    const State& state)
{
  const int first = state.first_node;
  const LayerState& layer = state.layers[pair.inner];
  const auto moment = [&](int i) -> Eigen::Vector2d
  { return nodes_[i - first].moment + nodes_[i - first].stiffness * BoreContact::bend(nodes_, i - first); };
  double tension = end + 1 < model_.rod.nodes() ? protrusion(pair, end) * tension_[end] : 0.0;
  Eigen::Vector2d beyond = nodes_.back().moment;
  Eigen::Vector2d here = moment(end);
  for (int i = end; i >= first; --i)
  {
    nodes_[i - first].tension = tension;
    if (end < static_cast<int>(tension_.size()) || i < end)
      tension_[i] = tension;
    if (i == first)
      break;
    const Eigen::Vector2d before = moment(i - 1);
    const Eigen::Vector2d curvature = nodes_[i - first].curvature + BoreContact::bend(nodes_, i - first);
    const double load = vessel_share[i] * stack_.overlap(pair.inner, pair.outer, i) * nodes_[i - first].cell *
                        (layer.load[i] + stack_.layer(pair.inner).fit_load);
    tension += 0.5 * curvature.dot(beyond - before) - pair.mobilised * pair.friction * load;
    beyond = here;
    here = before;
  }
}

void InterlayerLoads::updatePair(const LayerPair& pair, const std::vector<double>& vessel_share, State& state)
{
  const int first = state.first_node;
  const int end = lastCommonNode(pair, state);
  LayerState& layer = state.layers[pair.inner];
  placeNodes(pair, end, state);
  updateTension(pair, end, vessel_share, state);
  std::fill(layer.load.begin(), layer.load.end(), 0.0);
  std::fill(layer.bore_shift.begin(), layer.bore_shift.end(), Eigen::Vector3d::Zero());
  if (pair.friction <= 0.0 || nodes_.size() < kLeastNodes)
    return;
  bore_.solve(nodes_);
  for (int i = first; i <= end; ++i)
  {
    const Eigen::Vector2d& shift = nodes_[i - first].shift;
    layer.load[i] = bore_.load()[i - first];
    layer.bore_shift[i] = shift.x() * director_[i] + shift.y() * normal_[i];
  }
}

}  // namespace endovascular_sim::rod
