#pragma once

#include <ros/node_handle.h>

#include "haptics/host/haptic_link.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Instrument that the haptic device drives; the first instrument when the scene names none. */
const scene::DrivenInstrument& deviceInstrument(const scene::Scene& scene);

/** Options of the serial link: types, start position, and the private parameters of docs/HAPTIC_DEVICE.md.
 *  @throws InputError when a parameter is invalid */
haptics::LinkOptions linkOptions(const ros::NodeHandle& parameters, const scene::Scene& scene);

}  // namespace endovascular_sim::nodes
