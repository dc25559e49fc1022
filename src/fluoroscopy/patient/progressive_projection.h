#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "fluoroscopy/patient/change_cache.h"
#include "fluoroscopy/patient/moved_tissue.h"
#include "fluoroscopy/patient/volume_projection.h"
#include "fluoroscopy/projection/patient.h"
#include "patient/tissue/tissue.h"

namespace endovascular_sim::fluoroscopy
{

/** Resolutions of a ProgressiveProjection. */
struct ProgressiveResolution
{
  int moving = 128;                               ///< rays per side of the first image after a movement
  int at_rest = 256;                              ///< rays per side of the final image
  int rays_per_frame = 8192;                      ///< rays of the final image per call: 256² in 8 frames
  MotionSampling motion = MotionSampling::kFast;  ///< of the moving heart and lungs
};

/** Projection of the patient for a sequence of frames: coarse in the frame after a movement of C-arm or table, then
 * refined by a fixed number of rays per frame. The refined image replaces the coarse one as a whole.
 *
 *  The work is counted in rays and reads no clock. An image is either the coarse or the final one; both depend on
 *  geometry, volume and motion alone.
 *
 *  The motion of heart and lungs adds the change of MovedTissue, at the resolution of the first image, so that bones
 * keep the final one. The change of an equal motion in the same pose is kept (ChangeCache); a PhaseGrid limits the
 * number of motions. */
class ProgressiveProjection : public Patient
{
public:
  static constexpr std::size_t kMemory = std::size_t{96} << 20;  ///< for the changes at earlier motions [bytes]

  explicit ProgressiveProjection(const patient::DensityVolume& volume, const ProgressiveResolution& resolution = {});

  /** @param projection of the patient's volume; shared by any number of sequences */
  explicit ProgressiveProjection(std::shared_ptr<const VolumeProjection> projection,
                                 const ProgressiveResolution& resolution = {});

  const ArealDensityImage& frame(const XRayGeometry& geometry) override;

  void complete(const XRayGeometry& geometry) override;
  bool isComplete() const override { return next_row_ >= refined_.samples; }

  void setMotion(const BodyMotion& motion) override;

  /** Frames in motion so far: all, and those that took the change of an earlier one. @{ */
  std::uint64_t movedFrames() const { return moved_frames_; }
  std::uint64_t reusedFrames() const { return reused_frames_; }
  /** @} */

  int revision() const override { return revision_; }

  /** The lumen contains blood (replaceByBlood()). */
  double lumenDensity() const override { return patient::propertiesOf(patient::Tissue::kBlood).density; }

private:
  bool begin(const XRayGeometry& geometry);
  void refine(const XRayGeometry& geometry, int rows);
  void updateStill(const XRayGeometry& geometry);
  const std::vector<float>& change(const XRayGeometry& geometry);

  std::shared_ptr<const VolumeProjection> projection_;
  ProgressiveResolution resolution_;
  bool started_ = false;
  CArmPose pose_;
  int next_row_ = 0;  ///< of the refined image
  int revision_ = 0;
  ArealDensityImage refined_;
  ArealDensityImage still_;    ///< patient at rest
  bool still_is_new_ = false;  ///< since the last frame

  BodyMotion motion_;
  bool motion_is_new_ = false;               ///< since the last frame
  std::optional<MovedTissue> moved_tissue_;  ///< of the heart of the last motion
  ChangeCache changes_{kMemory};
  std::vector<float> change_;  ///< where changes_ does not hold it
  ArealDensityImage image_;    ///< moved patient
  std::uint64_t moved_frames_ = 0, reused_frames_ = 0;
};

}  // namespace endovascular_sim::fluoroscopy
