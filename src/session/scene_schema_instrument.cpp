#include <algorithm>
#include <cctype>
#include <cmath>

#include "instrument/stiffness.h"
#include "instrument/tip_shape.h"
#include "session/scene_schema.h"

namespace endovascular_sim::session
{
namespace
{

// Numbers of instrument::Material.
const std::vector<std::string> kMaterials = {"nitinol", "steel", "platinum", "polymer"};

/** EI, GJ and EA, each given directly or derived as for a solid cylinder. */
void readStiffness(SceneFields& fields, rod::Section& section)
{
  const auto exactly_one = [&fields](const std::vector<std::string>& keys)
  {
    const auto given =
        std::count_if(keys.begin(), keys.end(), [&fields](const std::string& key) { return fields.has(key); });
    std::string words;
    for (const std::string& key : keys)
      words += (words.empty() ? "" : " or ") + key;
    if (given != 1)
      fields.refuse(given == 0 ? keys.front() : keys.back(),
                    given == 0 ? "missing; give " + words : "given twice over; keep one of " + words);
  };
  exactly_one({"bending_stiffness", "young_modulus"});
  exactly_one({"torsional_stiffness", "shear_modulus", "poisson_ratio"});

  double young = 0.0;
  fields.number("bending_stiffness", section.bending_stiffness, "N·m²", Range::positive());
  fields.number("young_modulus", young, "Pa", Range::positive());
  if (fields.has("bending_stiffness"))
    young = instrument::equivalentYoungModulus(section.bending_stiffness, section.radius);
  double poisson = 0.0;
  fields.number("poisson_ratio", poisson, "1", {-1.0, 0.5, true, false});
  double shear = instrument::shearModulus(young, poisson);
  fields.number("shear_modulus", shear, "Pa", Range::positive());

  const instrument::Stiffness solid = instrument::solidSection(young, shear, section.radius);
  if (!fields.has("bending_stiffness"))
    section.bending_stiffness = solid.bending;
  section.torsional_stiffness = solid.torsional;
  section.axial_stiffness = solid.axial;
  fields.number("torsional_stiffness", section.torsional_stiffness, "N·m²", Range::positive());
  fields.number("axial_stiffness", section.axial_stiffness, "N", Range::positive());
}

void visitRestCurvature(SceneFields& fields, rod::Section& section)
{
  const std::string key = "rest_curvature";
  if (!fields.hasMap(key))
    fields.numbers(key, section.rest_curvature.data(), 2, "1/m");
  else
    fields.map(key,
               [&section](SceneFields& arc)
               {
                 double radius = 0.0;
                 double direction = 0.0;
                 arc.number("radius", radius, "m", Range::positive(), Need::kRequired);
                 arc.number("direction", direction, "rad", Range::any());
                 section.rest_curvature = instrument::arcCurvature(radius, direction);
               });
  if (fields.reading() && section.rest_curvature.norm() * section.radius >= 1.0)
    fields.refuse(key, "bends more tightly than the wire's own radius; must be less than 1/radius in 1/m");
}

void visitSection(SceneFields& fields, rod::Section& section, instrument::Material& material)
{
  fields.number("length", section.length, "m", Range::positive(), Need::kRequired);
  fields.number("radius", section.radius, "m", Range::positive(), Need::kRequired);
  fields.option("material", material, kMaterials, Need::kRequired);
  fields.number("density", section.density, "kg/m³", Range::positive(), Need::kRequired);
  if (fields.reading())
    readStiffness(fields, section);
  else
  {
    fields.number("bending_stiffness", section.bending_stiffness, "N·m²", Range::positive());
    fields.number("torsional_stiffness", section.torsional_stiffness, "N·m²", Range::positive());
    fields.number("axial_stiffness", section.axial_stiffness, "N", Range::positive());
  }
  visitFriction(fields, section.friction, Need::kOptional);
  visitRestCurvature(fields, section);
}

/** The tip's shape exists only in what the user writes: reading turns it into rest curvature of the last sections. */
void readTip(SceneFields& fields, instrument::Instrument& instrument)
{
  const std::vector<std::string> shapes = {"straight", "angled", "semicircle", "j"};
  int shape = 0;
  fields.choice("shape", shape, shapes, Need::kRequired);
  const bool straight = shape == 0;
  const bool semicircle = shape == 2;
  if (straight || semicircle)
    for (const char* key : {"angle", "radius", "straight", "direction"})
      if (fields.has(key) && (straight || std::string(key) == "angle"))
        fields.refuse(key, "a " + shapes[static_cast<std::size_t>(shape)] + " tip has none; remove it");
  if (straight)
    return;
  instrument::TipShape tip;
  tip.angle = M_PI;
  fields.number("radius", tip.radius, "m", Range::positive(), Need::kRequired);
  if (!semicircle)
    fields.number("angle", tip.angle, "rad", {0.0, 2.0 * M_PI, true, false}, Need::kRequired);
  fields.number("straight", tip.straight, "m", Range::nonNegative());
  fields.number("direction", tip.direction, "rad", Range::any());
  if (tip.length() > instrument.wire.length())
    fields.refuse("", "the tip is longer than the wire: radius·angle + straight = " + std::to_string(tip.length()) +
                          " m, wire " + std::to_string(instrument.wire.length()) + " m; shorten the tip");
  try
  {
    instrument::applyTipShape(instrument, tip);
  }
  catch (const std::invalid_argument& error)
  {
    fields.refuse("", std::string(error.what()) + "; give either tip or the sections' rest_curvature");
  }
}

bool isTopicName(const std::string& name)
{
  return std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return c < 0x80 && (std::isalnum(c) != 0 || c == '_'); });
}

}  // namespace

void visitInstrument(SceneFields& fields, instrument::Instrument& instrument)
{
  fields.text("name", instrument.name, Need::kRequired);
  if (fields.reading() && !isTopicName(instrument.name))
    fields.refuse("name", "names topics, so it must be letters, digits and _ with a letter first");
  auto& wire = instrument.wire;
  fields.list(
      "sections", wire.sections.size(),
      [&](std::size_t size)
      {
        wire.sections.resize(size);
        instrument.materials.resize(size);
      },
      [&](SceneFields& section, std::size_t k) { visitSection(section, wire.sections[k], instrument.materials[k]); },
      Need::kRequired);
  if (fields.has("tip"))
    fields.map("tip", [&instrument](SceneFields& tip) { readTip(tip, instrument); });
}

}  // namespace endovascular_sim::session
