#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** Indexed triangle mesh; for a vessel, the wall of the lumen in the patient frame.
 *
 *  A mesh that has passed checkMesh() is watertight and outward oriented: face normals (right-hand rule) point out of
 *  the lumen, so the signed volume is positive. */
struct TriangleMesh
{
  std::vector<Eigen::Vector3d> vertices;   ///< [m]
  std::vector<Eigen::Vector3i> triangles;  ///< vertex indices, counter-clockwise seen from outside the lumen

  /** Signed volume by the divergence theorem [m³]; positive if normals point outwards. */
  double signedVolume() const;

  /** Content hash of the coordinates (IEEE-754 bytes) and indices in storage order. */
  std::uint64_t hash() const;
};

}  // namespace endovascular_sim::geometry
