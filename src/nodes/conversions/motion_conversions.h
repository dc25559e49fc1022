#pragma once

#include "endovascular_sim/MotionControls.h"
#include "endovascular_sim/MotionState.h"
#include "motion/map/motion_map.h"
#include "motion/motion_controls.h"
#include "motion/moving_patient.h"

namespace endovascular_sim::nodes
{

/** Conversions of the patient's motion, bit for bit. The caller sets headers, steps and times. @{ */
void toMessage(const motion::MovingPatient& patient, MotionState& message);

/** Map of a message.
 *  @throws InputError for numbers that are not finite, an axis that is no unit vector, or an impossible fade */
motion::MotionMap fromMessage(const MotionState& message);

void toMessage(const motion::MotionControls& controls, MotionControls& message);
/** @throws InputError for values that motion::refusalOf() refuses */
motion::MotionControls fromMessage(const MotionControls& message);
/** @} */

}  // namespace endovascular_sim::nodes
