#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fluoroscopy/projection/x_ray_geometry.h"
#include "image/volume_grid.h"

namespace endovascular_sim::fluoroscopy
{

constexpr double kInsideLattice = 1e-6;  ///< margin of positions in a lattice against rounding [voxel]

/** Part of a ray in the coordinates of a lattice [voxel]. */
struct LatticeRay
{
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< per unit of depth
  double begin = 0.0;         ///< depth at the entry into the volume
  double end = 0.0;
  double length = 0.0;  ///< length per unit of depth [m]
  int main = 0;         ///< axis whose lattice planes are sampled

  /** Limits the ray to a box.
   *  @return false if nothing remains */
  bool clip(const Eigen::AlignedBox3d& box);

  /** Position on a lattice plane of the main axis [voxel]. */
  double at(double plane, int axis) const
  {
    return origin[axis] + (plane - origin[main]) / direction[main] * direction[axis];
  }
};

/** Rays through the centres of equal squares of the detector, in the coordinates of a lattice. A ray is sampled on the
 *  planes of the axis nearest to the central ray, or of its own nearest axis if it is inclined by more than 60° to
 *  that one. */
class LatticeRays
{
public:
  /** @param box part of the lattice that is not air [voxel]
   *  @param samples squares per side */
  LatticeRays(const image::VolumeGrid& grid, const Eigen::AlignedBox3d& box, const XRayGeometry& geometry, int samples);

  /** Ray of a square.
   *  @return false if it meets only air */
  bool make(int row, int column, LatticeRay& ray) const;

  /** Direction of a ray in the patient frame, per unit of depth. */
  Eigen::Vector3d patientDirection(int row, int column) const { return axes_ * optical(row, column); }

private:
  Eigen::Vector3d optical(int row, int column) const;

  const image::VolumeGrid& grid_;
  const Eigen::AlignedBox3d& box_;
  const XRayGeometry& geometry_;
  Eigen::Matrix3d axes_, from_optical_;
  Eigen::Vector3d origin_;
  int central_;
  double pixels_per_sample_;
};

/** Axis of the largest component. */
int largestAxis(const Eigen::Vector3d& direction);

/** Position as an integer [2⁻³² voxel]. */
std::int64_t fixedPoint(double value);

/** Strides of a storage in which the axis nearest to the patient's z runs fastest. */
std::array<std::ptrdiff_t, 3> stridesFor(const image::VolumeGrid& grid);

}  // namespace endovascular_sim::fluoroscopy
