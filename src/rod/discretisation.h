#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/wire.h"

namespace endovascular_sim::rod
{

/** A wire cut into nodes: what the solver needs per node and per edge. Constant while the sampling is.
 *
 *  Node i sits at arc length position[i] from the proximal end; edge j joins nodes j and j+1. Nodal stiffnesses are
 *  those of the Voronoi cell, its compliances added in series, so that a section joint may fall anywhere. */
struct Discretisation
{
  std::vector<double> position;                 ///< arc length from the proximal end [m], n
  std::vector<double> rest_length;              ///< ē of every edge [m], n−1
  std::vector<double> cell_length;              ///< Voronoi length, half of both edges [m], n
  std::vector<double> bending_stiffness;        ///< EI [N·m²], n
  std::vector<double> torsional_stiffness;      ///< GJ [N·m²], n
  std::vector<double> axial_stiffness;          ///< EA per edge [N], n−1
  std::vector<double> mass;                     ///< lumped [kg], n
  std::vector<double> radius;                   ///< outer [m], n
  std::vector<double> friction;                 ///< Coulomb coefficient, NaN: the wall's, n
  std::vector<Eigen::Vector2d> rest_curvature;  ///< integrated over the cell, 2 tan(angle/2) [1], n
  int first_curved = 0;                         ///< first node with rest curvature, n when there is none

  int nodes() const { return static_cast<int>(position.size()); }
  double length() const { return position.back(); }
};

/** Cuts a wire at the given arc lengths.
 *  @param position strictly increasing, from 0 to the wire's length, at least 3 */
Discretisation discretise(const Wire& wire, const std::vector<double>& position);

/** The same into an existing object, whose memory is used again. */
void discretise(const Wire& wire, const std::vector<double>& position, Discretisation& rod);

/** Mass of the wire between two arc lengths from the proximal end [kg]. */
double massBetween(const Wire& wire, double begin, double end);

/** @param nodes number of equally spaced nodes over the wire, at least 3 */
Discretisation discretiseUniformly(const Wire& wire, int nodes);

}  // namespace endovascular_sim::rod
