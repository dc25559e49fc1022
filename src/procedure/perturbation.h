#pragma once

#include <cstdint>
#include <string>

#include "scene/model/scene.h"

namespace endovascular_sim::procedure
{

/** Half widths of the uniform distributions of a perturbation. */
struct Spread
{
  double insertion = 5e-3;  ///< spread of the initial insertions and of the insertions in the steps [m]
  double rotation = 0.5;    ///< spread of the initial rotations [rad]
  double speed = 0.2;       ///< relative spread of the operator's speeds [1]
};

/** Scene with perturbed initial insertions and rotations, steps and speeds, distributed uniformly within ± the spread.
 *  @param seed seed of the random numbers, portable between machines; 0: no perturbation */
scene::Scene perturbed(scene::Scene scene, const Spread& spread, std::uint64_t seed);

/** Scene with a procedure that ends after the last step of a phase.
 *  @throws InputError for an unknown phase, listing the phases of the procedure */
scene::Scene endingWith(scene::Scene scene, const std::string& phase);

}  // namespace endovascular_sim::procedure
