#pragma once

#include <vector>

#include "endovascular_sim/TreatmentVisual.h"
#include "fluoroscopy/wire_projection.h"
#include "intervention/vessel_dilatation.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Fills all but the header. */
void toMessage(const simulation::Simulation& simulation, TreatmentVisual& message);

/** @throws InputError when axis and radius do not fit together */
intervention::RoundBody fromMessage(const TreatmentBody& body);

/** What X-rays see of balloons and stents.
 *  @param filling, metal linear attenuation less that of what they displace [1/m]
 *  @throws InputError as fromMessage() */
std::vector<fluoroscopy::XRayWire> toXRayWires(const TreatmentVisual& message, double filling, double metal);

}  // namespace endovascular_sim::nodes
