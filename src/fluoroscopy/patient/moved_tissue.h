#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fluoroscopy/motion/body_motion.h"
#include "fluoroscopy/motion/displacement_lattice.h"
#include "fluoroscopy/patient/lattice_ray.h"
#include "fluoroscopy/patient/volume_projection.h"

namespace endovascular_sim::fluoroscopy
{

/** How the moved tissue is sampled along a ray. */
enum class MotionSampling
{
  kExact,  ///< every sample is pulled back: the reference, for single images
  kFast    ///< displacements are interpolated, see MovedTissue
};

/** Change of a patient's projection by his motion: the areal density of soft tissue along each ray in the moved body
 * minus that in the resting one.
 *
 *  The soft tissue moves, bones rest. So that no hole of the shape of a rib moves with the tissue, what moves is a
 * volume f in which soft tissue fills the bones: f = tissue + 1050/1920 bone, in the ratio in which bone displaces
 * tissue. The change of a ray is Σ (f(X(x)) − f(x)) times the length between samples, at the samples x of
 * VolumeProjection that lie where something moves, with trilinear interpolation and the places X of BodyMotion.
 * Densities are carried along: a lung that is stretched keeps its density.
 *
 *  kFast takes a sample every 2.5 mm along the main axis, or every lattice plane, and interpolates the displacements
 * from a lattice of 6 mm, linearly over 7.5 mm. */
class MovedTissue
{
public:
  /** @param projection of the patient at rest
   *  @param frame heart of all motions */
  MovedTissue(const VolumeProjection& projection, const motion::HeartFrame& frame);

  const motion::HeartFrame& frame() const { return frame_; }

  /** Change by a motion with samples × samples rays [kg/m²], in row-major order from the top left.
   *  @pre the motion is of the same heart */
  std::vector<float> change(const XRayGeometry& geometry, int samples, const BodyMotion& motion,
                            MotionSampling sampling);

private:
  /** Part of a ray on which something moves: planes of its main axis. */
  struct Part
  {
    std::int64_t first = 0, last = -1, step = 1;
    bool empty() const { return last < first; }
    int samples() const { return static_cast<int>((last - first) / step) + 1; }
  };

  using Position = std::array<double, 3>;

  template <typename Visit>
  void forEachRay(const XRayGeometry& geometry, int samples, std::int64_t step, const Visit& visit) const;
  void sumResting(const XRayGeometry& geometry, int samples, std::int64_t step);
  double sumAtRest(const LatticeRay& ray, const Part& part) const;
  double sumMoved(const LatticeRay& ray, const Part& part, const BodyMotion& motion);
  double sumMovedFast(const LatticeRay& ray, const Part& part, const Eigen::Vector3d& source,
                      const Eigen::Vector3d& direction) const;
  double sumOfSegment(const Position& from, const Position& to, int count) const;

  image::VolumeGrid grid_;        ///< of the whole volume
  Eigen::AlignedBox3d occupied_;  ///< as of the projection [voxel]
  motion::HeartFrame frame_;
  BodyMotion at_rest_;          ///< for the places in which this heart moves
  Eigen::Vector3i low_, size_;  ///< of the cropped volume, in the whole one [voxel]
  std::array<std::ptrdiff_t, 3> stride_{};
  std::vector<std::uint8_t> filled_;  ///< f in steps of tissue, where something moves

  std::int64_t step_, knot_;  ///< between samples and displacements of kFast [plane]
  DisplacementLattice lattice_;
  std::optional<CArmPose> resting_pose_;  ///< of resting_
  std::int64_t resting_step_ = 0;         ///< of resting_ [plane]
  std::vector<double> resting_;           ///< sums at rest, row-major, for the last pose
  std::vector<Eigen::Vector3d> points_, rest_;
};

}  // namespace endovascular_sim::fluoroscopy
