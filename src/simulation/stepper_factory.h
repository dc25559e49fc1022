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

/** Steps between two looks of adaptive sampling at the wire's shape. */
std::uint64_t samplingInterval(const scene::Scene& scene);

/** The scene's adaptive sampling, null where it is uniform.
 *  @param centreline of the vessel, null without one */
std::unique_ptr<rod::AdaptiveSampling> makeSampling(const scene::Scene& scene, const scene::EntryPose& entry,
                                                    const vessel::CentrelineTree* centreline);

/** The scheme that a scene asks for, with the scene's wire, ends, environment and settings.
 *  @param sampling null: uniform
 *  @throws InputError where the scheme cannot do what the scene asks */
std::unique_ptr<rod::Stepper> makeStepper(const scene::Scene& scene, const scene::EntryPose& entry,
                                          const rod::AdaptiveSampling* sampling);

}  // namespace endovascular_sim::simulation
