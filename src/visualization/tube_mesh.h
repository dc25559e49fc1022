#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::visualization
{

/** RGB colour with components in [0, 1]. */
struct Colour
{
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;
};

/** Surface of a wire as a list of triangles with three corners each, counter-clockwise seen from outside. */
struct TubeMesh
{
  std::vector<Eigen::Vector3d> corners;     ///< corners of the triangles [m]
  std::vector<std::size_t> node_of_corner;  ///< index of the centreline node of each corner
};

/** Sweeps a regular polygon along a centreline.
 *
 *  The frame of the polygon is parallel-transported along the edges (Bishop frame), so that the tube does not twist. At
 *  a node the polygon lies in the bisecting plane of the two edges.
 *  @param nodes centreline [m]; coinciding adjacent nodes are skipped
 *  @param radius radius at each node [m], the same length as @p nodes
 *  @param sides number of corners of the polygon, at least 3
 *  @param scale factor on the radius, to make a thin wire visible [1]
 *  @return two triangles per side and edge, and a fan at each end; empty for fewer than two distinct nodes */
TubeMesh tubeMesh(const std::vector<Eigen::Vector3d>& nodes, const std::vector<double>& radius, int sides,
                  double scale = 1.0);

/** Unit normals of a centreline, one per node, parallel-transported from the first node.
 *  @param nodes centreline of at least two nodes without coinciding adjacent ones [m] */
std::vector<Eigen::Vector3d> transportedNormals(const std::vector<Eigen::Vector3d>& nodes);

/** Linear interpolation from @p a (share 0) to @p b (share 1). */
Colour blend(const Colour& a, const Colour& b, float share);

/** Colour of a contact force: steel grey at 0, then yellow, orange to red at @p full_scale and beyond.
 *  @param force magnitude of the force [N]
 *  @param full_scale force that is shown in red [N] */
Colour forceColour(double force, double full_scale);

}  // namespace endovascular_sim::visualization
