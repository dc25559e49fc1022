#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** The point of a mesh closest to another point. */
struct ClosestPoint
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the mesh [m]
  double distance = 0.0;                            ///< ≥ 0 [m]
  int triangle = -1;
};

/** Distance queries to a fixed mesh over a tree of boxes. For preparation and checks; the wire's contact has its own
 *  detector. Keeps a reference to the mesh. */
class MeshDistance
{
public:
  explicit MeshDistance(const TriangleMesh& mesh);

  /** Closest point of the mesh; the triangle is −1 when none is nearer than @p limit [m]. */
  ClosestPoint closest(const Eigen::Vector3d& p, double limit = 1e300) const;

  /** Distance along a ray to its first hit, −1 without one. @param direction unit vector */
  double rayHit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

private:
  struct Node
  {
    Eigen::AlignedBox3d box;
    int begin = 0;  ///< into order_
    int end = 0;
    int right = -1;  ///< second child, the first one follows the node; −1 for a leaf
  };

  int build(int begin, int end, const std::vector<Eigen::Vector3d>& centres);

  const TriangleMesh& mesh_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
};

/** How often the surface winds round p: 1 inside of a closed, outward oriented mesh, 0 outside. Looks at every
 * triangle. A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983. */
double windingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& p);

}  // namespace endovascular_sim::geometry
