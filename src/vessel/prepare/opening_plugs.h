#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Location at which an opening of a thick wall is plugged. */
struct Plug
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< point in the lumen near the opening [m]
  double radius = 0.0;                               ///< upper bound of the distance to the surrounding wall [m]
};

/** Disc that closes an opening. */
struct Disc
{
  geometry::TriangleMesh mesh;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d out = Eigen::Vector3d::UnitZ();    ///< unit normal, out of the vessel
  double reach = 0.0;                                ///< largest radius [m]
};

/** Disc in the plane through the plug's centre with the smallest cross-section of the lumen.
 *  @param overlap extension of the disc beyond the wall's surface [m]
 *  @param source name of the mesh in errors
 *  @throws InputError if no wall surrounds the plug within its radius */
Disc fitDisc(const Plug& plug, const geometry::MeshDistance& walls, double overlap, const std::string& source);

/** Inner surface of a thick wall: triangles deeper than a threshold below its outer surface, and triangles near the
 *  discs on their inner side. The result is a soup of small triangles.
 *  @param outside outer surface, with all openings plugged
 *  @param depth threshold [m] */
geometry::TriangleMesh innerWall(const geometry::TriangleMesh& soup, const geometry::TriangleMesh& outside,
                                 double depth, const std::vector<Disc>& discs);

}  // namespace endovascular_sim::vessel
