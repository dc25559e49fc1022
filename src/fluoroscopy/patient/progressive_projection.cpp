#include "fluoroscopy/patient/progressive_projection.h"

#include <algorithm>
#include <utility>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{

ProgressiveProjection::ProgressiveProjection(const patient::DensityVolume& volume,
                                             const ProgressiveResolution& resolution)
  : ProgressiveProjection(std::make_shared<const VolumeProjection>(volume), resolution)
{
}

ProgressiveProjection::ProgressiveProjection(std::shared_ptr<const VolumeProjection> projection,
                                             const ProgressiveResolution& resolution)
  : projection_(std::move(projection)), resolution_(resolution), refined_(emptyImage(resolution.at_rest))
{
  if (resolution.moving < 1 || resolution.moving > 4096 || resolution.rays_per_frame < 1)
    throw InputError("projection of the patient", "resolution",
                     "needs 1 to 4096 rays per side and at least 1 ray per frame");
}

void ProgressiveProjection::restart(const XRayGeometry& geometry)
{
  started_ = true;
  pose_ = geometry.pose();
  next_row_ = resolution_.moving == resolution_.at_rest ? refined_.samples : 0;  // nothing to refine
  image_ = resampled(projection_->project(geometry, resolution_.moving), geometry.pixels());
  ++revision_;
}

const ArealDensityImage& ProgressiveProjection::frame(const XRayGeometry& geometry)
{
  if (!started_ || geometry.pose() != pose_)
  {
    restart(geometry);
    return image_;
  }
  if (isFinal())
    return image_;
  const int rows = std::max(1, resolution_.rays_per_frame / refined_.samples);
  const int end = std::min(next_row_ + rows, refined_.samples);
  projection_->projectRows(geometry, next_row_, end, refined_);
  next_row_ = end;
  if (isFinal())
  {
    image_ = resampled(refined_, geometry.pixels());
    ++revision_;
  }
  return image_;
}

}  // namespace endovascular_sim::fluoroscopy
