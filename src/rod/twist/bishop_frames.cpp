#include "rod/twist/bishop_frames.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::rod
{
namespace
{

/** Parallel transport: the rotation about from × to that takes one tangent to the other. */
Eigen::Vector3d transported(const Eigen::Vector3d& director, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  return director - (director.dot(to) / (1.0 + from.dot(to))) * (from + to);
}

}  // namespace

double frameTurn(const Eigen::Vector3d& director_before, const Eigen::Vector3d& normal_before,
                 const Eigen::Vector3d& director, const Eigen::Vector3d& normal)
{
  const Eigen::Vector3d tangent = director.cross(normal);
  const Eigen::Vector3d followed = transported(director_before, director_before.cross(normal_before), tangent);
  return std::atan2(-normal.dot(followed), director.dot(followed));
}

void BishopFrames::transport(const Discretisation& rod, const TwistBoundary& boundary, const State& state)
{
  const int edges = rod.nodes() - 1;
  director_.resize(static_cast<std::size_t>(edges));
  normal_.resize(static_cast<std::size_t>(edges));
  int first = state.first_node;
  while (first + 1 < edges && 0.5 * (rod.position[first] + rod.position[first + 1]) < boundary.position)
    ++first;
  std::fill_n(director_.begin(), first, boundary.director);
  std::fill_n(normal_.begin(), first, Eigen::Vector3d(boundary.tangent.cross(boundary.director)));
  Eigen::Vector3d tangent = boundary.tangent;
  Eigen::Vector3d director = boundary.director;
  for (int j = first; j < edges; ++j)
  {
    const Eigen::Vector3d next = (state.position[j + 1] - state.position[j]).normalized();
    director = transported(director, tangent, next);
    tangent = next;
    director_[j] = director;
    normal_[j] = tangent.cross(director);
  }
}

void turnsBy(const Discretisation& rod, const TwistBoundary& boundary, const State& state,
             const std::vector<Eigen::Vector3d>& displacement, std::vector<double>& turn)
{
  turn.assign(static_cast<std::size_t>(rod.nodes() - 1), 0.0);
  Eigen::Vector3d before = boundary.tangent, moved_before = Eigen::Vector3d::Zero();
  double sum = 0.0;
  for (int j = state.first_node; j + 1 < rod.nodes(); ++j)
  {
    const double inverse = 1.0 / rod.rest_length[j];
    const Eigen::Vector3d tangent = inverse * (state.position[j + 1] - state.position[j]);
    const Eigen::Vector3d moved = inverse * (displacement[j + 1] - displacement[j]);
    sum -= before.cross(tangent).dot(moved_before + moved) / (1.0 + before.dot(tangent));
    turn[j] = sum;
    before = tangent;
    moved_before = moved;
  }
}

void FrameTurns::begin(const Discretisation& rod, const TwistBoundary& boundary, const State& state, int first_curved)
{
  active_ = true;
  first_curved_ = first_curved;
  begin_.transport(rod, boundary, state);
}

const std::vector<double>& FrameTurns::since(const Discretisation& rod, const TwistBoundary& boundary,
                                             const State& state)
{
  turn_.clear();
  if (!active_)
    return turn_;
  now_.transport(rod, boundary, state);
  turn_.assign(static_cast<std::size_t>(rod.nodes() - 1), 0.0);
  for (int j = std::max(state.first_node, first_curved_ - 1); j + 1 < rod.nodes(); ++j)
    turn_[j] = now_.turnSince(begin_, j);
  return turn_;
}

}  // namespace endovascular_sim::rod
