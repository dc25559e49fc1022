#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "rod/model/curved_parts.h"
#include "rod/model/wire.h"

namespace endovascular_sim::rod
{

/** Rest curvature that acts at a node near a mouth. */
struct RestAtMouth
{
  Eigen::Vector2d curvature;  ///< as Discretisation::rest_curvature [1]
  Eigen::Vector2d slope;      ///< minus its derivative by the mouth's arc length [1/m]
};

/** Discrete rod: the wire's properties per node and per edge. Constant between changes of the nodes.
 *
 *  Node i lies at arc length position[i] from the proximal end; edge j joins nodes j and j+1. Nodal stiffnesses are
 *  those of the Voronoi cell, its compliances added in series, so that a section joint may lie anywhere. */
struct Discretisation
{
  std::vector<double> position;                 ///< arc length from the proximal end [m], n
  std::vector<double> rest_length;              ///< ē of every edge [m], n−1
  std::vector<double> cell_length;              ///< Voronoi length, the sum of both half edges [m], n
  std::vector<double> bending_stiffness;        ///< EI [N·m²], n
  std::vector<double> torsional_stiffness;      ///< GJ [N·m²], n
  std::vector<double> axial_stiffness;          ///< EA per edge [N], n−1
  std::vector<double> mass;                     ///< lumped [kg], n
  std::vector<double> radius;                   ///< outer radius [m], n
  std::vector<double> friction;                 ///< Coulomb coefficient; NaN: the wall's coefficient [1], n
  std::vector<double> friction_share;           ///< part of the surface with that coefficient; empty: all [1], n
  std::vector<Eigen::Vector2d> rest_curvature;  ///< 2 tan(angle/2) of restAngle() [1], n
  int first_curved = 0;                         ///< first node with rest curvature, n when there is none
  std::vector<CurvedPart> curved_parts;         ///< ascending

  int nodes() const { return static_cast<int>(position.size()); }
  double length() const { return position.back(); }

  /** Part of an inner node's cell that lies beyond an arc length [m], 0 to 1. */
  double shareBeyond(int node, double arc_length) const
  {
    const double begin = position[node] - 0.5 * rest_length[node - 1];
    return std::max(0.0, std::min(1.0, 1.0 - (arc_length - begin) / cell_length[node]));
  }

  /** Rest curvature that acts at a node near a mouth. */
  RestAtMouth restAt(int node, const Mouth& mouth) const;

  /** Acting share at a node near a mouth, weighted with its hat function, 0 to 1. */
  double actingShare(int node, const Mouth& mouth) const
  {
    return hatBeyond(position, node, mouth) / cell_length[node];
  }

  /** Coulomb coefficient between a node and a wall whose coefficient is @p wall. */
  double frictionOn(double wall, int node) const
  {
    if (std::isnan(friction[node]))
      return wall;
    return friction_share.empty() ? friction[node] : wall + friction_share[node] * (friction[node] - wall);
  }
};

/** Discretises a wire at the given arc lengths.
 *  @param position strictly increasing, from 0 to the wire's length, at least 3 */
Discretisation discretise(const Wire& wire, const std::vector<double>& position);

/** The same, reusing the memory of an existing object. */
void discretise(const Wire& wire, const std::vector<double>& position, Discretisation& rod);

/** Mass of the wire between two arc lengths from the proximal end [kg]. */
double massBetween(const Wire& wire, double begin, double end);

/** Discretises a wire with equally spaced nodes.
 *  @param nodes at least 3 */
Discretisation discretiseUniformly(const Wire& wire, int nodes);

/** Arc lengths of equally spaced nodes, with further ones where rest curvature turns an edge so far that the force of
 *  its straightening has an error: EI κ̄²/2 · (κ̄ē)²/12, measured with `benchmark mouth`. Two edges on either side of
 * such a section are divided too: a step of the lengths at its end would double the error.
 *  @param nodes at least 3, before edges are divided
 *  @param largest_error of that force [N] */
std::vector<double> resolvedPositions(const Wire& wire, int nodes, double largest_error);

}  // namespace endovascular_sim::rod
