#pragma once

#include <memory>

#include "fluoroscopy/patient/volume_projection.h"
#include "fluoroscopy/projection/patient.h"
#include "patient/tissue/tissue.h"

namespace endovascular_sim::fluoroscopy
{

/** Resolutions of a ProgressiveProjection. */
struct ProgressiveResolution
{
  int moving = 128;           ///< rays per side of the first image after a movement
  int at_rest = 256;          ///< rays per side of the final image
  int rays_per_frame = 8192;  ///< rays of the final image per call: 256² in 8 frames
};

/** Projection of the patient for a sequence of frames: coarse in the frame after a movement of C-arm or table, then
 * refined by a fixed number of rays per frame. The refined image replaces the coarse one as a whole.
 *
 *  The work is counted in rays and reads no clock. The image of a frame depends only on the number of frames since the
 *  last movement, and the image at rest only on geometry and volume. */
class ProgressiveProjection : public Patient
{
public:
  explicit ProgressiveProjection(const patient::DensityVolume& volume, const ProgressiveResolution& resolution = {});

  /** @param projection of the patient's volume; shared by any number of sequences */
  explicit ProgressiveProjection(std::shared_ptr<const VolumeProjection> projection,
                                 const ProgressiveResolution& resolution = {});

  const ArealDensityImage& frame(const XRayGeometry& geometry) override;

  /** True if the last frame has the final resolution. */
  bool isFinal() const { return next_row_ >= refined_.samples; }

  int revision() const override { return revision_; }

  /** The lumen contains blood (replaceByBlood()). */
  double lumenDensity() const override { return patient::propertiesOf(patient::Tissue::kBlood).density; }

private:
  void restart(const XRayGeometry& geometry);

  std::shared_ptr<const VolumeProjection> projection_;
  ProgressiveResolution resolution_;
  bool started_ = false;
  CArmPose pose_;
  int next_row_ = 0;  ///< of the refined image
  int revision_ = 0;
  ArealDensityImage refined_;
  ArealDensityImage image_;
};

}  // namespace endovascular_sim::fluoroscopy
