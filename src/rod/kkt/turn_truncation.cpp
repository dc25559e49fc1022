#include "rod/kkt/turn_truncation.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kQuietTurn = 0.01;  // rad of an edge in one solve: less cannot fold anything
constexpr double kSharpTurn = 0.6;   // 1 + cos of a turning angle (114°) below which folding is checked
constexpr int kMaxFoldHalvings = 10;

using Motion = std::vector<Eigen::Vector3d>;

/** Largest rotation of an edge [rad]. Along an edge, the solve restores the length that the motion of the handle took
 *  from a short one: no rotation. */
double largestTurn(const Discretisation& rod, const State& state, const Motion& motion)
{
  double largest = 0.0;  // squared
  for (int j = state.first_node; j + 1 < rod.nodes(); ++j)
  {
    const Eigen::Vector3d edge = state.position[j + 1] - state.position[j];
    const Eigen::Vector3d change = motion[j + 1] - motion[j];
    const double along = change.dot(edge);
    const double across = std::max(0.0, change.squaredNorm() - along * along / edge.squaredNorm());
    largest = std::max(largest, across / (rod.rest_length[j] * rod.rest_length[j]));
  }
  return std::sqrt(largest);
}

bool folds(const Discretisation& rod, const State& state, const Motion& motion, double factor)
{
  for (int i = state.first_node + 1; i + 1 < rod.nodes(); ++i)
  {
    const Eigen::Vector3d e = state.position[i] - state.position[i - 1];
    const Eigen::Vector3d g = state.position[i + 1] - state.position[i];
    const Eigen::Vector3d new_e = e + factor * (motion[i] - motion[i - 1]);
    const Eigen::Vector3d new_g = g + factor * (motion[i + 1] - motion[i]);
    // 1 + cos of the turning angle: 2 for a straight wire, 0 for a fold.
    const double now = 1.0 + e.dot(g) / std::sqrt(e.squaredNorm() * g.squaredNorm());
    const double then = 1.0 + new_e.dot(new_g) / std::sqrt(new_e.squaredNorm() * new_g.squaredNorm());
    if (then < kSharpTurn && then < 0.5 * now)
      return true;
  }
  return false;
}

}  // namespace

double turnTruncation(const Discretisation& rod, const State& state, const Motion& motion, double max_rotation)
{
  const double largest = largestTurn(rod, state, motion);
  double factor = largest > max_rotation ? max_rotation / largest : 1.0;
  if (largest <= kQuietTurn)
    return factor;
  for (int halving = 0; halving < kMaxFoldHalvings && folds(rod, state, motion, factor); ++halving)
    factor *= 0.5;
  return factor;
}

}  // namespace endovascular_sim::rod
