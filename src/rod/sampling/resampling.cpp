#include "rod/sampling/resampling.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rod/model/node_curvature.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kOffsetTime = 10e-3;  // s in which an offset fades to 1/e
constexpr double kNoOffset = 1e-10;    // m
constexpr double kNoTurn = 1e-9;       // rad

/** Curvature vector dt/ds at an inner node [1/m]; zero where the wire is not simulated on both sides. */
Eigen::Vector3d curvatureVector(const Discretisation& rod, const State& state, int node)
{
  if (node <= state.first_node || node + 1 >= rod.nodes())
    return Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector3d>& x = state.position;
  return ((x[node + 1] - x[node]) / rod.rest_length[node] - (x[node] - x[node - 1]) / rod.rest_length[node - 1]) /
         rod.cell_length[node];
}

/** True when the edges at a node have not changed. */
bool sameEdges(const Discretisation& from, int node, const Discretisation& to, int new_node)
{
  const auto edge = [](const Discretisation& rod, int j)
  { return j >= 0 && j + 1 < rod.nodes() ? rod.rest_length[j] : 0.0; };
  return edge(from, node - 1) == edge(to, new_node - 1) && edge(from, node) == edge(to, new_node);
}

/** Middle of the circular arc over an edge. */
Eigen::Vector3d arcMiddle(const Discretisation& rod, const State& state, int edge)
{
  Eigen::Vector3d middle = 0.5 * (state.position[edge] + state.position[edge + 1]);
  if (edge < state.first_node)
    return middle;
  const Eigen::Vector3d before = curvatureVector(rod, state, edge);
  Eigen::Vector3d after = curvatureVector(rod, state, edge + 1);
  // A free end carries no moment: its curvature is the rest curvature.
  if (edge + 2 == rod.nodes() && edge > 0 && !rod.rest_curvature[edge].isZero(0.0))
    after = before;
  Eigen::Vector3d curvature = 0.5 * (before + after);
  const Eigen::Vector3d along = (state.position[edge + 1] - state.position[edge]).normalized();
  curvature -= curvature.dot(along) * along;
  return middle - (0.125 * rod.rest_length[edge] * rod.rest_length[edge]) * curvature;
}

/** Difference of twist over half an edge, from the neighbouring edges [rad]. */
double halfTwist(const Discretisation& rod, const std::vector<double>& angle, int first_node, int edge)
{
  if (edge <= first_node || edge + 2 >= rod.nodes())
    return 0.0;
  const double distance = rod.cell_length[edge] + rod.cell_length[edge + 1];
  return 0.5 * rod.rest_length[edge] * (angle[edge + 1] - angle[edge - 1]) / distance;
}

}  // namespace

void Resampling::addChange(const Wire& wire, const Discretisation& coarse, const Discretisation& fine, int coarse_node,
                           int fine_node, bool split)
{
  const double a = fine.position[fine_node - 1];
  const double b = fine.position[fine_node + 1];
  const double middle = 0.5 * (a + b);
  const double begin = 0.5 * (a + fine.position[fine_node]);
  const double end = 0.5 * (fine.position[fine_node] + b);
  if (coarse.position[coarse_node] != a || coarse.position[coarse_node + 1] != b)
    throw std::logic_error("Resampling: each new edge must be an old edge, half of one, or two merged ones");
  changes_.push_back({coarse_node, fine_node, split, massBetween(wire, begin, middle), massBetween(wire, middle, end),
                      middle - begin, end - middle});
}

void Resampling::findChanges(const Wire& wire, const Discretisation& from, const Discretisation& to)
{
  changes_.clear();
  new_node_.assign(from.position.size(), -1);
  int i = 0;
  int k = 0;
  new_node_[0] = 0;
  while (i + 1 < from.nodes() && k + 1 < to.nodes())
  {
    if (to.position[k + 1] < from.position[i + 1])
    {
      if (k + 2 >= to.nodes())
        break;
      addChange(wire, from, to, i, k + 1, true);
      ++k;
    }
    else if (to.position[k + 1] > from.position[i + 1])
    {
      if (i + 2 >= from.nodes())
        break;
      addChange(wire, to, from, k, i + 1, false);
      ++i;
    }
    new_node_[++i] = ++k;
  }
  if (i + 1 != from.nodes() || k + 1 != to.nodes())
    throw std::logic_error("Resampling: the two samplings are not of the same wire");
}

void Resampling::carry(const Wire& wire, const Discretisation& from, const Discretisation& to, State& state)
{
  findChanges(wire, from, to);
  next_ = state;
  next_.first_node = state.first_node;
  while (new_node_[next_.first_node] < 0)
    --next_.first_node;
  next_.first_node = new_node_[next_.first_node];
  const std::size_t n = to.position.size();
  next_.position.resize(n);
  next_.velocity.resize(n);
  next_.wall_force.resize(n);
  next_.friction_coefficient.resize(n);
  next_.wall_offset.assign(n, std::nan(""));
  next_.curvature_offset.assign(n, Eigen::Vector3d::Zero());
  next_.friction_stretch.resize(n);
  next_.tension.resize(n - 1);
  carryEdges(from, to, state);
  carryNodes(from, to, state);
  carryMoments(from, to, state);
  std::swap(state, next_);
}

void Resampling::carryEdges(const Discretisation& from, const Discretisation& to, const State& state)
{
  for (int j = 0; j + 1 < from.nodes(); ++j)
    if (new_node_[j] >= 0)
      next_.tension[new_node_[j]] = state.tension[j];
  for (const Change& change : changes_)
    if (change.split)
      next_.tension[change.fine] = state.tension[change.coarse];
    else
      next_.tension[change.coarse] = 0.5 * (state.tension[change.fine - 1] + state.tension[change.fine]);
  carryTwist(from, to, state.first_node, state.twist_angle, next_.twist_angle);
  for (std::size_t k = 0; k < state.layers.size(); ++k)
  {
    carryTwist(from, to, state.first_node, state.layers[k].twist_angle, next_.layers[k].twist_angle);
    carryMeans(from, to, state.layers[k].load, next_.layers[k].load);
    carryMeans(from, to, state.layers[k].bore_shift, next_.layers[k].bore_shift);
  }
}

/** Transfers values of nodes: a new node gets the mean of its neighbours. */
template <typename Value>
void Resampling::carryMeans(const Discretisation& from, const Discretisation& to, const std::vector<Value>& value,
                            std::vector<Value>& next) const
{
  next.resize(to.position.size());
  for (int i = 0; i < from.nodes(); ++i)
    if (new_node_[i] >= 0)
      next[new_node_[i]] = value[i];
  for (const Change& change : changes_)
    if (change.split)
      next[change.fine] = 0.5 * (value[change.coarse] + value[change.coarse + 1]);
}

void Resampling::carryTwist(const Discretisation& from, const Discretisation& to, int first_node,
                            const std::vector<double>& angle, std::vector<double>& next) const
{
  next.resize(to.rest_length.size());
  for (int j = 0; j + 1 < from.nodes(); ++j)
    if (new_node_[j] >= 0)
      next[new_node_[j]] = angle[j];
  for (const Change& change : changes_)
  {
    if (change.split)
    {
      const double twist = halfTwist(from, angle, first_node, change.coarse);
      next[change.fine - 1] = angle[change.coarse] - 0.5 * twist;
      next[change.fine] = angle[change.coarse] + 0.5 * twist;
      continue;
    }
    next[change.coarse] = 0.5 * (angle[change.fine - 1] + angle[change.fine]);
  }
}

void Resampling::carryNodes(const Discretisation& from, const Discretisation& to, const State& state)
{
  for (int i = 0; i < from.nodes(); ++i)
  {
    const int k = new_node_[i];
    if (k < 0)
      continue;
    next_.position[k] = state.position[i];
    next_.velocity[k] = state.velocity[i];
    next_.wall_force[k] = state.wall_force[i];
    if (sameEdges(from, i, to, k))
      next_.wall_offset[k] = state.wall_offset[i];
    next_.friction_coefficient[k] = state.friction_coefficient[i];
    next_.friction_stretch[k] = state.friction_stretch[i];
  }
  for (const Change& change : changes_)
    if (change.split)
      insert(change, from, state);
    else
      remove(change, to, state);
}

/** Sets curvature offsets with which a node keeps its moment, and a new node gets the mean of its neighbours. */
void Resampling::carryMoments(const Discretisation& from, const Discretisation& to, const State& state)
{
  const auto binormal = [](const Discretisation& rod, const State& of, int node) -> Eigen::Vector3d
  {
    if (node <= of.first_node || node + 1 >= rod.nodes())
      return Eigen::Vector3d::Zero();
    return binormalAt(rod, of, node).value;
  };
  const auto curvature = [&](int node) -> Eigen::Vector3d
  { return (binormal(from, state, node) - state.curvature_offset[node]) / from.cell_length[node]; };
  const auto setCurvature = [&](int node, const Eigen::Vector3d& value)
  { next_.curvature_offset[node] = binormal(to, next_, node) - to.cell_length[node] * value; };
  for (int i = 0; i < from.nodes(); ++i)
    if (new_node_[i] >= 0)
    {
      if (sameEdges(from, i, to, new_node_[i]))
        next_.curvature_offset[new_node_[i]] = state.curvature_offset[i];
      else
        setCurvature(new_node_[i], curvature(i));
    }
  for (const Change& change : changes_)
    if (change.split)
      setCurvature(change.fine, 0.5 * (curvature(change.coarse) + curvature(change.coarse + 1)));
}

void Resampling::insert(const Change& change, const Discretisation& from, const State& state)
{
  const int a = change.coarse;
  const int k = change.fine;
  next_.position[k] = arcMiddle(from, state, a);
  next_.velocity[k] = (change.mass_before * state.velocity[a] + change.mass_after * state.velocity[a + 1]) /
                      (change.mass_before + change.mass_after);
  next_.wall_force[k].setZero();
  next_.friction_coefficient[k] = std::max(state.friction_coefficient[a], state.friction_coefficient[a + 1]);
  // Mean of both neighbours, weighted with their wall forces.
  const double before = state.wall_force[a].norm();
  const double after = state.wall_force[a + 1].norm();
  next_.friction_stretch[k].setZero();
  if (before + after > 0.0)
    next_.friction_stretch[k] =
        (before * state.friction_stretch[a] + after * state.friction_stretch[a + 1]) / (before + after);
}

void Resampling::remove(const Change& change, const Discretisation& to, const State& state)
{
  const int gone = change.fine;
  const int k = change.coarse;
  const double mass = change.mass_before + change.mass_after;
  const Eigen::Vector3d mean =
      (change.mass_before * state.velocity[gone - 1] + change.mass_after * state.velocity[gone + 1]) / mass;
  const Eigen::Vector3d kick = mass / (to.mass[k] + to.mass[k + 1]) * (state.velocity[gone] - mean);
  for (int side = 0; side < 2; ++side)
  {
    const bool was_free = state.wall_force[gone - 1 + 2 * side].isZero(0.0);
    next_.velocity[k + side] += kick;
    next_.wall_force[k + side] += 0.5 * state.wall_force[gone];
    if (!was_free)
      continue;
    next_.friction_coefficient[k + side] = state.friction_coefficient[gone];
    next_.friction_stretch[k + side] = state.friction_stretch[gone];
  }
}

bool fadeOffsets(State& state, double dt)
{
  bool left = false;
  const double share = std::exp(-dt / kOffsetTime);
  for (double& offset : state.wall_offset)
  {
    offset = std::abs(offset) < kNoOffset ? 0.0 : share * offset;
    left = left || offset != 0.0;
  }
  for (Eigen::Vector3d& offset : state.curvature_offset)
  {
    offset *= offset.squaredNorm() < kNoTurn * kNoTurn ? 0.0 : share;
    left = left || !offset.isZero(0.0);
  }
  return left;
}

}  // namespace endovascular_sim::rod
