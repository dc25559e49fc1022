#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** Closest point of a mesh to a query point. */
struct ClosestPoint
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< closest point [m]
  double distance = 0.0;                            ///< unsigned distance [m]
  int triangle = -1;                                ///< index of the triangle that contains the point
};

/** Distance and ray queries against a fixed mesh by a bounding volume hierarchy of axis-aligned boxes. Used by mesh
 *  preparation and by checks; contact detection has its own search structures (contact/broad_phase). Keeps a copy of
 * the triangles in the order of the hierarchy. */
class MeshDistance
{
public:
  explicit MeshDistance(const TriangleMesh& mesh);

  /** Closest point of the mesh.
   *  @param limit search radius [m]; the result's triangle is −1 if no triangle is nearer */
  ClosestPoint closest(const Eigen::Vector3d& p, double limit = 1e300) const;

  /** True if a point of the mesh is nearer than the limit, i.e. `closest(p).distance < limit`; ends at the first such
   *  triangle. Near the medial axis, where much of the wall is about equally far, this is faster. */
  bool isNearer(const Eigen::Vector3d& p, double limit) const;

  /** Distance along a ray to its first hit [m]; −1 without a hit.
   *  @param direction unit vector */
  double rayHit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

private:
  struct Node
  {
    Eigen::AlignedBox3d box;
    int begin = 0;   ///< first entry of the node's range in order_
    int end = 0;     ///< end of the range
    int right = -1;  ///< index of the second child; −1 for a leaf. The first child is the next node.
  };

  /** Flat cylinder around the triangles of a small node. Where much of the wall is about equally far from a point, it
   *  excludes nodes that their boxes do not exclude. */
  struct Disc
  {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< mean normal of the triangles
    double half_thickness = 0.0;                     ///< [m]
    double radius = -1.0;                            ///< negative: not known [m]

    /** Lower bound of the squared distance from a point to the triangles [m²]. */
    double squaredDistance(const Eigen::Vector3d& p) const;
  };

  Disc discOf(int begin, int end, const TriangleMesh& mesh) const;
  int build(int begin, int end, const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& centres);

  std::vector<Node> nodes_;
  std::vector<Disc> discs_;  ///< one per node
  std::vector<int> order_;   ///< triangle indices, permuted so that every node has a contiguous range
  std::vector<std::array<Eigen::Vector3d, 3>> corners_;  ///< of the triangles in this order [m]
};

/** Winding number of the surface around p: 1 inside a closed, outward oriented mesh, 0 outside. The cost is linear in
 *  the number of triangles. A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983. */
double windingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& p);

}  // namespace endovascular_sim::geometry
