#include "instrument/instrument.h"

#include <algorithm>

namespace endovascular_sim::instrument
{

const char* materialName(Material material)
{
  switch (material)
  {
    case Material::kNitinol:
      return "nitinol";
    case Material::kSteel:
      return "steel";
    case Material::kPlatinum:
      return "platinum";
    case Material::kPolymer:
      return "polymer";
    case Material::kFilledPolymer:
      return "filled_polymer";
  }
  return "";
}

std::optional<PressureLine> pressureLineOf(const Instrument& instrument)
{
  const bool is_open = instrument.kind == Kind::kCatheter && instrument.inner_radius > 0.0;
  return instrument.pressure_line || !is_open ? instrument.pressure_line : PressureLine();
}

std::vector<double> openingsOf(const Instrument& instrument)
{
  std::vector<double> openings = {0.0};
  if (instrument.side_holes)
    for (int k = 0; k < instrument.side_holes->count; ++k)
      openings.push_back(instrument.side_holes->from_tip + k * instrument.side_holes->spacing);
  return openings;
}

double crossingRadius(const Instrument& instrument)
{
  double radius = 0.0;
  for (const rod::Section& section : instrument.wire.sections)
    radius = std::max(radius, section.radius);
  if (instrument.balloon)
    radius = std::max(radius, 0.5 * instrument.balloon->folded_diameter);
  if (instrument.stent)
    radius = std::max(radius, 0.5 * instrument.stent->crimped_diameter);
  return radius;
}

bool fitsInside(const Instrument& inner, const Instrument& outer)
{
  return crossingRadius(inner) < outer.inner_radius;
}

}  // namespace endovascular_sim::instrument
