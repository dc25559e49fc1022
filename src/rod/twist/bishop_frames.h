#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Turn of an edge's frame about its tangent [rad], beyond the frame of the edge before a motion that follows the edge
 *  without turning about it. Director and normal of both frames, unit; director × normal is the tangent. */
double frameTurn(const Eigen::Vector3d& director_before, const Eigen::Vector3d& normal_before,
                 const Eigen::Vector3d& director, const Eigen::Vector3d& normal);

/** Bishop frames of all edges of a centreline: that of the hold, transported along the edges. */
class BishopFrames
{
public:
  /** Edges before the hold have the frame of the hold. */
  void transport(const Discretisation& rod, const TwistBoundary& boundary, const State& state);

  /** frameTurn() of an edge since an earlier centreline [rad]. The turn of the material about the tangent is the change
   *  of its twist angle plus this turn. For an edge at an angle α to the hold that rotates with the handle by φ, it is
   *  −φ (1 − cos α). */
  double turnSince(const BishopFrames& before, int edge) const
  {
    return frameTurn(before.director_[edge], before.normal_[edge], director_[edge], normal_[edge]);
  }

private:
  std::vector<Eigen::Vector3d> director_, normal_;  ///< per edge
};

/** Turns of the Bishop frames of all edges by a small displacement of the nodes, to first order [rad]: the sum of
 *  −½ κb·(δe/|e|) over the bends between the hold and the edge.
 *  @param state before the displacement
 *  @param displacement of every node [m]
 *  @param turn n−1; 0 before the first simulated node */
void turnsBy(const Discretisation& rod, const TwistBoundary& boundary, const State& state,
             const std::vector<Eigen::Vector3d>& displacement, std::vector<double>& turn);

/** Turns of the Bishop frames of a curved tip in a step in which a handle turns. In all other steps they are neglected:
 *  there, the tip hardly swings about the handle's axis. */
class FrameTurns
{
public:
  /** Begins a step at its first state. @param first_curved first node with rest curvature */
  void begin(const Discretisation& rod, const TwistBoundary& boundary, const State& state, int first_curved);

  /** Begins a step whose turns are neglected. */
  void neglect() { active_ = false; }

  /** First edge whose turn counts; the largest integer where turns are neglected. */
  int firstCounted() const { return active_ ? std::max(0, first_curved_ - 1) : std::numeric_limits<int>::max(); }

  /** Turns of all edges since the beginning of the step [rad], n−1; empty where they are neglected. */
  const std::vector<double>& since(const Discretisation& rod, const TwistBoundary& boundary, const State& state);

private:
  bool active_ = false;
  int first_curved_ = 0;
  BishopFrames begin_, now_;
  std::vector<double> turn_;
};

}  // namespace endovascular_sim::rod
