#include "motion/contact/moving_wall.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::motion
{
namespace
{

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
  takeWall(rest_set_.features);
  map_.pushForward(wall_points_, wall_normals_);
  set.features.clear();
  for (std::size_t k = 0; k < rest_set_.features.size(); ++k)
  {
    contact::Feature feature = rest_set_.features[k];
    const auto edge = static_cast<std::size_t>(feature.edge - query.first_node);
    feature.point = wall_points_[k];
    feature.normal = wall_normals_[k];
    feature.gap = feature.normal.dot(between(query.nodes, edge, feature.parameter) - feature.point) -
                  between(query.radius, edge, feature.parameter);
    if (feature.gap < between(query.margin, edge, feature.parameter))
      set.features.push_back(feature);
  }
}

/** Copies points and normals of features. */
void MovingWall::takeWall(const std::vector<contact::Feature>& features) const
{
  wall_points_.clear();
  wall_normals_.clear();
  for (const contact::Feature& feature : features)
  {
    wall_points_.push_back(feature.point);
    wall_normals_.push_back(feature.normal);
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
  takeWall(features);
  guesses_ = wall_points_;
  for (std::size_t k = 0; k < features.size(); ++k)
  {
    const auto edge = static_cast<std::size_t>(features[k].edge);
    if (edge < points_.size())
      guesses_[k] += between(rest_, edge, features[k].parameter) - between(points_, edge, features[k].parameter);
  }
  before_.carryTo(map_, guesses_, wall_points_, wall_normals_);
  for (std::size_t k = 0; k < features.size(); ++k)
  {
    features[k].point = wall_points_[k];
    features[k].normal = wall_normals_[k];
  }
}

}  // namespace endovascular_sim::motion
