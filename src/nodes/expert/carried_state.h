#pragma once

#include "endovascular_sim/RodStateVisual.h"
#include "motion/map/motion_map.h"

namespace endovascular_sim::nodes
{

/** Instruments of one patient in the motion of another one: nodes x become φ_to(φ_from⁻¹(x)), so that both patients'
 *  instruments are seen in one moving vessel. Maps of patients at rest leave them bit for bit. */
void carry(const motion::MotionMap& from, const motion::MotionMap& to, RodStateVisual& state);

}  // namespace endovascular_sim::nodes
