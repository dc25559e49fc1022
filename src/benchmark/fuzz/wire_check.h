#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::benchmark
{

/** A node of a wire as the check sees it. */
struct CheckedNode
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.0;                                 ///< [m]
  double allowance = 0.0;                              ///< depth that a soft wall has given way by [m]
};

/** Where a wire stands to the wall. */
struct WireFinding
{
  bool finite = true;
  bool outside = false;    ///< some point of the axis is out of the lumen
  double depth = 0.0;      ///< largest depth of the wire's surface beyond the wall, less the allowance [m]
  int edge = -1;           ///< where: edge j joins nodes j and j + 1
  double parameter = 0.0;  ///< and place on it
};

/** Whether a wire is inside of a vessel, by means that share nothing with the contact detector: the winding number over
 *  all triangles for the sign, a tree of boxes (or all triangles) for the distance.
 *
 *  Not the nodes only: the signed distance is 1-Lipschitz, so each edge is bisected until its ends bound what lies
 *  between them. The depth is that of the whole wire to within 2 µm, where it is more than 20 µm. */
class WireCheck
{
public:
  /** @param mesh closed, outward oriented; must outlive the check */
  explicit WireCheck(const geometry::TriangleMesh& mesh) : mesh_(mesh), distance_(mesh) {}

  /** @param nodes in order along the wire */
  WireFinding look(const std::vector<CheckedNode>& nodes);

  /** Signed distance, positive in the lumen: winding number and tree [m]. */
  double signedDistance(const Eigen::Vector3d& point) const;

  /** The same by looking at every triangle twice [m]. */
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
  void note(const Edge& edge, double t, double signed_distance);

  const geometry::TriangleMesh& mesh_;
  geometry::MeshDistance distance_;
  WireFinding finding_;
};

}  // namespace endovascular_sim::benchmark
