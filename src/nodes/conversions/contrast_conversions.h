#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "contrast/cells/contrast_cells.h"
#include "endovascular_sim/ContrastCells.h"
#include "endovascular_sim/ContrastInjection.h"
#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/InjectContrast.h"
#include "scene/model/scene_contrast.h"
#include "simulation/contrast_injections.h"
#include "simulation/fluoroscopy_system.h"
#include "simulation/simulation.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::nodes
{

/** Conversions of contrast medium, bit for bit. The caller sets headers and runs. @{ */
void toMessage(const simulation::ContrastInput& input, ContrastInjection& message);
/** @throws InputError for an injection that no syringe gives */
simulation::ContrastInput fromMessage(const ContrastInjection& message);

/** Injection of a call; volume 0: the present one ends. */
contrast::Injection injectionOf(const InjectContrast::Request& request, const scene::ContrastScene& scene);

/** Text of an input, e.g. "injects 3 ml at 3 ml/s of 350 mgI/ml". */
std::string textOf(const simulation::ContrastInput& input);

/** State after the last step, with step and time.
 *  @pre the scene has contrast medium */
void toMessage(const simulation::Simulation& simulation, ContrastState& message);
/** Iodine in vessel and instruments. @throws InputError for one that is negative or not finite */
simulation::ContrastMedium mediumOf(const ContrastState& message);

/** Places and volumes of the cells.
 *  @param volumes one per cell [m³] */
void toMessage(const contrast::ContrastCells& cells, const std::vector<double>& volumes,
               const vessel::CentrelineTree& centreline, ContrastCells& message);
/** Volumes of the cells [m³]. @throws InputError for one that is not positive, or lists of different lengths */
std::vector<double> volumesOf(const ContrastCells& message);
/** @} */

}  // namespace endovascular_sim::nodes
