#pragma once

#include <string>

#include "motion/body/motion_settings.h"
#include "motion/map/motion_field.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::motion
{

/** Place of a motion's keys in an input, for messages. */
struct MotionSource
{
  std::string file;    ///< e.g. the scene
  std::string prefix;  ///< of the keys, e.g. "motion.patient."
};

/** Finds the heart in a vessel.
 *
 *  The axis leads from the mean of the ostia to the end of the apex branch. The fade is the largest ball that leaves
 * the fixed branches out, with its centre where the coronary arteries have the largest mean weight. The centre is
 * searched within 0.4 lengths of the axis around their mean, so that the ball is not much larger than the heart.
 *  @throws InputError with key and remedy if the vessel has no branch of a name, or no room for the fade */
HeartFrame placeHeart(const vessel::CentrelineTree& tree, const MotionRegion& region, const MotionSource& source);

}  // namespace endovascular_sim::motion
