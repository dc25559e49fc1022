#include "instrument/tip_shape.h"

#include <cmath>
#include <stdexcept>

namespace endovascular_sim::instrument
{
namespace
{

// Pieces shorter than this are rounding of lengths that were meant to be equal.
constexpr double kShortestPiece = 1e-9;

/** Cuts the wire at a distance from its tip; returns the index of the first section beyond the cut. */
std::size_t cutFromTip(Instrument& instrument, double distance)
{
  auto& sections = instrument.wire.sections;
  double beyond = 0.0;
  for (std::size_t k = sections.size(); k-- > 0;)
  {
    if (distance - beyond < kShortestPiece)
      return k + 1;
    const double inside = distance - beyond;
    if (inside < sections[k].length - kShortestPiece)
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
  if (shape.length() > instrument.wire.length() + kShortestPiece)
    throw std::invalid_argument("the tip's shape is longer than the wire");
  const std::size_t arc = cutFromTip(instrument, shape.length());
  const std::size_t leg = cutFromTip(instrument, shape.straight);
  for (std::size_t k = arc; k < instrument.wire.sections.size(); ++k)
  {
    rod::Section& section = instrument.wire.sections[k];
    if (!section.rest_curvature.isZero(0.0))
      throw std::invalid_argument("a section under the tip's shape already has rest curvature");
    if (k < leg)
      section.rest_curvature = arcCurvature(shape.radius, shape.direction);
  }
}

}  // namespace endovascular_sim::instrument
