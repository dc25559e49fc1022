#pragma once

#include <cstdint>
#include <string>

#include "scene/model/scene.h"

namespace endovascular_sim::procedure
{

/** By how much starts differ from the scene's. */
struct Spread
{
  double insertion = 5e-3;  ///< of the instruments at the start, and of the steps' insertions [m]
  double rotation = 0.5;    ///< of the handles at the start [rad]
  double speed = 0.2;       ///< share of all speeds
};

/** The scene with a start, and an operator, that differ a little: evenly distributed within ± the spread.
 *  @param seed the same one gives the same scene everywhere; 0 leaves it as it is */
scene::Scene perturbed(scene::Scene scene, const Spread& spread, std::uint64_t seed);

/** The scene whose procedure ends with the last step of a phase.
 *  @throws InputError when the procedure has no such phase, naming those that it has */
scene::Scene endingWith(scene::Scene scene, const std::string& phase);

}  // namespace endovascular_sim::procedure
