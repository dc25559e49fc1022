#pragma once

#include <string>

#include "endovascular_sim/SessionInfo.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Identity of a recording of a scene by this program, without the vessel. It holds no folder of this machine.
 *  @param subject pseudonym of the trainee, or another short text */
SessionInfo infoOf(const scene::Scene& scene, const std::string& subject);

}  // namespace endovascular_sim::nodes
