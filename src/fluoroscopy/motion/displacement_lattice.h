#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fluoroscopy/motion/body_motion.h"

namespace endovascular_sim::fluoroscopy
{

/** Displacements of pulled-back points, φ⁻¹ and diaphragm, on a cubic lattice, for quick interpolation. */
class DisplacementLattice
{
public:
  /** @param box of the points [m]
   *  @param spacing of the nodes [m] */
  DisplacementLattice(const Eigen::AlignedBox3d& box, double spacing);

  /** Computes the displacements of a motion, in a frame of its own: turn · (X − x). */
  void fill(const BodyMotion& motion, const Eigen::Matrix3d& turn);

  /** Trilinear interpolation; zero outside of the box. @param point moved position [m] */
  Eigen::Vector3f at(const Eigen::Vector3d& point) const;

private:
  Eigen::Vector3d origin_;
  double inverse_spacing_;
  Eigen::Vector3i size_;
  std::vector<Eigen::Vector3d> nodes_;         ///< [m]
  std::vector<Eigen::Vector3d> rest_;          ///< the same, pulled back [m]
  std::vector<Eigen::Vector4f> displacement_;  ///< x runs fastest; the last component is unused
};

}  // namespace endovascular_sim::fluoroscopy
