#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fluoroscopy/projection/signed_depth.h"
#include "fluoroscopy/projection/x_ray_geometry.h"
#include "geometry/triangle_mesh.h"
#include "motion/map/motion_map.h"

namespace endovascular_sim::fluoroscopy
{

/** Path lengths in a vessel that moves with the heart, for a sequence of frames.
 *
 *  Triangles with a vertex in the fade move: their vertices are displaced and they are projected again in every frame.
 * The sum of all others is kept while the pose rests. The lengths equal those of vesselPathLength() of the moved mesh,
 * but for the order of the sums; of a resting map they are its lengths bit for bit. */
class MovingVessel
{
public:
  /** Replaces the mesh. @param mesh at rest; empty: no vessel */
  void setMesh(geometry::TriangleMesh mesh);

  const geometry::TriangleMesh& mesh() const { return mesh_; }

  /** Computes the lengths in a pose at a phase.
   *  @throws InputError if the vessel extends to the source */
  void project(const XRayGeometry& geometry, const motion::MotionMap& map);

  /** Path length of each pixel's ray [m], as vesselPathLength(). */
  const std::vector<double>& lengths() const { return lengths_; }

  /** Vertices in the image of the last projection, where a motion has moved them. @pre the map did not rest */
  const std::vector<Corner>& corners() const { return corners_; }
  /** Their positions [m]. */
  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }

  /** Vertices of the mesh that the last motion moves. */
  const std::vector<int>& movingVertices() const { return vertices_; }

  /** Number of triangles that the last motion moves; 0 before. */
  std::size_t movingTriangles() const { return moving_.size(); }

private:
  void divide(const motion::Fade& fade);
  void projectFixed(const XRayGeometry& geometry);

  geometry::TriangleMesh mesh_;
  std::optional<motion::Fade> fade_;             ///< of the parts below; empty: not yet divided
  std::vector<int> vertices_;                    ///< those that move
  std::vector<Eigen::Vector3d> rest_, moved_;    ///< their positions [m]
  std::vector<Eigen::Vector3i> moving_, fixed_;  ///< triangles
  std::optional<CArmPose> pose_;                 ///< of corners_ and fixed_sum_
  std::vector<Corner> corners_;                  ///< of all vertices
  std::vector<Eigen::Vector3d> positions_;       ///< of all vertices, moved [m]
  std::vector<double> fixed_sum_;                ///< signed depths of the fixed triangles
  std::vector<double> lengths_;
};

}  // namespace endovascular_sim::fluoroscopy
