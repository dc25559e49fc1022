#pragma once

#include <cstdint>

#include "patient/solid/body_part.h"
#include "patient/volume/density_volume.h"

namespace endovascular_sim::patient
{

/** Similarity from the body's frame [mm] to the patient's [m]. */
struct BodyFrame
{
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the body's frame in the patient's [m]
  double scale = 1.0;                                ///< size relative to the body described in this folder

  Point fromPatient(const Eigen::Vector3d& p) const { return ((p - origin) / (1e-3 * scale)).cast<float>(); }
  Eigen::Vector3d toPatient(const Point& p) const { return origin + 1e-3 * scale * p.cast<double>(); }
};

/** Draws the parts into a volume whose lattice is parallel to the patient's axes. Edges are as wide as a voxel. Works
 *  through slabs of a few layers, so that no memory but the volume's is needed.
 *  @param seed of the texture */
void voxelise(const BodyPlan& plan, const BodyFrame& frame, std::uint64_t seed, DensityVolume& volume);

}  // namespace endovascular_sim::patient
