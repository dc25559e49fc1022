#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::visualization
{

/** Colour with components in [0, 1]. */
struct Colour
{
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;
};

/** Surface of a wire as independent triangles: three corners each, counter-clockwise seen from outside. */
struct TubeMesh
{
  std::vector<Eigen::Vector3d> corners;     ///< [m]
  std::vector<std::size_t> node_of_corner;  ///< centreline node that each corner belongs to
};

/** Sweeps a regular polygon along a centreline.
 *
 *  The polygon's frame is carried from edge to edge by parallel transport (Bishop's frame), so the tube does not twist
 *  where the curve bends; at a node it stands in the plane that halves the two edges.
 *  @param nodes centreline [m]; coinciding neighbours are skipped
 *  @param radius at each node [m], same length as @p nodes
 *  @param sides corners of the polygon, at least 3
 *  @param scale factor on the radius, to make a thin wire visible [1]
 *  @return two triangles per side and edge, and a fan at each end; empty for fewer than two distinct nodes */
TubeMesh tubeMesh(const std::vector<Eigen::Vector3d>& nodes, const std::vector<double>& radius, int sides,
                  double scale = 1.0);

/** Unit vectors normal to a centreline's tangents, one per node, parallel-transported from the first.
 *  @param nodes centreline without coinciding neighbours, at least two [m] */
std::vector<Eigen::Vector3d> transportedNormals(const std::vector<Eigen::Vector3d>& nodes);

/** Colour of a contact force: steel grey at 0, then yellow, orange to red at @p full_scale and beyond.
 *  @param force magnitude [N]
 *  @param full_scale force that is drawn red [N] */
Colour forceColour(double force, double full_scale);

}  // namespace endovascular_sim::visualization
