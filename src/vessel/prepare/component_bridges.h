#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Splits a mesh into its connected components (connected over edges), by decreasing volume. */
std::vector<geometry::TriangleMesh> splitComponents(const geometry::TriangleMesh& mesh);

/** Shortest gap between a closed component and another surface. */
struct Gap
{
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< centre of the component's lumen at the gap [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< closest point of the other surface [m]
  double width = 0.0;                              ///< distance between the walls [m]
  double radius = 0.0;                             ///< radius of the component's lumen at the gap [m]
};

/** Finds the shortest gap. The radius is 0 if the component has no lumen wide enough for an instrument.
 *  @pre @p piece is closed and outward oriented */
Gap findGap(const geometry::TriangleMesh& piece, const geometry::TriangleMesh& other);

/** Closed tube that bridges a gap. It has the radius of the component's lumen and extends one radius into the other
 *  surface. */
geometry::TriangleMesh bridgeMesh(const Gap& gap);

/** Appends a mesh without welding vertices. */
void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& more);

}  // namespace endovascular_sim::vessel
