#include "instrument/tip_shape.h"

#include <cmath>
#include <stdexcept>

namespace endovascular_sim::instrument
{
namespace
{

// Tolerance for rounding errors in lengths that should be equal [m].
constexpr double kLengthTolerance = 1e-9;

/** Splits the section at a distance from the tip.
 *  @return index of the first section distal to the split */
std::size_t splitSection(Instrument& instrument, double distance)
{
  auto& sections = instrument.wire.sections;
  double beyond = 0.0;
  for (std::size_t k = sections.size(); k-- > 0;)
  {
    if (distance - beyond < kLengthTolerance)
      return k + 1;
    const double inside = distance - beyond;
    if (inside < sections[k].length - kLengthTolerance)
    {
      rod::Section distal = sections[k];
      distal.length = inside;
      sections[k].length -= inside;
      const auto at = static_cast<std::ptrdiff_t>(k);
      sections.insert(sections.begin() + at + 1, distal);
      instrument.materials.insert(instrument.materials.begin() + at + 1, instrument.materials[k]);
      return k + 1;
    }
    beyond += sections[k].length;
  }
  return 0;
}

}  // namespace

Eigen::Vector2d arcCurvature(double radius, double direction)
{
  return Eigen::Vector2d(std::sin(direction), -std::cos(direction)) / radius;
}

void applyTipShape(Instrument& instrument, const TipShape& shape)
{
  if (shape.length() > instrument.wire.length() + kLengthTolerance)
    throw std::invalid_argument("the tip shape is longer than the wire");
  const std::size_t arc = splitSection(instrument, shape.length());
  const std::size_t leg = splitSection(instrument, shape.straight);
  for (std::size_t k = arc; k < instrument.wire.sections.size(); ++k)
  {
    rod::Section& section = instrument.wire.sections[k];
    if (!section.rest_curvature.isZero(0.0))
      throw std::invalid_argument("a section within the tip shape already has rest curvature");
    if (k < leg)
      section.rest_curvature = arcCurvature(shape.radius, shape.direction);
  }
}

}  // namespace endovascular_sim::instrument
