#include "flow/drag/drag.h"

#include <cmath>
#include <stdexcept>

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kSlowest = 1e-6;  // Reynolds number below which the drag is proportional to the speed

/** Drag coefficient times the Reynolds number. */
double dragOf(double reynolds)
{
  const auto lamb = [](double re) { return 8.0 * kPi / (2.002 - std::log(re)); };
  if (reynolds >= 1.0)
    return reynolds + 10.0 * std::cbrt(reynolds);
  return lamb(std::fmax(reynolds, kSlowest)) * 11.0 / lamb(1.0);
}

}  // namespace

double crosswiseDrag(double diameter, double speed, double density, double viscosity)
{
  // ½ρ v² d C_D / v = ½ µ (Re C_D).
  return 0.5 * viscosity * dragOf(density * std::fabs(speed) * diameter / viscosity);
}

double axialDrag(double radius, double lumen, double viscosity)
{
  if (!(radius > 0.0) || !(radius < lumen))
    throw std::invalid_argument("axial drag: the cylinder must be thinner than the lumen");
  const double square = radius * radius, outer = lumen * lumen, logarithm = std::log(lumen / radius);
  // For a pressure gradient of 1: force on the cylinder per length, and mean speed in the annulus.
  const double force = kPi * ((outer - square) / (2.0 * logarithm) - square);
  const double flow =
      kPi / (8.0 * viscosity) * (outer * outer - square * square - (outer - square) * (outer - square) / logarithm);
  return force / (flow / (kPi * (outer - square)));
}

}  // namespace endovascular_sim::flow
