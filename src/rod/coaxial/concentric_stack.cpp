#include "rod/coaxial/concentric_stack.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLengthTolerance = 1e-9;  // m

}  // namespace

ConcentricStack::ConcentricStack(std::vector<Layer> layers, const std::vector<double>& position)
  : layers_(std::move(layers))
{
  double longest = 0.0;
  for (const Layer& layer : layers_)
  {
    profiles_.emplace_back(layer.wire, position);
    longest = std::max(longest, profiles_.back().length());
  }
  if (layers_.empty() || position.size() < 3 || std::abs(position.back() - longest) > kLengthTolerance)
    throw std::invalid_argument(
        "ConcentricStack: requires a layer and three nodes, the last one at the length of the longest wire");
  setNodes(position);
}

void ConcentricStack::setNodes(const std::vector<double>& position)
{
  for (LayerProfile& profile : profiles_)
    profile.setNodes(position);
  outer_share_.assign(position.size() * profiles_.size(), 0.0);
  surface_layer_.assign(position.size(), 0);
  end_ = position.back();
  changed_.reserve(position.size() * profiles_.size());
}

void ConcentricStack::place(const std::vector<double>& behind, Discretisation& rod)
{
  changed_.clear();
  if (count() == 1)
  {
    if (outer_share_.front() == 1.0)
      return;
    profiles_[0].takeWhole();
    rod = profiles_[0].rod();
    std::fill(outer_share_.begin(), outer_share_.end(), 1.0);
    return;
  }
  for (int k = 0; k < count(); ++k)
    profiles_[k].slideTo(end_ - behind[k], changed_);
  rod.friction_share.resize(rod.position.size());
  for (const int node : changed_)
    composeNode(node, rod);
  rod.first_curved = rod.nodes();
}

void ConcentricStack::composeNode(int node, Discretisation& rod)
{
  double bending = 0.0;
  double torsion = 0.0;
  double mass = 0.0;
  double radius = 0.0;
  double friction = 0.0;
  double own = 0.0;
  double inside = 1.0;
  for (int k = count() - 1; k >= 0; --k)
  {
    const LayerProfile& profile = profiles_[k];
    const Discretisation& layer = profile.rod();
    const double share = inside * profile.cover(node);
    inside *= 1.0 - profile.cover(node);
    outer_share_[static_cast<std::size_t>(node) * static_cast<std::size_t>(count()) + static_cast<std::size_t>(k)] =
        share;
    bending += layer.bending_stiffness[node];
    torsion += layer.torsional_stiffness[node];
    mass += layer.mass[node];
    radius += share * layer.radius[node];
    if (layer.friction_share[node] <= 0.0)
      continue;
    own += share * layer.friction_share[node];
    friction += share * layer.friction_share[node] * layer.friction[node];
  }
  rod.bending_stiffness[node] = bending;
  rod.torsional_stiffness[node] = torsion;
  rod.mass[node] = mass;
  rod.radius[node] = radius;
  rod.friction_share[node] = own;
  rod.friction[node] = own > 0.0 ? friction / own : std::nan("");
  rod.rest_curvature[node].setZero();
  int surface = count() - 1;
  while (surface > 0 && profiles_[surface].cover(node) < 0.5)
    --surface;
  surface_layer_[node] = surface;
}

double ConcentricStack::overlap(int k, int m, int node) const
{
  return std::min(profiles_[k].cover(node), profiles_[m].cover(node));
}

}  // namespace endovascular_sim::rod
