#pragma once

#include <string>

#include "results/session_metrics.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Error of a trainee for a person: kind, instrument, and value with its unit. */
std::string textOf(const results::SessionError& error, const scene::Scene& scene);

}  // namespace endovascular_sim::nodes
