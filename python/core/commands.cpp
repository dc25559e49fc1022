#include "commands.h"

#include <cmath>
#include <string>

#include "common/error.h"

namespace endovascular_sim::python
{
namespace
{

constexpr pybind11::ssize_t kValues = 3;  // insertion, rotation, pressure

std::string shapeOf(const CommandArray& array)
{
  std::string text;
  for (pybind11::ssize_t k = 0; k < array.ndim(); ++k)
    text += (k > 0 ? ", " : "") + std::to_string(array.shape(k));
  return "[" + text + "]";
}

/** @param leading text of the dimensions before [instrument, 3]
 *  @param fits true for a permitted number of dimensions */
void requireShape(const CommandArray& array, const scene::Scene& scene, const char* leading, bool fits)
{
  const auto instruments = static_cast<pybind11::ssize_t>(scene.instruments.size());
  const pybind11::ssize_t n = array.ndim();
  if (fits && array.shape(n - 1) == kValues && array.shape(n - 2) == instruments)
    return;
  throw InputError("commands", "",
                   "have shape " + shapeOf(array) + "; expected " + leading + std::to_string(instruments) +
                       ", 3]: insertion [m], rotation [rad] and pressure [Pa] of every instrument");
}

void requireValid(const drive::HandCommand& command, const scene::DrivenInstrument& driven, std::size_t step)
{
  const std::string where = "step " + std::to_string(step) + ", instrument '" + driven.instrument.name + "'";
  if (!std::isfinite(command.insertion) || !std::isfinite(command.rotation) || !std::isfinite(command.pressure))
    throw InputError("commands", where, "is not finite; give insertion [m], rotation [rad] and pressure [Pa]");
  if (command.pressure != 0.0 && !driven.instrument.balloon)
    throw InputError("commands", where, "has a pressure, but no balloon; give 0");
}

std::vector<StepCommands> readSteps(const double* values, std::size_t steps, const scene::Scene& scene)
{
  std::vector<StepCommands> commands(steps, StepCommands(scene.instruments.size()));
  for (std::size_t k = 0; k < steps; ++k)
    for (std::size_t i = 0; i < scene.instruments.size(); ++i, values += kValues)
    {
      commands[k][i] = {values[0], values[1], values[2]};
      requireValid(commands[k][i], scene.instruments[i], k);
    }
  return commands;
}

}  // namespace

CommandArray commandArray(const pybind11::object& commands)
{
  CommandArray array = CommandArray::ensure(commands);
  if (!array)
  {
    PyErr_Clear();
    throw InputError("commands", "", "are no array of numbers; give [instrument, 3] or [steps, instrument, 3]");
  }
  return array;
}

std::vector<StepCommands> commandsFrom(const CommandArray& array, const scene::Scene& scene)
{
  requireShape(array, scene, array.ndim() == 3 ? "[steps, " : "[", array.ndim() == 2 || array.ndim() == 3);
  return readSteps(array.data(), array.ndim() == 2 ? 1 : static_cast<std::size_t>(array.shape(0)), scene);
}

std::vector<std::vector<StepCommands>> batchFrom(const CommandArray& array, const scene::Scene& scene)
{
  requireShape(array, scene, "[batch, steps, ", array.ndim() == 4);
  const auto steps = static_cast<std::size_t>(array.shape(1));
  const std::size_t stride = steps * scene.instruments.size() * kValues;
  std::vector<std::vector<StepCommands>> batch;
  for (pybind11::ssize_t k = 0; k < array.shape(0); ++k)
    batch.push_back(readSteps(array.data() + static_cast<std::size_t>(k) * stride, steps, scene));
  return batch;
}

}  // namespace endovascular_sim::python
