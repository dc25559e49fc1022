#include "motion/contact/moving_wall.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastStretch = 0.2;  // of the bound by the local deformation; maps that fold space are refused before

Vector3d between(const std::vector<Vector3d>& points, std::size_t edge, double parameter)
{
  const std::size_t next = std::min(edge + 1, points.size() - 1);
  return (1.0 - parameter) * points[edge] + parameter * points[next];
}

double between(const std::vector<double>& values, std::size_t edge, double parameter)
{
  const std::size_t next = std::min(edge + 1, values.size() - 1);
  return (1.0 - parameter) * values[edge] + parameter * values[next];
}

/** Normal of the moved wall: that of the wall at rest by the cofactors of the gradient, unit. */
Vector3d movedNormal(const Matrix3d& gradient, const Vector3d& normal)
{
  Matrix3d cofactor;
  for (int i = 0; i < 3; ++i)
    cofactor.row(i) = gradient.row((i + 1) % 3).cross(gradient.row((i + 2) % 3));
  return (cofactor * normal).normalized();
}

MotionMap restingMap()
{
  return {{}, {}, {}};
}

}  // namespace

MovingWall::MovingWall(contact::ContactSource* source, const MapBounds& bounds)
  : source_(source),
    bounds_(bounds),
    step_begin_(restingMap()),
    step_end_(restingMap()),
    before_(restingMap()),
    map_(restingMap())
{
}

void MovingWall::beginStep(const MotionMap& from, const MotionMap& to)
{
  step_begin_ = before_ = map_ = from;
  step_end_ = to;
  moves_ = !from.resting() || !to.resting();
}

/** Lower bound of the stretch of lengths around a node: that by the deformation there, and its change by the curvature
 *  of the map. @param distance from the node [m] */
double MovingWall::stretchAt(std::size_t node, double distance) const
{
  return std::max(kLeastStretch, 1.0 - deformation_[node] - bounds_.curvature * distance);
}

/** Largest sag of the edges at a node [m]. */
double MovingWall::sagAt(const contact::Query& query, std::size_t node) const
{
  double longest = 0.0;
  if (node > 0)
    longest = (query.nodes[node] - query.nodes[node - 1]).norm();
  if (node + 1 < query.nodes.size())
    longest = std::max(longest, (query.nodes[node + 1] - query.nodes[node]).norm());
  return bounds_.sag(longest);
}

/** Sets the query at rest: every feature within the margin of the moved wire lies within its margin. */
void MovingWall::pullBack(const contact::Query& query)
{
  rest_query_ = query;
  map_.pullBack(query.nodes, rest_query_.nodes, deformation_);
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
  {
    if (deformation_[i] == 0.0 && map_.outside(query.nodes[i]))
      continue;
    const double distance = query.radius[i] + query.margin[i];
    rest_query_.radius[i] = query.radius[i] + sagAt(query, i);
    rest_query_.margin[i] = distance / stretchAt(i, distance) - query.radius[i];
  }
}

void MovingWall::beginAnswer(contact::ContactSet& set) const
{
  set.step = rest_set_.step;
  set.substep = rest_set_.substep;
  set.pass = rest_set_.pass;
  set.vessel_version = rest_set_.vessel_version;
  set.first_edge = rest_set_.first_edge;
  set.stale = rest_set_.stale;
}

void MovingWall::detect(const contact::Query& query, contact::ContactSet& set)
{
  if (map_.resting())
  {
    source_->detect(query, set);
    return;
  }
  pullBack(query);
  source_->detect(rest_query_, rest_set_);
  beginAnswer(set);
  if (!set.stale)
    pushForward(query, set);
}

/** Sets the features in the moved patient; those beyond the margin are left out. */
void MovingWall::pushForward(const contact::Query& query, contact::ContactSet& set) const
{
  set.free_distance.resize(query.nodes.empty() ? 0 : query.nodes.size() - 1);
  for (std::size_t j = 0; j < set.free_distance.size(); ++j)
    set.free_distance[j] = std::min(query.margin[j], query.margin[j + 1]);
  set.features.clear();
  for (const contact::Feature& at_rest : rest_set_.features)
  {
    const auto edge = static_cast<std::size_t>(at_rest.edge - query.first_node);
    contact::Feature feature = at_rest;
    if (!map_.outside(at_rest.point))
    {
      feature.point = map_.position(at_rest.point);
      feature.normal = movedNormal(map_.gradient(at_rest.point), at_rest.normal);
    }
    feature.gap = feature.normal.dot(between(query.nodes, edge, feature.parameter) - feature.point) -
                  between(query.radius, edge, feature.parameter);
    if (feature.gap < between(query.margin, edge, feature.parameter))
      set.features.push_back(feature);
  }
}

/** A feature beyond the free distance F at rest is farther than σ(r + F) from the axis in the moved patient, where σ is
 *  the least stretch; r is the radius. */
void MovingWall::freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set)
{
  if (map_.resting())
  {
    source_->freeDistances(query, wanted, set);
    return;
  }
  pullBack(query);
  double widest = 0.0;
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
    widest = std::max(widest, (query.radius[i] + wanted) / stretchAt(i, query.radius[i] + wanted) - query.radius[i]);
  source_->freeDistances(rest_query_, std::max(wanted, widest), rest_set_);
  beginAnswer(set);
  if (set.stale)
    return;
  set.free_distance.resize(rest_set_.free_distance.size());
  for (std::size_t j = 0; j < set.free_distance.size(); ++j)
  {
    const double radius = std::max(query.radius[j], query.radius[j + 1]);
    const double at_rest = rest_set_.free_distance[j];
    const double stretch = std::min(stretchAt(j, radius + at_rest), stretchAt(j + 1, radius + at_rest));
    const bool moved = !map_.outside(query.nodes[j]) || !map_.outside(query.nodes[j + 1]);
    const double free = moved ? stretch * (radius + at_rest) - radius : at_rest;
    set.free_distance[j] = std::max(free, std::min(query.margin[j], query.margin[j + 1]));
  }
  set.features.clear();
}

void MovingWall::move(double from, double to, const std::vector<Vector3d>& points, int first,
                      contact::WallTravel& travel)
{
  before_ = MotionMap::between(step_begin_, step_end_, from);
  map_ = MotionMap::between(step_begin_, step_end_, to);
  points_ = points;
  before_.pullBack(points_, rest_);
  before_.motionTo(map_, rest_, static_cast<std::size_t>(first), travel.displacement, travel.turn);
}

/** The place at rest of a feature follows from that of the wire beside it by one Newton step, to 0.1 µm and better. */
void MovingWall::carry(std::vector<contact::Feature>& features) const
{
  for (contact::Feature& feature : features)
  {
    const auto edge = static_cast<std::size_t>(feature.edge);
    if (edge >= points_.size() || before_.outside(feature.point))
      continue;
    const Vector3d guess =
        between(rest_, edge, feature.parameter) + feature.point - between(points_, edge, feature.parameter);
    const Vector3d point = guess + before_.gradient(guess).inverse() * (feature.point - before_.position(guess));
    const Vector3d normal = (before_.gradient(point).transpose() * feature.normal).normalized();
    feature.normal = movedNormal(map_.gradient(point), normal);
    feature.point += map_.displacement(point) - before_.displacement(point);
  }
}

}  // namespace endovascular_sim::motion
