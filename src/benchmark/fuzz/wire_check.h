#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::benchmark
{

/** Node of a checked wire. */
struct CheckedNode
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< position of the node [m]
  double radius = 0.0;                                 ///< radius of the wire [m]
  double allowance = 0.0;                              ///< permitted depth in a soft wall [m]
};

/** Result of a check of a wire. */
struct WireFinding
{
  bool finite = true;
  bool outside = false;    ///< a point of the axis is outside the lumen
  double depth = 0.0;      ///< largest penetration depth of the surface minus the allowance [m]
  int edge = -1;           ///< edge of the largest depth; edge j joins nodes j and j + 1
  double parameter = 0.0;  ///< parameter of the largest depth on its edge, 0 to 1
};

/** Check that a wire lies inside a vessel, independent of the contact detector: the winding number over all triangles
 *  gives the sign, a box tree (or all triangles) the distance.
 *
 *  The check covers edges: the signed distance is 1-Lipschitz, so each edge is bisected until its ends bound the
 * distances between them. Depths above 20 µm are exact to 2 µm over the whole wire. */
class WireCheck
{
public:
  /** @param mesh closed, outward oriented; must outlive the check */
  explicit WireCheck(const geometry::TriangleMesh& mesh) : mesh_(mesh), distance_(mesh) {}

  /** Checks a wire.
   *  @param nodes nodes in order along the wire */
  WireFinding check(const std::vector<CheckedNode>& nodes);

  /** Signed distance, positive in the lumen, from winding number and box tree [m]. */
  double signedDistance(const Eigen::Vector3d& point) const;

  /** Signed distance by brute force over all triangles [m]. */
  double bruteSignedDistance(const Eigen::Vector3d& point) const;

private:
  struct Edge
  {
    const CheckedNode* begin;
    const CheckedNode* end;
    double length;
    int index;
  };

  double walk(const Edge& edge, double t0, double signed0, double t1, double distance1);
  void record(const Edge& edge, double t, double signed_distance);

  const geometry::TriangleMesh& mesh_;
  geometry::MeshDistance distance_;
  WireFinding finding_;
};

}  // namespace endovascular_sim::benchmark
