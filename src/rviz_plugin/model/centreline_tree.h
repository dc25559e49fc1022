#pragma once

#include "endovascular_sim/VesselCentreline.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::rviz_plugin
{

/** Centreline tree of a message, with the displayed names of the branches. Invalid branches have no points. */
vessel::CentrelineTree centrelineTree(const VesselCentreline& message);

}  // namespace endovascular_sim::rviz_plugin
