#include "benchmark/sheet/roller_elastica.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr int kPanels = 2000;               // of Simpson's rule; even
constexpr int kBisections = 100;            // of the slope at the support
constexpr double kSteepest = 1.2;           // rad, slope at the support; the force has passed its maximum there
constexpr double kLargestDeflection = 0.3;  // over the span

/** Half of the wire at a slope of its contact with the support. */
struct HalfWire
{
  double load = 0.0;        ///< N, force of the support [N]
  double deflection = 0.0;  ///< of the middle [m]
};

/** Lengths of the half wire along and across the span, over √(EI/(2N)): ∫ (cos θ, sin θ)/√sin(θ_s − θ) dθ. With
 *  θ = θ_s − u² the integrand is smooth. */
void lengths(double slope, double& along, double& across)
{
  const double end = std::sqrt(slope);
  const double step = end / kPanels;
  along = across = 0.0;
  for (int k = 0; k <= kPanels; ++k)
  {
    const double u = k * step;
    const double root = u > 0.0 ? std::sqrt(std::sin(u * u)) : 1.0;
    const double density = u > 0.0 ? 2.0 * u / root : 2.0;
    const double weight = (k == 0 || k == kPanels ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) * step / 3.0;
    along += weight * density * std::cos(slope - u * u);
    across += weight * density * std::sin(slope - u * u);
  }
}

HalfWire halfWireAt(const ThreePointBend& bend, double slope)
{
  double along = 0.0;
  double across = 0.0;
  lengths(slope, along, across);
  const double half = 0.5 * bend.span - bend.reach * std::sin(slope);
  const double scale = half / along;  // √(EI/(2N))
  return {0.5 * bend.bending_stiffness / (scale * scale), scale * across + bend.reach * (1.0 - std::cos(slope))};
}

}  // namespace

double beamForce(const ThreePointBend& bend, double deflection)
{
  return 48.0 * bend.bending_stiffness * deflection / (bend.span * bend.span * bend.span);
}

double elasticaForce(const ThreePointBend& bend, double deflection)
{
  if (deflection <= 0.0 || deflection > kLargestDeflection * bend.span)
    throw std::invalid_argument("elasticaForce: requires a deflection of 0 to 0.3 L, not " +
                                std::to_string(deflection / bend.span) + " L");
  double low = 0.0;
  double high = kSteepest;
  for (int k = 0; k < kBisections; ++k)
  {
    const double middle = 0.5 * (low + high);
    (halfWireAt(bend, middle).deflection < deflection ? low : high) = middle;
  }
  return 2.0 * halfWireAt(bend, high).load * std::cos(high);
}

}  // namespace endovascular_sim::benchmark
