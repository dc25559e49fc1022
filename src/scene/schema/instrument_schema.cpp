#include <algorithm>
#include <cctype>
#include <cmath>

#include "instrument/stiffness.h"
#include "instrument/tip_shape.h"
#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

constexpr double kFullTurn = 6.284;  // largest angle [rad]; a larger one is probably in degrees

// Words of instrument::Material and instrument::Kind, in the order of the enumerators.
const std::vector<std::string> kMaterials = {"nitinol", "steel", "platinum", "polymer", "filled_polymer"};
const std::vector<std::string> kKinds = {"guidewire", "catheter", "balloon_catheter", "stent"};

/** Reads a radius, or the diameter in its place. Texts of scenes contain the radius. */
void visitRadius(yaml::Fields& fields, const std::string& radius_key, const std::string& diameter_key, double& radius)
{
  if (fields.reading() && fields.has(diameter_key) && fields.has(radius_key))
    fields.reject(diameter_key, "conflicts with " + radius_key + "; keep one of the two");
  const bool by_diameter = fields.has(diameter_key);
  if (fields.reading())
  {
    double diameter = 0.0;
    fields.number(diameter_key, diameter, quantities::kWireDiameter, Range::positive());
    radius = by_diameter ? 0.5 * diameter : radius;
  }
  fields.number(radius_key, radius, quantities::kWireRadius, Range::positive(),
                by_diameter ? Need::kOptional : Need::kRequired);
}

/** Reads EI, GJ and EA. Each is given directly or derived for a hollow cylinder with this lumen. */
void readStiffness(yaml::Fields& fields, rod::Section& section, double inner_radius)
{
  const auto exactly_one = [&fields](const std::vector<std::string>& keys)
  {
    const auto given =
        std::count_if(keys.begin(), keys.end(), [&fields](const std::string& key) { return fields.has(key); });
    std::string words;
    for (const std::string& key : keys)
      words += (words.empty() ? "" : " or ") + key;
    if (given != 1)
      fields.reject(given == 0 ? keys.front() : keys.back(),
                    given == 0 ? "missing; give " + words : "conflicts; keep one of " + words);
  };
  exactly_one({"bending_stiffness", "young_modulus"});
  exactly_one({"torsional_stiffness", "shear_modulus", "poisson_ratio"});

  double young = 0.0;
  fields.number("bending_stiffness", section.bending_stiffness, quantities::kFlexuralRigidity, Range::positive());
  fields.number("young_modulus", young, quantities::kModulus, Range::positive());
  if (fields.has("bending_stiffness"))
    young = instrument::equivalentYoungModulus(section.bending_stiffness, section.radius, inner_radius);
  double poisson = 0.0;
  fields.number("poisson_ratio", poisson, quantities::kPoisson, {-1.0, 0.5, true, false});
  double shear = instrument::shearModulus(young, poisson);
  fields.number("shear_modulus", shear, quantities::kModulus, Range::positive());

  const instrument::Stiffness derived = instrument::hollowSection(young, shear, section.radius, inner_radius);
  if (!fields.has("bending_stiffness"))
    section.bending_stiffness = derived.bending;
  section.torsional_stiffness = derived.torsional;
  section.axial_stiffness = derived.axial;
  fields.number("torsional_stiffness", section.torsional_stiffness, quantities::kFlexuralRigidity, Range::positive());
  fields.number("axial_stiffness", section.axial_stiffness, quantities::kAxialStiffness, Range::positive());
}

void visitRestCurvature(yaml::Fields& fields, rod::Section& section)
{
  const std::string key = "rest_curvature";
  if (!fields.hasMap(key))
    fields.numbers(key, section.rest_curvature.data(), 2, quantities::kWireCurvature);
  else
    fields.map(key,
               [&section](yaml::Fields& arc)
               {
                 double radius = 0.0;
                 double direction = 0.0;
                 arc.number("radius", radius, quantities::kBendRadius, Range::positive(), Need::kRequired);
                 arc.number("direction", direction, quantities::kAngle, Range::between(-kFullTurn, kFullTurn));
                 section.rest_curvature = instrument::arcCurvature(radius, direction);
               });
  if (fields.reading() && section.rest_curvature.norm() * section.radius >= 1.0)
    fields.reject(key, "exceeds the curvature limit of the wire; must be less than 1/radius in 1/m");
}

void visitSection(yaml::Fields& fields, rod::Section& section, instrument::Material& material, double inner_radius)
{
  fields.number("length", section.length, quantities::kSectionLength, Range::positive(), Need::kRequired);
  visitRadius(fields, "radius", "diameter", section.radius);
  if (fields.reading() && section.radius <= inner_radius)
    fields.reject("radius", "is not larger than the lumen; must be greater than inner_radius, " +
                                std::to_string(1e3 * inner_radius) + "e-3 m");
  fields.option("material", material, kMaterials, Need::kRequired);
  fields.number("density", section.density, quantities::kDensity, Range::positive(), Need::kRequired);
  if (fields.reading())
    readStiffness(fields, section, inner_radius);
  else
  {
    fields.number("bending_stiffness", section.bending_stiffness, quantities::kFlexuralRigidity, Range::positive());
    fields.number("torsional_stiffness", section.torsional_stiffness, quantities::kFlexuralRigidity, Range::positive());
    fields.number("axial_stiffness", section.axial_stiffness, quantities::kAxialStiffness, Range::positive());
  }
  visitFriction(fields, section.friction, Need::kOptional);
  visitRestCurvature(fields, section);
}

/** Reads the shape of the tip and converts it to rest curvature of the distal sections. The resolved text contains the
 *  rest curvature only. */
void readTip(yaml::Fields& fields, instrument::Instrument& instrument)
{
  const std::vector<std::string> shapes = {"straight", "angled", "semicircle", "j"};
  int shape = 0;
  fields.choice("shape", shape, shapes, Need::kRequired);
  const bool straight = shape == 0;
  const bool semicircle = shape == 2;
  if (straight || semicircle)
    for (const char* key : {"angle", "radius", "straight", "direction"})
      if (fields.has(key) && (straight || std::string(key) == "angle"))
        fields.reject(key, "does not apply to a " + shapes[static_cast<std::size_t>(shape)] + " tip; remove it");
  if (straight)
    return;
  instrument::TipShape tip;
  tip.angle = M_PI;
  fields.number("radius", tip.radius, quantities::kBendRadius, Range::positive(), Need::kRequired);
  if (!semicircle)
    fields.number("angle", tip.angle, quantities::kAngle, {0.0, 2.0 * M_PI, true, false}, Need::kRequired);
  fields.number("straight", tip.straight, quantities::kTipLeg, Range::nonNegative());
  fields.number("direction", tip.direction, quantities::kAngle, Range::between(-kFullTurn, kFullTurn));
  if (tip.length() > instrument.wire.length())
    fields.reject("", "the tip is longer than the wire: radius·angle + straight = " + std::to_string(tip.length()) +
                          " m, wire " + std::to_string(instrument.wire.length()) + " m; shorten the tip");
  try
  {
    instrument::applyTipShape(instrument, tip);
  }
  catch (const std::invalid_argument& error)
  {
    fields.reject("", std::string(error.what()) + "; give either tip or the sections' rest_curvature");
  }
}

void visitMarkers(yaml::Fields& fields, instrument::Instrument& instrument)
{
  auto& markers = instrument.markers;
  if (!fields.reading() && markers.empty())
    return;
  fields.list(
      "markers", markers.size(), [&markers](std::size_t size) { markers.resize(size); },
      [&](yaml::Fields& ring, std::size_t k)
      {
        instrument::Marker& marker = markers[k];
        ring.number("from_tip", marker.from_tip, quantities::kFromTip, Range::nonNegative(), Need::kRequired);
        ring.number("length", marker.length, quantities::kMarkerLength, Range::positive(), Need::kRequired);
        ring.option("material", marker.material, kMaterials);
        if (ring.reading() && marker.from_tip + marker.length > instrument.wire.length())
          ring.reject("from_tip", "the marker lies beyond the shaft; from_tip + length must be at most its length, " +
                                      std::to_string(instrument.wire.length()) + " m");
      });
}

void visitShaft(yaml::Fields& fields, instrument::Instrument& instrument)
{
  const bool solid = instrument.kind == instrument::Kind::kGuidewire;
  if (!solid)
    visitRadius(fields, "inner_radius", "inner_diameter", instrument.inner_radius);
  for (const char* key : {"inner_radius", "inner_diameter"})
    if (solid && fields.has(key))
      fields.reject(key, "a guidewire has no lumen; remove it, or set kind: catheter");
  auto& wire = instrument.wire;
  fields.list(
      "sections", wire.sections.size(),
      [&](std::size_t size)
      {
        wire.sections.resize(size);
        instrument.materials.resize(size);
      },
      [&](yaml::Fields& section, std::size_t k)
      { visitSection(section, wire.sections[k], instrument.materials[k], instrument.inner_radius); },
      Need::kRequired);
  if (fields.has("tip"))
    fields.map("tip", [&instrument](yaml::Fields& tip) { readTip(tip, instrument); });
  visitMarkers(fields, instrument);
}

/** Schema of the pressure line. The usual one of a catheter is not written, so that texts of scenes stay as they are.
 */
void visitPressureLine(yaml::Fields& fields, instrument::Instrument& instrument)
{
  const instrument::PressureLine usual;
  std::optional<instrument::PressureLine>& line = instrument.pressure_line;
  if (fields.reading() ? !fields.has("pressure_line") : !line.has_value())
    return;
  if (!line)
    line.emplace();
  const bool is_usual = line->from_tip == usual.from_tip && line->natural_frequency == usual.natural_frequency &&
                        line->damping == usual.damping && instrument.kind == instrument::Kind::kCatheter;
  if (!fields.reading() && is_usual)
    return;
  fields.map(
      "pressure_line",
      [&](yaml::Fields& keys)
      {
        keys.number("from_tip", line->from_tip, quantities::kFromTip, Range::nonNegative());
        keys.number("natural_frequency", line->natural_frequency, quantities::kFrequency, {0.5, 1000.0, false, false});
        keys.number("damping", line->damping, quantities::kScale, {0.01, 10.0, false, false});
        if (keys.reading() && line->from_tip >= instrument.wire.length())
          keys.reject("from_tip", "lies beyond the shaft; must be less than its length");
      });
}

/** Schema of the side holes. */
void visitSideHoles(yaml::Fields& fields, instrument::Instrument& instrument)
{
  std::optional<instrument::SideHoles>& holes = instrument.side_holes;
  if (fields.reading() ? !fields.has("side_holes") : !holes.has_value())
    return;
  if (!holes)
    holes.emplace();
  if (fields.reading() && instrument.inner_radius == 0.0)
    fields.reject("side_holes", "a shaft without a lumen has none; remove it");
  fields.map("side_holes",
             [&](yaml::Fields& keys)
             {
               keys.integer("count", holes->count, 1, 100, Need::kRequired);
               keys.number("spacing", holes->spacing, quantities::kFromTip, Range::positive(), Need::kRequired);
               if (keys.reading())
                 holes->from_tip = holes->spacing;
               keys.number("from_tip", holes->from_tip, quantities::kFromTip, Range::positive());
               const double last = holes->from_tip + (holes->count - 1) * holes->spacing;
               if (keys.reading() && last >= instrument.wire.length())
                 keys.reject("count", "the last hole lies beyond the shaft; give fewer, or a smaller spacing");
             });
}

}  // namespace

bool isTopicName(const std::string& name)
{
  return std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return c < 0x80 && (std::isalnum(c) != 0 || c == '_'); });
}

void visitInstrument(yaml::Fields& fields, instrument::Instrument& instrument)
{
  fields.text("name", instrument.name, Need::kRequired);
  if (fields.reading() && !isTopicName(instrument.name))
    fields.reject("name", "names topics; must consist of letters, digits and _, with a letter first");
  fields.option("kind", instrument.kind, kKinds);
  const bool is_stent = instrument.kind == instrument::Kind::kStent;
  const bool is_balloon = instrument.kind == instrument::Kind::kBalloonCatheter;
  if (!is_stent)
  {
    visitShaft(fields, instrument);
    visitPressureLine(fields, instrument);
    visitSideHoles(fields, instrument);
  }
  if (is_balloon)
    visitBalloon(fields, instrument);
  else if (fields.has("balloon"))
    fields.reject("balloon", "does not apply to this kind; remove it, or set kind: balloon_catheter");
  if (is_stent || (is_balloon && (fields.reading() ? fields.has("stent") : instrument.stent.has_value())))
    visitStent(fields, instrument);
  else if (!is_balloon && fields.has("stent"))
    fields.reject("stent", "requires a balloon; set kind: balloon_catheter, or stent");
}

void visitDrivenInstrument(yaml::Fields& fields, instrument::Instrument& instrument)
{
  visitInstrument(fields, instrument);
  if (fields.reading() && instrument.kind == instrument::Kind::kStent)
    fields.reject("kind", "a stent has no shaft to drive; name a balloon_catheter that carries it");
}

}  // namespace endovascular_sim::scene
