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

/** Begins anew after a movement.
 *  @return false if nothing has moved */
bool ProgressiveProjection::begin(const XRayGeometry& geometry)
{
  if (started_ && geometry.pose() == pose_)
    return false;
  started_ = true;
  pose_ = geometry.pose();
  next_row_ = 0;
  changes_.clear();
  return true;
}

/** Projects further rows of the final image, and shows it when it has all of them. */
void ProgressiveProjection::refine(const XRayGeometry& geometry, int rows)
{
  const int end = std::min(next_row_ + rows, refined_.samples);
  projection_->projectRows(geometry, next_row_, end, refined_);
  next_row_ = end;
  if (!isComplete())
    return;
  still_ = resampled(refined_, geometry.pixels());
  still_is_new_ = true;
}

void ProgressiveProjection::complete(const XRayGeometry& geometry)
{
  begin(geometry);
  if (!isComplete())
    refine(geometry, refined_.samples);
}

/** Brings the image of the resting patient up to date. */
void ProgressiveProjection::updateStill(const XRayGeometry& geometry)
{
  if (begin(geometry))
  {
    if (resolution_.moving == resolution_.at_rest)  // nothing to refine
      return refine(geometry, refined_.samples);
    still_ = resampled(projection_->project(geometry, resolution_.moving), geometry.pixels());
    still_is_new_ = true;
  }
  else if (!isComplete())
    refine(geometry, std::max(1, resolution_.rays_per_frame / refined_.samples));
}

void ProgressiveProjection::setMotion(const BodyMotion& motion)
{
  if (motion == motion_)
    return;
  motion_ = motion;
  motion_is_new_ = true;
  if (motion.resting() || (moved_tissue_ && sameRegion(moved_tissue_->frame(), motion.map().frame())))
    return;
  moved_tissue_.emplace(*projection_, motion.map().frame());
  changes_.clear();
}

/** Change by the present motion: the one that is known, or a new one. */
const std::vector<float>& ProgressiveProjection::change(const XRayGeometry& geometry)
{
  if (const std::vector<float>* known = changes_.find(motion_))
  {
    ++reused_frames_;
    return *known;
  }
  change_ = moved_tissue_->change(geometry, resolution_.moving, motion_, resolution_.motion);
  if (resolution_.motion == MotionSampling::kFast)  // single images have no other ones to come
    changes_.put(motion_, change_);
  return change_;
}

const ArealDensityImage& ProgressiveProjection::frame(const XRayGeometry& geometry)
{
  updateStill(geometry);
  if (still_is_new_ || motion_is_new_)
  {
    ++revision_;
    still_is_new_ = motion_is_new_ = false;
    if (!motion_.resting())
    {
      ++moved_frames_;
      image_ = still_;
      addResampled(change(geometry), resolution_.moving, geometry.pixels(), image_.tissue);
    }
  }
  return motion_.resting() ? still_ : image_;
}

}  // namespace endovascular_sim::fluoroscopy
