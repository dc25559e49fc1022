#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** The pieces of a mesh (joined over edges) as meshes of their own, largest volume first. */
std::vector<geometry::TriangleMesh> separatePieces(const geometry::TriangleMesh& mesh);

/** The shortest way from the end or side of a closed piece to another surface. */
struct Gap
{
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< middle of the piece's lumen [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< on the other surface [m]
  double width = 0.0;                              ///< between the walls [m]
  double radius = 0.0;                             ///< of the piece's lumen there [m]
};

/** @pre @p piece is closed and outward oriented. Where it has no lumen that an instrument fits in, radius is 0. */
Gap findGap(const geometry::TriangleMesh& piece, const geometry::TriangleMesh& other);

/** A closed tube across the gap, as wide as the piece's lumen, that reaches one radius into the other side. */
geometry::TriangleMesh bridgeOver(const Gap& gap);

/** Where an opening of a wall with a thickness is stopped up. */
struct Plug
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< in the lumen, near the opening [m]
  double radius = 0.0;                               ///< the wall is nearer than this all around [m]
};

/** A lid across an opening. */
struct Disc
{
  geometry::TriangleMesh mesh;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d out = Eigen::Vector3d::UnitZ();    ///< the way out, unit
  double reach = 0.0;                                ///< its largest radius [m]
};

/** The lid in the plane through the plug's centre in which the lumen is smallest; it ends @p overlap [m] behind the
 *  wall's surface.
 *  @throws InputError when no wall is all around within the plug's radius */
Disc discOver(const Plug& plug, const geometry::MeshDistance& walls, double overlap, const std::string& source);

/** The walls of the hollow inside of a wall with a thickness: what lies deeper than @p depth [m] inside of the wall's
 *  outside (which a stopped up hollow counts to), and what is near the lids on their inner side. Cut into small
 *  triangles. */
geometry::TriangleMesh hollowWalls(const geometry::TriangleMesh& soup, const geometry::TriangleMesh& outside,
                                   double depth, const std::vector<Disc>& discs);

/** Appends a mesh without joining vertices. */
void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& more);

}  // namespace endovascular_sim::vessel
