#pragma once

#include <nlohmann/json_fwd.hpp>

#include "flow/coupling/flow_source.h"
#include "simulation/simulation.h"

namespace endovascular_sim::results
{

/** Contrast medium that a run has used. */
struct ContrastUse
{
  double volume = 0.0;        ///< injected [m³]
  flow::IodineTotals iodine;  ///< [kg]
  int missed = 0;             ///< injections of the scene that found no opening in the vessel
};

/** @pre the scene has the key `contrast` */
ContrastUse contrastUseOf(const simulation::Simulation& simulation);

/** Keys injected_volume [m³], injected_iodine, inside and left [kg], missed_injections. */
nlohmann::ordered_json toJson(const ContrastUse& use);

}  // namespace endovascular_sim::results
