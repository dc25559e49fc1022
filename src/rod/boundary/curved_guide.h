#pragma once

#include <array>

#include <Eigen/Core>

#include "rod/boundary/introducer_guide.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/twist/transported_frame.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Bow of an edge by rest curvature that its nodes do not resolve, in the material frame [m]: the curve of the edge's
 *  own rest curvature, less that of the mean of both nodes. Zero where rest curvature is uniform. */
struct RestBow
{
  Eigen::Vector2d even = Eigen::Vector2d::Zero();  ///< as EdgeBow [m]
  Eigen::Vector2d odd = Eigen::Vector2d::Zero();
  Eigen::Vector2d even_slope = Eigen::Vector2d::Zero();  ///< derivatives by the mouth's arc length [1]
  Eigen::Vector2d odd_slope = Eigen::Vector2d::Zero();
};

/** Bow of an edge by its rest curvature near a mouth. */
RestBow restBowAt(const Discretisation& rod, const Mouth& mouth, int edge);

/** Term of a curved edge in the guide. */
struct CurvedGuideTerm
{
  /** Its gradient by the positions includes the tilt of the edge's frame, which carries the RestBow. */
  CurvedEdge edge;
  std::array<double, 4> spread;  ///< derivatives of EdgeBow::even by the nodes from that before the edge on [1]
  double by_mouth;               ///< derivative of the energy by the mouth's arc length, at fixed nodes [N]
};

/** Guide of the introducer on a wire with rest curvature. Between its nodes, the wire is a curve: a moment that is
 *  linear on the edge bends it, and the rest curvature that acts there. A chord would cut the corner of the curve, by
 *  an energy that changes with the position of the nodes about the mouth.
 *
 *  The couple of a RestBow about the edge's axis is neglected: it vanishes while the wire bends in one plane. */
class CurvedGuide
{
public:
  explicit CurvedGuide(const IntroducerGuide& guide) : guide_(guide) {}

  /** True where the wire's edges are curves: one wire with rest curvature. */
  static bool matters(const Discretisation& rod, const State& state)
  {
    return state.layers.size() <= 1 && rod.first_curved < rod.nodes() && !rod.curved_parts.empty();
  }

  /** Force on the wire along itself at the mouth: the negative derivative of the energy by the mouth's arc length, at
   *  fixed nodes [N]. */
  double forceAtMouth(const Discretisation& rod, const TwistBoundary& hold, const State& state) const;

  /** Calls visit(edge, term) for every edge in the guide. */
  template <typename Visit>
  void forEachEdge(const Discretisation& rod, const TwistBoundary& hold, const State& state, Visit visit) const
  {
    Walk walk{rod, hold, state, {hold.tangent, hold.director}};
    CurvedGuideTerm term;
    for (int j = state.first_node; j + 1 < rod.nodes() && guide_.holds(state.position[j]); ++j)
    {
      evaluate(walk, j, term);
      visit(j, term);
    }
  }

private:
  /** Walk along the edges with their frames. */
  struct Walk
  {
    const Discretisation& rod;
    const TwistBoundary& hold;
    const State& state;
    TransportedFrame frame;
    bool curved = false;  ///< the frame is that of the last edge
  };

  static bool follow(Walk& walk, int edge);
  void evaluate(Walk& walk, int edge, CurvedGuideTerm& term) const;
  void evaluateUneven(const Walk& walk, int edge, CurvedGuideTerm& term) const;
  static EdgeBow bowOf(const Walk& walk, int edge, CurvedGuideTerm& term);

  const IntroducerGuide& guide_;
};

}  // namespace endovascular_sim::rod
