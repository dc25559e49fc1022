#include "fluoroscopy/angiography/mask.h"

#include <algorithm>

#include "common/fast_math.h"
#include "fluoroscopy/angiography/subtraction.h"

namespace endovascular_sim::fluoroscopy
{

void Mask::add(std::uint64_t pulse, const std::vector<std::uint16_t>& counts, double tube_charge, const CArmPose& pose)
{
  if (taken_ > 0 && (pose != pose_ || pulse != last_pulse_ + 1))
    taken_ = 0;
  last_pulse_ = pulse;
  if (taken_ == 0)
  {
    values_.assign(counts.size(), 0.0F);
    tube_charge_ = tube_charge;
    pose_ = pose;
  }
  for (std::size_t k = 0; k < counts.size(); ++k)
    values_[k] += static_cast<float>(counts[k]);
  if (++taken_ < wanted_)
    return;
  const float share = 1.0F / static_cast<float>(wanted_);
  for (float& value : values_)
    value = fastLog(std::max(share * value, kSmallestCount));
}

std::string motionBetween(const CArmPose& before, const CArmPose& after)
{
  if (before.isocentre != after.isocentre)
    return "the table has moved";
  if (before.primary_angle != after.primary_angle || before.secondary_angle != after.secondary_angle ||
      before.source_to_detector != after.source_to_detector || before.source_to_patient != after.source_to_patient)
    return "the C-arm has moved";
  if (before.detector_width != after.detector_width || before.pixels != after.pixels)
    return "the width of the detector has changed";
  if (before.field_width != after.field_width || before.field_height != after.field_height)
    return "the collimated field has changed";
  return "";
}

}  // namespace endovascular_sim::fluoroscopy
