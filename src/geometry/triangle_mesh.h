#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** A triangle mesh of the lumen's wall in the patient frame [m].
 *
 *  A mesh that has passed checkMesh() is watertight and oriented: the faces' normals (right-hand rule) point
 *  out of the lumen, into the tissue, so the signed volume is positive. */
struct TriangleMesh
{
  std::vector<Eigen::Vector3d> vertices;   ///< [m]
  std::vector<Eigen::Vector3i> triangles;  ///< vertex indices, counter-clockwise seen from the tissue

  /** Signed volume [m³] by the divergence theorem; positive when normals point out of the lumen. */
  double signedVolume() const;

  /** Content hash over coordinates (IEEE-754 bytes) and indices, in their order. */
  std::uint64_t hash() const;
};

}  // namespace endovascular_sim::geometry
