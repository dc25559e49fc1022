#include "benchmark/sheet/specimen.h"

#include <algorithm>
#include <cmath>

#include "common/text/format.h"

namespace endovascular_sim::benchmark
{
namespace
{

/** Text of one section with another length. */
std::string sectionText(const rod::Section& section, instrument::Material material, double length)
{
  std::string text = formatted(
      "{length: %.17g, radius: %.17g, material: %s, density: %.17g, bending_stiffness: %.17g, torsional_stiffness: "
      "%.17g, axial_stiffness: %.17g",
      length, section.radius, instrument::materialName(material), section.density, section.bending_stiffness,
      section.torsional_stiffness, section.axial_stiffness);
  if (!std::isnan(section.friction))
    text += formatted(", friction: %.17g", section.friction);
  return text + "}";
}

std::string instrumentText(const instrument::Instrument& instrument, const std::string& name,
                           const std::string& sections)
{
  const bool hollow = instrument.inner_radius > 0.0;
  return "{name: " + name +
         (hollow ? formatted(", kind: catheter, inner_radius: %.17g", instrument.inner_radius) : "") + ", sections: [" +
         sections + "]}";
}

/** Index of the section at a distance from the tip. */
std::size_t indexFromTip(const rod::Wire& wire, double from_tip)
{
  double end = 0.0;
  for (std::size_t k = wire.sections.size(); k-- > 1;)
  {
    end += wire.sections[k].length;
    if (from_tip < end)
      return k;
  }
  return 0;
}

}  // namespace

const rod::Section& sectionFromTip(const rod::Wire& wire, double from_tip)
{
  return wire.sections[indexFromTip(wire, from_tip)];
}

double middleOfShaft(const rod::Wire& wire)
{
  const auto longest =
      std::max_element(wire.sections.begin(), wire.sections.end(),
                       [](const rod::Section& a, const rod::Section& b) { return a.length < b.length; });
  double from_tip = 0.5 * longest->length;
  for (auto section = longest + 1; section != wire.sections.end(); ++section)
    from_tip += section->length;
  return from_tip;
}

std::string shaftSpecimen(const instrument::Instrument& instrument, const std::string& name, double from_tip,
                          double length)
{
  const std::size_t k = indexFromTip(instrument.wire, from_tip);
  return instrumentText(instrument, name, sectionText(instrument.wire.sections[k], instrument.materials[k], length));
}

std::string tipSpecimen(const instrument::Instrument& instrument, const std::string& name, double length)
{
  std::string sections;
  double left = length;
  for (std::size_t k = instrument.wire.sections.size(); k-- > 0 && left > 0.0;)
  {
    const double own = k == 0 ? left : std::min(left, instrument.wire.sections[k].length);
    sections = sectionText(instrument.wire.sections[k], instrument.materials[k], own) +
               (sections.empty() ? "" : ", " + sections);
    left -= own;
  }
  return instrumentText(instrument, name, sections);
}

}  // namespace endovascular_sim::benchmark
