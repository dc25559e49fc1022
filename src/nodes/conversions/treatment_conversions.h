#pragma once

#include <vector>

#include "endovascular_sim/TreatmentVisual.h"
#include "fluoroscopy/projection/wire_projection.h"
#include "intervention/vessel_dilatation.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Converts balloons, stents and events; the caller sets the header, the step and the time. */
void toMessage(const simulation::Simulation& simulation, TreatmentVisual& message);

/** @throws InputError when axis and radius differ in length or are not finite */
intervention::RoundBody fromMessage(const TreatmentBody& body);

/** X-ray wires of balloons and stents.
 *  @param filling, metal linear attenuation minus that of the displaced material [1/m]
 *  @throws InputError as fromMessage() */
std::vector<fluoroscopy::XRayWire> toXRayWires(const TreatmentVisual& message,
                                               const fluoroscopy::DeviceDensity& filling,
                                               const fluoroscopy::DeviceDensity& metal);

}  // namespace endovascular_sim::nodes
