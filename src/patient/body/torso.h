#pragma once

#include "patient/solid/solids.h"

namespace endovascular_sim::patient
{

/** Outline of the torso, reduced by @p inset [mm]: superellipses of exponent 2.5 with centres and semi-axes by height.
 */
SolidPointer torsoOutline(float inset);

}  // namespace endovascular_sim::patient
