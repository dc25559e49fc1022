#pragma once

#include <vector>

#include <pybind11/numpy.h>

#include "simulation/simulation.h"

namespace endovascular_sim::python
{

using CommandArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/** Array of numbers of any object that numpy can convert.
 *  @throws InputError for another object */
CommandArray commandArray(const pybind11::object& commands);

/** Commands of one step, one per instrument. */
using StepCommands = std::vector<drive::HandCommand>;

/** Commands [instrument, 3] or [step, instrument, 3] of a scene, one element per step: insertion [m], rotation [rad],
 *  pressure [Pa].
 *  @throws InputError for another shape, a number that is not finite, or a pressure of an instrument without a balloon
 */
std::vector<StepCommands> commandsFrom(const CommandArray& array, const scene::Scene& scene);

/** Commands [batch, step, instrument, 3], one element per run and step.
 *  @throws InputError as commandsFrom() */
std::vector<std::vector<StepCommands>> batchFrom(const CommandArray& array, const scene::Scene& scene);

}  // namespace endovascular_sim::python
