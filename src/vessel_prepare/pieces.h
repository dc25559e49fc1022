#pragma once

#include <vector>

#include <Eigen/Core>

#include "vessel/mesh.h"

namespace endovascular_sim::vessel
{

/** The pieces of a mesh (joined over edges) as meshes of their own, largest volume first. */
std::vector<TriangleMesh> separatePieces(const TriangleMesh& mesh);

/** The shortest way from the end or side of a closed piece to another surface. */
struct Gap
{
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< middle of the piece's lumen [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< on the other surface [m]
  double width = 0.0;                              ///< between the walls [m]
  double radius = 0.0;                             ///< of the piece's lumen there [m]
};

/** @pre @p piece is closed and outward oriented. Where it has no lumen that an instrument fits in, radius is 0. */
Gap findGap(const TriangleMesh& piece, const TriangleMesh& other);

/** A closed tube across the gap, as wide as the piece's lumen, that reaches one radius into the other side. */
TriangleMesh bridgeOver(const Gap& gap);

/** A ball that stops up an opening. */
struct Plug
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.0;                               ///< [m]
};

/** A closed ball of triangles. */
TriangleMesh ballMesh(const Plug& plug);

/** Appends a mesh without joining vertices. */
void append(TriangleMesh& mesh, const TriangleMesh& more);

}  // namespace endovascular_sim::vessel
