#pragma once

#include <cstdint>
#include <memory>

#include "rod/sampling/adaptive_sampling.h"
#include "rod/stepping/stepper.h"
#include "scene/model/scene.h"
#include "scene/scene_vessel.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::simulation
{

/** Boundary of a scene's wires. The introducer is narrower than the vessel around it. */
rod::Boundary boundaryOf(const scene::Scene& scene, const scene::EntryPose& entry);

/** Steps between two updates of adaptive sampling. */
std::uint64_t samplingInterval(const scene::Scene& scene);

/** Adaptive sampling of a scene; null where it is uniform.
 *  @param centreline of the vessel, null without one */
std::unique_ptr<rod::AdaptiveSampling> makeSampling(const scene::Scene& scene, const scene::EntryPose& entry,
                                                    const vessel::CentrelineTree* centreline);

/** Nodes of the wire at the start of a scene.
 *  @param sampling null: uniform */
rod::Discretisation initialNodes(const scene::Scene& scene, const rod::AdaptiveSampling* sampling);

/** Stepper of a scene's scheme, with the scene's wires, ends, environment and settings. */
std::unique_ptr<rod::Stepper> makeStepper(const scene::Scene& scene, const scene::EntryPose& entry,
                                          rod::Discretisation nodes);

}  // namespace endovascular_sim::simulation
