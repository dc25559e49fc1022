#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "vessel/repair/remesh.h"

namespace endovascular_sim::vessel
{

/** How long the facets of a mesh may be. */
struct SizingRule
{
  int facets_around = 24;   ///< around a lumen, at least
  double deviation = 5e-5;  ///< of a facet's middle from a wall of the lumen's radius, at most [m]
  double shortest = 2e-4;   ///< [m]
  double longest = 2.5e-3;  ///< [m]
};

/** The wall as a fine mesh: points go to the closest point, normals are interpolated, facets follow the lumen's radius
 *  (half the chord across it). Keeps a reference to the mesh. */
class MeshSizing : public RemeshWall
{
public:
  MeshSizing(const geometry::TriangleMesh& mesh, const SizingRule& rule);

  WallPoint onWall(const Eigen::Vector3d& p) const override;

  /** Halves the facets round every vertex that lies farther than @p limit [m] from a mesh made of this wall.
   *  @return the number of these vertices whose facets could be halved */
  int refine(const geometry::MeshDistance& made, double limit);

  /** Radius of the lumen at the closest point of the wall [m]. */
  double radiusAt(const Eigen::Vector3d& p) const;

private:
  void findRadii();
  void grade();

  const geometry::TriangleMesh& mesh_;
  SizingRule rule_;
  geometry::MeshDistance distance_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<Eigen::Vector3d> normal_;  ///< per vertex
  std::vector<double> radius_;           ///< per vertex [m]
  std::vector<double> facet_;            ///< per vertex [m]
};

}  // namespace endovascular_sim::vessel
