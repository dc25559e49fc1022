#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "endovascular_sim/BloodFlow.h"
#include "endovascular_sim/FlowAnswer.h"
#include "endovascular_sim/FlowNetwork.h"
#include "endovascular_sim/FlowRequest.h"
#include "endovascular_sim/HeartPhase.h"
#include "endovascular_sim/HemodynamicControls.h"
#include "flow/body/vessel_flow_tree.h"
#include "flow/coupling/flow_source.h"
#include "scene/model/scene.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::nodes
{

/** Conversions of the flow of blood, bit for bit. The caller sets headers, and the numbers of requests. */
void toMessage(const flow::FlowRequest& request, FlowRequest& message);
/** @param branches number of branches of the centreline
 *  @throws InputError for numbers that are not finite or impossible, and for a branch that does not exist */
void fromMessage(const FlowRequest& message, std::size_t branches, flow::FlowRequest& request);
void toMessage(const flow::FlowAnswer& answer, FlowAnswer& message);
/** @throws InputError for a pressure, flow, area or amount of iodine that is not finite */
void fromMessage(const FlowAnswer& message, flow::FlowAnswer& answer);

void toMessage(const flow::FlowControls& controls, HemodynamicControls& message);
/** @throws InputError for values that flow::refusalOf() refuses */
flow::FlowControls fromMessage(const HemodynamicControls& message);

/** State of the heart after a step.
 *  @param controls of the step */
void toMessage(const flow::FlowField& field, const flow::FlowControls& controls, HeartPhase& message);
void toMessage(const flow::FlowField& field, BloodFlow& message);
void toMessage(const flow::VesselFlowTree& network, const vessel::CentrelineTree& centreline,
               const std::vector<vessel::PlacedLesion>& lesions, FlowNetwork& message);

/** Frames of the pressure lines of a scene, in their order: the tips of their instruments. */
std::vector<std::string> pressureLineFrames(const scene::Scene& scene);

}  // namespace endovascular_sim::nodes
