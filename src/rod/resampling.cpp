#include "rod/resampling.h"

#include <algorithm>
#include <stdexcept>

namespace endovascular_sim::rod
{
namespace
{

/** Curvature vector dt/ds at an inner node [1/m]; zero where the wire is not simulated on both sides. */
Eigen::Vector3d curvatureVector(const Discretisation& rod, const State& state, int node)
{
  if (node <= state.first_node || node + 1 >= rod.nodes())
    return Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector3d>& x = state.position;
  return ((x[node + 1] - x[node]) / rod.rest_length[node] - (x[node] - x[node - 1]) / rod.rest_length[node - 1]) /
         rod.cell_length[node];
}

/** Middle of the arc over an edge. */
Eigen::Vector3d arcMiddle(const Discretisation& rod, const State& state, int edge)
{
  const Eigen::Vector3d middle = 0.5 * (state.position[edge] + state.position[edge + 1]);
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
double halfTwist(const Discretisation& rod, const State& state, int edge)
{
  if (edge <= state.first_node || edge + 2 >= rod.nodes())
    return 0.0;
  const double distance = rod.cell_length[edge] + rod.cell_length[edge + 1];
  return 0.5 * rod.rest_length[edge] * (state.twist_angle[edge + 1] - state.twist_angle[edge - 1]) / distance;
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
    throw std::logic_error("Resampling: an edge is neither kept, halved nor joined with the next");
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
  next_.friction_stretch.resize(n);
  next_.tension.resize(n - 1);
  next_.twist_angle.resize(n - 1);
  carryEdges(from, state);
  carryNodes(from, to, state);
  std::swap(state, next_);
}

void Resampling::carryEdges(const Discretisation& from, const State& state)
{
  for (int j = 0; j + 1 < from.nodes(); ++j)
    if (new_node_[j] >= 0)
    {
      next_.tension[new_node_[j]] = state.tension[j];
      next_.twist_angle[new_node_[j]] = state.twist_angle[j];
    }
  for (const Change& change : changes_)
  {
    if (change.split)
    {
      const double twist = halfTwist(from, state, change.coarse);
      next_.tension[change.fine] = state.tension[change.coarse];
      next_.twist_angle[change.fine - 1] = state.twist_angle[change.coarse] - 0.5 * twist;
      next_.twist_angle[change.fine] = state.twist_angle[change.coarse] + 0.5 * twist;
      continue;
    }
    next_.tension[change.coarse] = 0.5 * (state.tension[change.fine - 1] + state.tension[change.fine]);
    next_.twist_angle[change.coarse] = 0.5 * (state.twist_angle[change.fine - 1] + state.twist_angle[change.fine]);
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
    next_.wall_force[k] = state.wall_force[i] * (to.cell_length[k] / from.cell_length[i]);
    next_.friction_coefficient[k] = state.friction_coefficient[i];
    next_.friction_stretch[k] = state.friction_stretch[i];
  }
  for (const Change& change : changes_)
    if (change.split)
      insert(change, from, state);
    else
      remove(change, from, to, state);
}

void Resampling::insert(const Change& change, const Discretisation& from, const State& state)
{
  const int a = change.coarse;
  const int k = change.fine;
  next_.position[k] = arcMiddle(from, state, a);
  next_.velocity[k] = (change.mass_before * state.velocity[a] + change.mass_after * state.velocity[a + 1]) /
                      (change.mass_before + change.mass_after);
  const Eigen::Vector3d before = (change.cell_before / from.cell_length[a]) * state.wall_force[a];
  const Eigen::Vector3d after = (change.cell_after / from.cell_length[a + 1]) * state.wall_force[a + 1];
  next_.wall_force[k] = before + after;
  next_.friction_coefficient[k] =
      before.squaredNorm() > after.squaredNorm() ? state.friction_coefficient[a] : state.friction_coefficient[a + 1];
  // Of two neighbours that touch, the mean by force: friction along the wire goes on as it was.
  const double force = before.norm() + after.norm();
  next_.friction_stretch[k].setZero();
  if (force > 0.0)
    next_.friction_stretch[k] =
        (before.norm() * state.friction_stretch[a] + after.norm() * state.friction_stretch[a + 1]) / force;
}

void Resampling::remove(const Change& change, const Discretisation& from, const Discretisation& to, const State& state)
{
  const int gone = change.fine;
  const int k = change.coarse;
  const double mass = change.mass_before + change.mass_after;
  const Eigen::Vector3d mean =
      (change.mass_before * state.velocity[gone - 1] + change.mass_after * state.velocity[gone + 1]) / mass;
  const Eigen::Vector3d kick = mass / (to.mass[k] + to.mass[k + 1]) * (state.velocity[gone] - mean);
  const Eigen::Vector3d mean_force = (change.cell_before / from.cell_length[gone - 1]) * state.wall_force[gone - 1] +
                                     (change.cell_after / from.cell_length[gone + 1]) * state.wall_force[gone + 1];
  const Eigen::Vector3d beyond = (state.wall_force[gone] - mean_force) / (to.cell_length[k] + to.cell_length[k + 1]);
  for (int side = 0; side < 2; ++side)
  {
    const bool was_free = state.wall_force[gone - 1 + 2 * side].isZero(0.0);
    next_.velocity[k + side] += kick;
    next_.wall_force[k + side] += to.cell_length[k + side] * beyond;
    if (!was_free)
      continue;
    next_.friction_coefficient[k + side] = state.friction_coefficient[gone];
    next_.friction_stretch[k + side] = state.friction_stretch[gone];
  }
}

}  // namespace endovascular_sim::rod
