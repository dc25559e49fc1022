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
  MotionSampling motion = MotionSampling::kFast;  ///< of the moving heart and lungs; kExact uses no earlier phase
};

/** Projection of the patient for a sequence of frames: coarse in the frame after a movement of C-arm or table, then
 * refined by a fixed number of rays per frame. The refined image replaces the coarse one as a whole.
 *
 *  The work is counted in rays and reads no clock. The image of a frame depends only on the number of frames since the
 *  last movement, and the image at rest only on geometry and volume.
 *
 *  The motion of heart and lungs adds the change of MovedTissue, at the resolution of the first image, so that bones
 * keep the final one. With kFast, the change of an earlier frame in the same pose is taken again if its motion differs
 * by at most kTolerance (ChangeCache). With kExact an image depends on geometry, volume and motion alone. */
class ProgressiveProjection : public Patient
{
public:
  static constexpr double kTolerance = 0.7e-3;                   ///< of the places at an earlier phase [m]
  static constexpr std::size_t kMemory = std::size_t{96} << 20;  ///< for the changes at earlier phases [bytes]

  explicit ProgressiveProjection(const patient::DensityVolume& volume, const ProgressiveResolution& resolution = {});

  /** @param projection of the patient's volume; shared by any number of sequences */
  explicit ProgressiveProjection(std::shared_ptr<const VolumeProjection> projection,
                                 const ProgressiveResolution& resolution = {});

  const ArealDensityImage& frame(const XRayGeometry& geometry) override;

  void setMotion(const BodyMotion& motion) override;

  /** Frames in motion so far: all, and those that took the change of an earlier phase. @{ */
  std::uint64_t movedFrames() const { return moved_frames_; }
  std::uint64_t reusedFrames() const { return reused_frames_; }
  /** @} */

  /** True if the last frame has the final resolution. */
  bool isFinal() const { return next_row_ >= refined_.samples; }

  int revision() const override { return revision_; }

  /** The lumen contains blood (replaceByBlood()). */
  double lumenDensity() const override { return patient::propertiesOf(patient::Tissue::kBlood).density; }

private:
  void restart(const XRayGeometry& geometry);
  bool updateStill(const XRayGeometry& geometry);
  const std::vector<float>& change(const XRayGeometry& geometry);

  std::shared_ptr<const VolumeProjection> projection_;
  ProgressiveResolution resolution_;
  bool started_ = false;
  CArmPose pose_;
  int next_row_ = 0;  ///< of the refined image
  int revision_ = 0;
  ArealDensityImage refined_;
  ArealDensityImage still_;  ///< patient at rest

  BodyMotion motion_;
  bool motion_is_new_ = false;               ///< since the last frame
  std::optional<MovedTissue> moved_tissue_;  ///< of the heart of the last motion
  ChangeCache changes_{kTolerance, kMemory};
  std::vector<float> change_;  ///< where changes_ does not hold it
  ArealDensityImage image_;    ///< moved patient
  std::uint64_t moved_frames_ = 0, reused_frames_ = 0;
};

}  // namespace endovascular_sim::fluoroscopy
