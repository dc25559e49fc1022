#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "vessel/repair/remesh.h"

namespace endovascular_sim::vessel
{

/** Parameters of the sizing field. */
struct SizingRule
{
  int facets_around = 24;   ///< minimum number of facets around a lumen
  double deviation = 5e-5;  ///< largest distance of a facet's centre from a cylinder of the lumen's radius [m]
  double shortest = 2e-4;   ///< smallest edge length [m]
  double longest = 2.5e-3;  ///< largest edge length [m]
};

/** Remeshing target given by a fine mesh. Points are projected to the closest point with interpolated normals. The
 *  sizing field follows the radius of the lumen: half the chord across it. Keeps a reference to the mesh. */
class MeshTarget : public RemeshTarget
{
public:
  MeshTarget(const geometry::TriangleMesh& mesh, const SizingRule& rule);

  TargetPoint project(const Eigen::Vector3d& p) const override;

  /** Halves the edge length at every vertex that is too far from a remeshed surface.
   *  @param result remeshed surface
   *  @param limit largest distance [m]
   *  @return number of vertices whose edge length was halved */
  int refine(const geometry::MeshDistance& result, double limit);

  /** Radius of the lumen at the closest point of the mesh [m]. */
  double radiusAt(const Eigen::Vector3d& p) const;

private:
  void findRadii();
  void grade();

  const geometry::TriangleMesh& mesh_;
  SizingRule rule_;
  geometry::MeshDistance distance_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<Eigen::Vector3d> normal_;  ///< unit normal, per vertex
  std::vector<double> radius_;           ///< per vertex [m]
  std::vector<double> edge_length_;      ///< per vertex [m]
};

}  // namespace endovascular_sim::vessel
