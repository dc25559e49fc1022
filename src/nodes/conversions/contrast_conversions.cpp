#include "nodes/conversions/contrast_conversions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "common/text/format.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kMillilitre = 1e-6;  // [m³]

void requireNotNegative(const std::vector<double>& values, const char* key)
{
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value) && value >= 0.0; }))
    throw InputError(names::kContrastState, key, "must be finite and at least 0");
}

}  // namespace

void toMessage(const simulation::ContrastInput& input, ContrastInjection& message)
{
  message.step = input.step;
  message.volume = input.injection.volume;
  message.rate = input.injection.rate;
  message.rise = input.injection.rise;
  message.concentration = input.injection.concentration;
  message.viscosity = input.injection.viscosity;
  message.refill = input.refill ? 1 : 0;
}

simulation::ContrastInput fromMessage(const ContrastInjection& message)
{
  simulation::ContrastInput input;
  input.step = message.step;
  input.refill = message.refill != 0;
  if (message.volume == 0.0)
    return input;
  input.injection = {message.volume, message.rate, message.rise, message.concentration, message.viscosity};
  // The pump gives what the hand syringe gives, and more.
  if (const std::string refusal = contrast::refusalOf(input.injection, contrast::kPumpSyringe); !refusal.empty())
    throw InputError(names::kContrastInjection, "", refusal);
  return input;
}

contrast::Injection injectionOf(const InjectContrast::Request& request, const scene::ContrastScene& scene)
{
  if (request.volume == 0.0)
    return {};
  return scene.injection(request.volume, request.rate, request.rise, request.concentration);
}

std::string textOf(const simulation::ContrastInput& input)
{
  const contrast::Injection& injection = input.injection;
  if (injection.volume == 0.0)
    return input.refill ? "the syringe is full, nothing is injected"
                        : "the injection ends, the rest stays in the syringe";
  return formatted("injects %g ml at %g ml/s of %g mgI/ml%s", injection.volume / kMillilitre,
                   injection.rate / kMillilitre, injection.concentration, input.refill ? " from a full syringe" : "");
}

void toMessage(const simulation::Simulation& simulation, ContrastState& message)
{
  simulation::ContrastMedium medium = simulation::contrastMedium(simulation);
  const simulation::ContrastInjections& injections = *simulation.contrast();
  message.step = simulation.steps() - 1;
  message.time = simulation.time();
  message.cells = std::move(medium.cells);
  message.instruments = std::move(medium.instruments);
  message.rate = injections.rate();
  message.remaining = injections.injector().left();
  message.syringe = injections.injector().content();
  message.volume = injections.injectedVolume();
  const flow::FlowField* field = simulation.blood()->field();
  const flow::IodineTotals totals = field != nullptr ? field->totals : flow::IodineTotals();
  message.injected = totals.injected;
  message.inside = totals.inside;
  message.left = totals.left;
}

simulation::ContrastMedium mediumOf(const ContrastState& message)
{
  requireNotNegative(message.cells, "cells");
  requireNotNegative(message.instruments, "instruments");
  return {message.cells, message.instruments};
}

void toMessage(const contrast::ContrastCells& cells, const std::vector<double>& volumes,
               const vessel::CentrelineTree& centreline, ContrastCells& message)
{
  message.branch_name.clear();
  message.branch.clear();
  message.begin.clear();
  message.end.clear();
  for (const contrast::ContrastCell& cell : cells)
  {
    message.branch_name.push_back(centreline.branches.at(static_cast<std::size_t>(cell.branch)).name);
    message.branch.push_back(static_cast<std::uint32_t>(cell.branch));
    message.begin.push_back(cell.begin);
    message.end.push_back(cell.end);
  }
  message.volume = volumes;
}

std::vector<double> volumesOf(const ContrastCells& message)
{
  const std::size_t size = message.volume.size();
  if (message.branch.size() != size || message.begin.size() != size || message.end.size() != size)
    throw InputError(names::kContrastCells, "volume", "must have one value for each cell");
  if (!std::all_of(message.volume.begin(), message.volume.end(),
                   [](double volume) { return std::isfinite(volume) && volume > 0.0; }))
    throw InputError(names::kContrastCells, "volume", "must be finite and positive");
  return message.volume;
}

}  // namespace endovascular_sim::nodes
