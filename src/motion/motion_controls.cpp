#include "motion/motion_controls.h"

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/text/format.h"
#include "motion/body/motion_settings.h"

namespace endovascular_sim::motion
{

void archive(Archive& archive, MotionControls& controls)
{
  archive(controls.heart_rate, controls.breathing_rate, controls.breath_held);
  if (archive.reading())
    requireLoaded(refusalOf(controls).empty(), "holds an impossible heart rate or breathing rate");
}

std::string refusalOf(const MotionControls& controls)
{
  const double heart = controls.heart_rate, breath = controls.breathing_rate;
  if (!(heart >= kLeastHeartRate && heart <= kLargestHeartRate))
    return formatted("heart_rate is %g Hz; must be between %.3g and %.3g Hz", heart, kLeastHeartRate,
                     kLargestHeartRate);
  if (!(breath >= kLeastBreathingRate && breath <= kLargestBreathingRate))
    return formatted("breathing_rate is %g Hz; must be between %.3g and %.3g Hz", breath, kLeastBreathingRate,
                     kLargestBreathingRate);
  return "";
}

}  // namespace endovascular_sim::motion
