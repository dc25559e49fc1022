#include <algorithm>
#include <limits>

#include "scene/schema/scene_schema.h"

// Schema of a single instrument or of several concentric instruments.

namespace endovascular_sim::scene
{
namespace
{

// Initial insertion of one of several instruments [m]. A negative value keeps the instrument outside the introducer.
const Range kStackInsertion = {-1.0, std::numeric_limits<double>::max(), false, false};

void visitLayer(yaml::Fields& fields, DrivenInstrument& driven)
{
  if (fields.reading() && !fields.has("instrument"))
    fields.reject("instrument", "missing; give a file, e.g. instrument: {use: guidewire_035_j}, or its keys");
  fields.map("instrument", [&driven](yaml::Fields& wire) { visitDrivenInstrument(wire, driven.instrument); });
  fields.map("drive", [&driven](yaml::Fields& drive)
             { visitDrive(drive, driven.drive, kStackInsertion, driven.instrument.balloon.has_value()); });
  fields.number("friction", driven.friction, quantities::kFriction, Range::nonNegative());
  fields.number("fit_load", driven.fit_load, quantities::kFitLoad, Range::nonNegative());
}

std::string number(std::size_t k)
{
  return "instruments." + std::to_string(k);
}

/** Rejects two instruments that are both in the vessel at the start and do not fit into each other. */
void checkFit(const yaml::Fields& fields, const Scene& scene, std::size_t inner, std::size_t outer)
{
  const DrivenInstrument& in = scene.instruments[inner];
  const DrivenInstrument& out = scene.instruments[outer];
  if (in.drive.insertionAt(0.0) < -scene.solver.guide_length ||
      out.drive.insertionAt(0.0) < -scene.solver.guide_length || instrument::fitsInside(in.instrument, out.instrument))
    return;
  fields.reject(
      number(outer) + ".drive.initial_insertion",
      "'" + in.instrument.name + "' does not fit through '" + out.instrument.name +
          "', so only one of the two can be inside; list instruments from the inside out, and start the other "
          "one outside the introducer, e.g. at -0.1");
}

}  // namespace

void visitInstruments(yaml::Fields& fields, Scene& scene)
{
  if (fields.reading() ? !fields.has("instruments") : scene.instruments.size() == 1)
  {
    scene.instruments.resize(1);
    DrivenInstrument& only = scene.instruments.front();
    if (fields.reading() && !fields.has("instrument"))
      fields.reject("instrument", "missing; give a file, e.g. instrument: {use: guidewire_035_j}, or its keys");
    fields.map("instrument", [&only](yaml::Fields& wire) { visitDrivenInstrument(wire, only.instrument); });
    fields.map("drive", [&only](yaml::Fields& drive)
               { visitDrive(drive, only.drive, Range::nonNegative(), only.instrument.balloon.has_value()); });
    return;
  }
  for (const char* key : {"instrument", "drive"})
    if (fields.has(key))
      fields.reject(key,
                    "conflicts with instruments; list all of them there (instruments.N.instrument, counted from 0)");
  fields.list(
      "instruments", scene.instruments.size(), [&scene](std::size_t size) { scene.instruments.resize(size); },
      [&scene](yaml::Fields& layer, std::size_t k) { visitLayer(layer, scene.instruments[k]); });
  if (fields.reading() && scene.instruments.empty())
    fields.reject("instruments", "is empty; list at least one, from the inside out");
}

std::string drivePath(const Scene& scene, std::size_t k)
{
  return scene.instruments.size() == 1 ? "" : number(k) + ".";
}

void checkStack(const yaml::Fields& fields, const Scene& scene)
{
  int devices = 0;
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
  {
    const DrivenInstrument& driven = scene.instruments[k];
    if (driven.drive.source == DriveSource::kNone)
      fields.reject(number(k) + ".drive.source",
                    "missing; each of several instruments needs a drive: script, topic, device or procedure");
    devices += driven.drive.source == DriveSource::kDevice;
    if (devices > 1)
      fields.reject(number(k) + ".drive.source", "is device for a second instrument; a device drives one instrument");
    for (std::size_t inner = 0; inner < k; ++inner)
    {
      if (scene.instruments[inner].instrument.name == driven.instrument.name)
        fields.reject(number(k) + ".instrument.name",
                      "is not unique; give each instrument its own name, which names topics");
      checkFit(fields, scene, inner, k);
    }
  }
  if (!scene.solver.traits().stack)
    fields.reject("solver.scheme", "'" + scene.solver.scheme + "' simulates one instrument; use kkt for several");
  if (std::none_of(scene.instruments.begin(), scene.instruments.end(),
                   [](const DrivenInstrument& driven) { return driven.drive.insertionAt(0.0) >= 0.0; }))
    fields.reject("instruments.0.drive.initial_insertion",
                  "leaves no instrument in the introducer; start one at 0 or more");
  if (scene.entry.valve_friction > 0.0)
    fields.reject("entry.valve_friction",
                  "applies to a single instrument; remove it, or set the friction between the instruments");
  if (!scene.introducer)
    fields.reject("introducer", "is required for several instruments; set introducer: true");
}

}  // namespace endovascular_sim::scene
