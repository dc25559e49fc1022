#include "rod/coaxial/layer_profile.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLeastCover = 1e-9;  // part of a node below which it counts as not covered

}  // namespace

/** Integrals of section properties times a node's hat function, or their derivatives by the insertion. */
struct LayerProfile::Integrals
{
  double length = 0.0;
  double bending_compliance = 0.0;
  double torsional_compliance = 0.0;
  double mass = 0.0;
  double radius = 0.0;
  double own_friction = 0.0;
  double own_length = 0.0;  ///< length with a friction coefficient of its own
  Eigen::Vector2d rest_angle = Eigen::Vector2d::Zero();

  void add(const Section& section, double weight)
  {
    length += weight;
    bending_compliance += weight / section.bending_stiffness;
    torsional_compliance += weight / section.torsional_stiffness;
    mass += weight * section.density * M_PI * section.radius * section.radius;
    radius += weight * section.radius;
    rest_angle += weight * section.rest_curvature;
    if (std::isnan(section.friction))
      return;
    own_friction += weight * section.friction;
    own_length += weight;
  }
};

LayerProfile::LayerProfile(Wire wire, const std::vector<double>& position)
  : wire_(std::move(wire)), length_(wire_.length())
{
  setNodes(position);
}

double LayerProfile::sectionEnd(std::size_t section) const
{
  double end = tip_;
  for (std::size_t m = section + 1; m < wire_.sections.size(); ++m)
    end -= wire_.sections[m].length;
  return end;
}

void LayerProfile::setNodes(const std::vector<double>& position)
{
  const std::size_t n = position.size();
  position_ = position;
  rod_.rest_length.resize(n - 1);
  rod_.cell_length.resize(n);
  for (std::size_t j = 0; j + 1 < n; ++j)
    rod_.rest_length[j] = position[j + 1] - position[j];
  for (std::size_t i = 0; i < n; ++i)
  {
    const double begin = i > 0 ? 0.5 * (position[i - 1] + position[i]) : position[i];
    const double end = i + 1 < n ? 0.5 * (position[i] + position[i + 1]) : position[i];
    rod_.cell_length[i] = end - begin;
  }
  rod_.axial_stiffness.assign(n - 1, 0.0);
  for (std::vector<double>* values : {&rod_.bending_stiffness, &rod_.torsional_stiffness, &rod_.mass, &rod_.radius,
                                      &rod_.friction, &rod_.friction_share, &cover_})
    values->assign(n, 0.0);
  rod_.rest_curvature.assign(n, Eigen::Vector2d::Zero());
  rod_.position.clear();
  rod_.position.reserve(n);
  placed_ = false;
}

double LayerProfile::hat(int node, double arc_length) const
{
  const int n = static_cast<int>(position_.size());
  const double offset = arc_length - position_[node];
  if (node + 2 >= n && arc_length > position_[n - 2])
  {
    const double t = std::min(1.0, (arc_length - position_[n - 2]) / rod_.rest_length[n - 2]);
    return node + 2 == n ? 1.0 - 3.0 * t + 3.0 * t * t : 3.0 * t - 3.0 * t * t;
  }
  if (offset <= 0.0)
    return node > 0 ? std::max(0.0, 1.0 + offset / rod_.rest_length[node - 1]) : offset < 0.0 ? 0.0 : 1.0;
  return node + 1 < n ? std::max(0.0, 1.0 - offset / rod_.rest_length[node]) : 0.0;
}

/** Integral of a node's hat function from the first node to an arc length; beyond the hat, exactly the cell's length
 *  [m]. */
double LayerProfile::hatIntegral(int node, double arc_length) const
{
  const int n = static_cast<int>(position_.size());
  const double offset = arc_length - position_[node];
  const double before = node > 0 ? rod_.rest_length[node - 1] : 0.0;
  const double after = node + 1 < n ? rod_.rest_length[node] : 0.0;
  if (offset >= after)
    return rod_.cell_length[node];
  if (node + 2 >= n && arc_length > position_[n - 2])
  {
    const double last = rod_.rest_length[n - 2];
    const double t = (arc_length - position_[n - 2]) / last;
    const double beyond = last * (t - 1.5 * t * t + t * t * t);
    return node + 2 == n ? rod_.cell_length[node] - 0.5 * last + beyond : last * t - beyond;
  }
  if (offset <= -before)
    return 0.0;
  if (offset <= 0.0)
    return 0.5 * (before + offset) * (1.0 + offset / before);
  return rod_.cell_length[node] - 0.5 * (after - offset) * (1.0 - offset / after);
}

LayerProfile::Integrals LayerProfile::integrate(int node) const
{
  Integrals sum;
  double to_tip = length_;
  double below = 0.0;
  for (std::size_t m = 0; m < wire_.sections.size(); ++m)
  {
    to_tip = m + 1 < wire_.sections.size() ? to_tip - wire_.sections[m].length : 0.0;
    const double up_to = hatIntegral(node, tip_ - to_tip);
    if (up_to > below)
      sum.add(wire_.sections[m], up_to - below);
    below = up_to;
  }
  return sum;
}

/** Derivatives of the integrals by the insertion, with which the ends of the sections move over the nodes. */
LayerProfile::Integrals LayerProfile::integrateSlopes(int node) const
{
  Integrals sum;
  double to_tip = length_;
  double below = 0.0;
  for (std::size_t m = 0; m < wire_.sections.size(); ++m)
  {
    to_tip = m + 1 < wire_.sections.size() ? to_tip - wire_.sections[m].length : 0.0;
    const double at = hat(node, tip_ - to_tip);
    if (at != below)
      sum.add(wire_.sections[m], at - below);
    below = at;
  }
  return sum;
}

void LayerProfile::setNode(int node)
{
  const double cell = rod_.cell_length[node];
  const Integrals sum = integrate(node);
  const bool covered = sum.length > kLeastCover * cell;
  const double cover = covered ? std::min(1.0, sum.length / cell) : 0.0;
  cover_[node] = cover;
  rod_.bending_stiffness[node] = covered ? cover * (sum.length / sum.bending_compliance) : 0.0;
  rod_.torsional_stiffness[node] = covered ? cover * (sum.length / sum.torsional_compliance) : 0.0;
  rod_.mass[node] = covered ? sum.mass : 0.0;
  rod_.radius[node] = covered ? sum.radius / sum.length : 0.0;
  rod_.friction_share[node] = covered ? sum.own_length / sum.length : 0.0;
  rod_.friction[node] = sum.own_length > 0.0 ? sum.own_friction / sum.own_length : std::nan("");
  rod_.rest_curvature[node].setZero();
  if (covered && !sum.rest_angle.isZero(0.0))
    rod_.rest_curvature[node] = integratedCurvature(sum.rest_angle * (cell / sum.length));
}

LayerProfile::Slope LayerProfile::slope(int node) const
{
  Slope slope;
  if (cover_[node] <= 0.0)
    return slope;
  const double cell = rod_.cell_length[node];
  const Integrals sum = integrate(node);
  const Integrals change = integrateSlopes(node);
  const double stretch = change.length / sum.length;
  slope.cover = change.length / cell;
  slope.mass = change.mass;
  slope.radius = (change.radius - stretch * sum.radius) / sum.length;
  return slope;
}

/** Updates the nodes whose hat functions overlap an interval of arc length. */
void LayerProfile::setNodesBetween(double begin, double end, std::vector<int>& changed)
{
  const int n = static_cast<int>(position_.size());
  const auto after = std::upper_bound(position_.begin(), position_.end(), begin);
  for (int i = std::max(0, static_cast<int>(after - position_.begin()) - 1); i < n; ++i)
  {
    setNode(i);
    changed.push_back(i);
    if (position_[i] >= end)
      break;
  }
}

void LayerProfile::slideTo(double tip, std::vector<int>& changed)
{
  if (placed_ && tip == tip_)
    return;
  const double from = tip_;
  tip_ = tip;
  if (!placed_)
    setNodesBetween(position_.front(), position_.back(), changed);
  double to_tip = length_;
  for (std::size_t m = 0; placed_ && m < wire_.sections.size(); ++m)
  {
    to_tip = m + 1 < wire_.sections.size() ? to_tip - wire_.sections[m].length : 0.0;
    setNodesBetween(std::min(from, tip) - to_tip, std::max(from, tip) - to_tip, changed);
  }
  placed_ = true;
  findRange();
  findSlidingNodes();
  findCurvedParts();
}

/** Finds the parts with rest curvature along the nodes; the first section reaches back to the first node. */
void LayerProfile::findCurvedParts()
{
  rod_.curved_parts.clear();
  double begin = position_.front();
  for (std::size_t m = 0; m < wire_.sections.size(); ++m)
  {
    const double end = sectionEnd(m);
    if (end > begin && !wire_.sections[m].rest_curvature.isZero(0.0))
      rod_.curved_parts.push_back({begin, end, wire_.sections[m].rest_curvature, wire_.sections[m].bending_stiffness});
    begin = std::max(begin, end);
  }
}

void LayerProfile::takeWhole()
{
  discretise(wire_, position_, rod_);
  rod_.friction_share.clear();
  std::fill(cover_.begin(), cover_.end(), 1.0);
  sliding_.clear();
  tip_ = position_.back();
  placed_ = true;
}

void LayerProfile::findSlidingNodes()
{
  sliding_.clear();
  double to_tip = length_;
  for (std::size_t m = 0; m < wire_.sections.size(); ++m)
  {
    to_tip = m + 1 < wire_.sections.size() ? to_tip - wire_.sections[m].length : 0.0;
    const double end = tip_ - to_tip;
    const int next = static_cast<int>(std::lower_bound(position_.begin(), position_.end(), end) - position_.begin());
    for (int i = next - 1; i <= next; ++i)
      if (i >= 0 && i < static_cast<int>(position_.size()) && hat(i, end) > 0.0 &&
          std::find(sliding_.begin(), sliding_.end(), i) == sliding_.end())
        sliding_.push_back(i);
  }
}

/** Finds the nodes of the layer, and the first one with rest curvature. */
void LayerProfile::findRange()
{
  const int n = static_cast<int>(position_.size());
  const auto end = std::lower_bound(position_.begin(), position_.end(), tip_) - position_.begin();
  int count = std::min(n, static_cast<int>(end) + 2);
  while (count > 0 && cover_[count - 1] <= 0.0)
    --count;
  count = std::min(n, count + 1);
  // The nodes that the layer has already are those of the stack.
  const std::ptrdiff_t kept = std::min<std::ptrdiff_t>(count, static_cast<std::ptrdiff_t>(rod_.position.size()));
  rod_.position.resize(static_cast<std::size_t>(kept));
  rod_.position.insert(rod_.position.end(), position_.begin() + kept, position_.begin() + count);
  const double curved = tip_ - wire_.curvedTipLength();
  rod_.first_curved = count;
  if (curved < tip_)
  {
    int i = std::max(
        0, static_cast<int>(std::upper_bound(position_.begin(), position_.end(), curved) - position_.begin()) - 1);
    while (i < count && rod_.rest_curvature[i].isZero(0.0))
      ++i;
    rod_.first_curved = i;
  }
}

}  // namespace endovascular_sim::rod
