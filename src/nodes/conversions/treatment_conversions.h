#pragma once

#include "endovascular_sim/TreatmentVisual.h"
#include "intervention/vessel_dilatation.h"
#include "simulation/imaged_bodies.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Converts balloons, stents and events; the caller sets the header, the step and the time. */
void toMessage(const simulation::Simulation& simulation, TreatmentVisual& message);

/** @throws InputError when axis and radius differ in length or are not finite */
intervention::RoundBody fromMessage(const TreatmentBody& body);

/** Balloons and stents of an image. @throws InputError as fromMessage() */
simulation::ImagedTreatment imagedTreatment(const TreatmentVisual& message);

}  // namespace endovascular_sim::nodes
