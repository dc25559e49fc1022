#include "patient/volume/hounsfield.h"

#include <algorithm>

namespace endovascular_sim::patient
{
namespace
{

constexpr double kAir = 1.21;             // [kg/m³]
constexpr double kFatNumber = -98.0;      // [HU]
constexpr double kOrganNumber = 14.0;     // [HU]
constexpr double kMarrowNumber = 100.0;   // [HU]
constexpr double kCortexNumber = 1524.0;  // [HU]

double softLine(double number)
{
  return 1018.0 + 0.893 * number;
}

double boneLine(double number)
{
  return 1017.0 + 0.592 * number;
}

double interpolate(double x, double x0, double y0, double x1, double y1)
{
  return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

}  // namespace

Density densityFromHounsfield(double number)
{
  if (!(number > -1000.0))
    return {kAir, 0.0};
  if (number < kFatNumber)
    return {interpolate(number, -1000.0, kAir, kFatNumber, softLine(kFatNumber)), 0.0};
  if (number <= kOrganNumber)
    return {softLine(number), 0.0};
  const double marrow = boneLine(kMarrowNumber);
  if (number <= kMarrowNumber)
    return {interpolate(number, kOrganNumber, softLine(kOrganNumber), kMarrowNumber, marrow), 0.0};
  const double fraction = std::min((number - kMarrowNumber) / (kCortexNumber - kMarrowNumber), 1.0);
  return {(1.0 - fraction) * marrow, fraction * boneLine(std::max(number, kCortexNumber))};
}

double hounsfieldOf(const Density& density)
{
  const double total = density.tissue + density.bone;
  const double marrow = boneLine(kMarrowNumber);
  if (total < softLine(kFatNumber))
    return std::max(-1000.0, interpolate(total, kAir, -1000.0, softLine(kFatNumber), kFatNumber));
  if (total <= softLine(kOrganNumber))
    return (total - softLine(0.0)) / (softLine(1.0) - softLine(0.0));
  if (total <= marrow)
    return interpolate(total, softLine(kOrganNumber), kOrganNumber, marrow, kMarrowNumber);
  return (total - boneLine(0.0)) / (boneLine(1.0) - boneLine(0.0));
}

}  // namespace endovascular_sim::patient
