#include "nodes/conversions/flow_conversions.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "common/error.h"
#include "instrument/instrument.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

void requireFinite(std::initializer_list<double> values, const char* topic, const char* key)
{
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    throw InputError(topic, key, "must be finite");
}

void requireFinite(const std::vector<double>& values, const char* topic, const char* key)
{
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    throw InputError(topic, key, "must be finite");
}

/** @return index of a branch */
int branchOf(std::uint32_t branch, std::size_t branches, const char* key)
{
  if (branch >= branches)
    throw InputError(names::kFlowRequest, key, "is on a branch that does not exist");
  return static_cast<int>(branch);
}

flow::LumenProfile fromMessage(const FlowLumen& message, std::size_t branches)
{
  requireFinite(message.arcs, names::kFlowRequest, "lumens.arcs");
  requireFinite(message.areas, names::kFlowRequest, "lumens.areas");
  if (message.arcs.size() != message.areas.size() || !std::is_sorted(message.arcs.begin(), message.arcs.end()) ||
      std::any_of(message.areas.begin(), message.areas.end(), [](double area) { return area < 0.0; }))
    throw InputError(names::kFlowRequest, "lumens", "must have one area of at least 0 for each of its ascending arcs");
  return {branchOf(message.branch, branches, "lumens"), message.arcs, message.areas};
}

flow::InstrumentSpan fromMessage(const FlowSpan& message, std::size_t branches)
{
  requireFinite({message.begin, message.end, message.radius}, names::kFlowRequest, "instruments");
  if (message.radius < 0.0)
    throw InputError(names::kFlowRequest, "instruments", "must have radii of at least 0");
  return {branchOf(message.branch, branches, "instruments"), message.begin, message.end, message.radius};
}

flow::TreePlace fromMessage(const FlowPlace& message, std::size_t branches, const char* key)
{
  requireFinite({message.arc}, names::kFlowRequest, key);
  if (message.branch < 0)
    return {};
  return {branchOf(static_cast<std::uint32_t>(message.branch), branches, key), message.arc};
}

FlowPlace toMessage(const flow::TreePlace& place)
{
  FlowPlace message;
  message.branch = place.branch;
  message.arc = place.arc;
  return message;
}

void toMessage(const flow::FlowInjection& injection, FlowRequest& message)
{
  message.injected_volume = injection.volume;
  message.injected_concentration = injection.concentration;
  message.injected_viscosity = injection.viscosity;
  message.openings.clear();
  message.opening_shares.clear();
  for (const flow::FlowOpening& opening : injection.openings)
  {
    message.openings.push_back(toMessage(opening.place));
    message.opening_shares.push_back(opening.share);
  }
}

flow::FlowInjection injectionOf(const FlowRequest& message, std::size_t branches)
{
  flow::FlowInjection injection{
      message.injected_volume, message.injected_concentration, message.injected_viscosity, {}};
  const std::initializer_list<double> values = {injection.volume, injection.concentration, injection.viscosity};
  requireFinite(values, names::kFlowRequest, "injected_volume, injected_concentration, injected_viscosity");
  requireFinite(message.opening_shares, names::kFlowRequest, "opening_shares");
  if (std::any_of(values.begin(), values.end(), [](double value) { return value < 0.0; }))
    throw InputError(names::kFlowRequest, "injected_volume, injected_concentration, injected_viscosity",
                     "must be at least 0");
  if (message.openings.size() != message.opening_shares.size() ||
      std::any_of(message.opening_shares.begin(), message.opening_shares.end(),
                  [](double share) { return share <= 0.0; }))
    throw InputError(names::kFlowRequest, "opening_shares", "must have one positive share for each opening");
  for (std::size_t k = 0; k < message.openings.size(); ++k)
    injection.openings.push_back({fromMessage(message.openings[k], branches, "openings"), message.opening_shares[k]});
  return injection;
}

flow::FlowControls controlsOf(double heart_rate, double mean_pressure, bool hyperaemia, const char* topic)
{
  const flow::FlowControls controls{heart_rate, mean_pressure, hyperaemia};
  const std::string refusal = flow::refusalOf(controls);
  if (!refusal.empty())
    throw InputError(topic, "", refusal);
  return controls;
}

/** Sets the mean values of a beat in a message that has them. */
template <typename Message>
void setMeans(const flow::BeatMeans& means, Message& message)
{
  message.mean_root_pressure = means.root;
  message.mean_readings = means.readings;
  message.mean_lesion_pressures = means.lesions;
  message.mean_hyperaemia = means.hyperaemia ? 1 : 0;
  message.mean_step = means.step;
}

}  // namespace

void toMessage(const flow::FlowRequest& request, FlowRequest& message)
{
  message.step = request.step;
  message.heart_rate = request.controls.heart_rate;
  message.mean_pressure = request.controls.mean_pressure;
  message.hyperaemia = request.controls.hyperaemia ? 1 : 0;
  message.lumens.resize(request.lumens.size());
  for (std::size_t k = 0; k < request.lumens.size(); ++k)
  {
    message.lumens[k].branch = static_cast<std::uint32_t>(request.lumens[k].branch);
    message.lumens[k].arcs = request.lumens[k].arcs;
    message.lumens[k].areas = request.lumens[k].areas;
  }
  message.instruments.resize(request.instruments.size());
  for (std::size_t k = 0; k < request.instruments.size(); ++k)
  {
    const flow::InstrumentSpan& span = request.instruments[k];
    message.instruments[k].branch = static_cast<std::uint32_t>(span.branch);
    message.instruments[k].begin = span.begin;
    message.instruments[k].end = span.end;
    message.instruments[k].radius = span.radius;
  }
  message.probes.resize(request.probes.size());
  for (std::size_t k = 0; k < request.probes.size(); ++k)
    message.probes[k] = toMessage(request.probes[k]);
  toMessage(request.injection, message);
  message.state.assign(request.state.begin(), request.state.end());
}

void fromMessage(const FlowRequest& message, std::size_t branches, flow::FlowRequest& request)
{
  request.step = message.step;
  request.controls =
      controlsOf(message.heart_rate, message.mean_pressure, message.hyperaemia != 0, names::kFlowRequest);
  request.lumens.clear();
  for (const FlowLumen& lumen : message.lumens)
    request.lumens.push_back(fromMessage(lumen, branches));
  request.instruments.clear();
  for (const FlowSpan& span : message.instruments)
    request.instruments.push_back(fromMessage(span, branches));
  request.probes.clear();
  for (const FlowPlace& place : message.probes)
    request.probes.push_back(fromMessage(place, branches, "probes"));
  request.injection = injectionOf(message, branches);
  request.state.assign(message.state.begin(), message.state.end());
}

void toMessage(const flow::FlowAnswer& answer, FlowAnswer& message)
{
  const flow::FlowField& field = answer.field;
  message.step = answer.step;
  message.phase = field.phase;
  message.beats = field.beats;
  message.ventricle_pressure = field.ventricle;
  message.pressure = field.pressures;
  message.flow = field.flows;
  message.area = field.areas;
  message.probes = field.probes;
  message.readings = field.readings;
  setMeans(field.means, message);
  message.iodine = field.iodine;
  message.iodine_injected = field.totals.injected;
  message.iodine_inside = field.totals.inside;
  message.iodine_left = field.totals.left;
  message.state.assign(answer.state.begin(), answer.state.end());
}

void fromMessage(const FlowAnswer& message, flow::FlowAnswer& answer)
{
  requireFinite({message.phase, message.ventricle_pressure, message.mean_root_pressure}, names::kFlowAnswer,
                "phase, ventricle_pressure, mean_root_pressure");
  requireFinite({message.iodine_injected, message.iodine_inside, message.iodine_left}, names::kFlowAnswer,
                "iodine_injected, iodine_inside, iodine_left");
  for (const auto& values : {&message.pressure, &message.flow, &message.area, &message.probes, &message.readings,
                             &message.mean_readings, &message.mean_lesion_pressures, &message.iodine})
    requireFinite(*values, names::kFlowAnswer, "pressure to mean_lesion_pressures, iodine");
  answer.step = message.step;
  answer.field.phase = message.phase;
  answer.field.beats = message.beats;
  answer.field.ventricle = message.ventricle_pressure;
  answer.field.pressures = message.pressure;
  answer.field.flows = message.flow;
  answer.field.areas = message.area;
  answer.field.probes = message.probes;
  answer.field.readings = message.readings;
  answer.field.means.root = message.mean_root_pressure;
  answer.field.means.readings = message.mean_readings;
  answer.field.means.lesions = message.mean_lesion_pressures;
  answer.field.means.hyperaemia = message.mean_hyperaemia != 0;
  answer.field.means.step = message.mean_step;
  answer.field.iodine = message.iodine;
  answer.field.totals = {message.iodine_injected, message.iodine_inside, message.iodine_left};
  answer.state.assign(message.state.begin(), message.state.end());
}

void toMessage(const flow::FlowControls& controls, HemodynamicControls& message)
{
  message.heart_rate = controls.heart_rate;
  message.mean_pressure = controls.mean_pressure;
  message.hyperaemia = controls.hyperaemia ? 1 : 0;
}

flow::FlowControls fromMessage(const HemodynamicControls& message)
{
  return controlsOf(message.heart_rate, message.mean_pressure, message.hyperaemia != 0, names::kHemodynamicControls);
}

void toMessage(const flow::FlowField& field, const flow::FlowControls& controls, HeartPhase& message)
{
  message.phase = field.phase;
  message.beats = field.beats;
  message.heart_rate = controls.heart_rate;
  message.mean_pressure = controls.mean_pressure;
  message.hyperaemia = controls.hyperaemia ? 1 : 0;
  message.root_pressure = field.pressures.front();
  message.ventricle_pressure = field.ventricle;
  setMeans(field.means, message);
}

void toMessage(const flow::FlowField& field, BloodFlow& message)
{
  message.pressure = field.pressures;
  message.flow = field.flows;
  message.area = field.areas;
}

void toMessage(const flow::VesselFlowTree& network, const vessel::CentrelineTree& centreline,
               const std::vector<vessel::PlacedLesion>& lesions, FlowNetwork& message)
{
  for (std::size_t k = 0; k < network.places.size(); ++k)
  {
    const flow::CellPlace& place = network.places[k];
    const flow::FlowCell& cell = network.tree.cells[k];
    message.branch_name.push_back(centreline.branches.at(static_cast<std::size_t>(place.branch)).name);
    message.branch.push_back(static_cast<std::uint32_t>(place.branch));
    message.begin.push_back(place.begin);
    message.end.push_back(place.end);
    message.from_node.push_back(static_cast<std::uint32_t>(cell.from));
    message.to_node.push_back(static_cast<std::uint32_t>(cell.to));
  }
  for (const vessel::PlacedLesion& lesion : lesions)
    message.lesions.push_back(centreline.branches.at(static_cast<std::size_t>(lesion.branch)).name);
}

std::vector<std::string> pressureLineFrames(const scene::Scene& scene)
{
  std::vector<std::string> frames;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    if (instrument::pressureLineOf(driven.instrument))
      frames.push_back(driven.instrument.name + names::kTipFrameOf);
  return frames;
}

}  // namespace endovascular_sim::nodes
