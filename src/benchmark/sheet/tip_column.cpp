#include "benchmark/sheet/tip_column.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr int kSteps = 2000;      // of the Runge-Kutta method over the length
constexpr int kBisections = 60;   // of an unknown
constexpr double kFirst = 0.05;   // lowest tried load over the EI/ℓ² of the tip
constexpr double kGrowth = 1.02;  // between two tried loads

/** Advances y′ = slope(s, y) from 0 to an end with the classical Runge-Kutta method. The stiffness, which jumps between
 *  sections, is that of the middle of a step. */
template <std::size_t size, typename Slope>
std::array<double, size> integrate(std::array<double, size> y, double end, Slope slope)
{
  using State = std::array<double, size>;
  const double h = end / kSteps;
  const auto moved = [](State from, const State& by, double share)
  {
    for (std::size_t i = 0; i < size; ++i)
      from[i] += share * by[i];
    return from;
  };
  for (int k = 0; k < kSteps; ++k)
  {
    const double middle = (k + 0.5) * h;
    const State a = slope(k * h, middle, y);
    const State b = slope(middle, middle, moved(y, a, 0.5 * h));
    const State c = slope(middle, middle, moved(y, b, 0.5 * h));
    const State d = slope((k + 1) * h, middle, moved(y, c, h));
    for (std::size_t i = 0; i < size; ++i)
      y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  return y;
}

/** Deflection of the pinned end of a column under a load [N], by a transverse force of 1 N. */
double columnDeflection(const rod::Wire& wire, double length, double load)
{
  return integrate<2>(
      {0.0, 0.0}, length,
      [&](double s, double middle, const std::array<double, 2>& y) {
        return std::array<double, 2>{y[1], (length - s - load * y[0]) / stiffnessFromTip(wire, length - middle)};
      })[0];
}

/** Cantilever from its tip to its clamp, under a force across it: slope, moment and distance across. The moment grows
 *  with the distance along. */
std::array<double, 3> cantilever(const rod::Wire& wire, double length, double force, double tip_slope)
{
  return integrate<3>(
      {tip_slope, 0.0, 0.0}, length,
      [&](double /*s*/, double middle, const std::array<double, 3>& y) {
        return std::array<double, 3>{-y[1] / stiffnessFromTip(wire, middle), force * std::cos(y[0]), std::sin(y[0])};
      });
}

/** Deflection of the tip under a force [m]: the slope of the tip is that for which the clamp has none. */
double cantileverDeflection(const rod::Wire& wire, double length, double force)
{
  double low = 0.0;
  double high = 0.5 * M_PI;
  for (int k = 0; k < kBisections; ++k)
  {
    const double middle = 0.5 * (low + high);
    (cantilever(wire, length, force, middle)[0] < 0.0 ? low : high) = middle;
  }
  return cantilever(wire, length, force, high)[2];
}

}  // namespace

double stiffnessFromTip(const rod::Wire& wire, double from_tip)
{
  double end = 0.0;
  for (auto section = wire.sections.rbegin(); section != wire.sections.rend(); ++section)
  {
    end += section->length;
    if (from_tip < end)
      return section->bending_stiffness;
  }
  return wire.sections.front().bending_stiffness;
}

double columnLoad(const rod::Wire& wire, double length)
{
  double low = kFirst * stiffnessFromTip(wire, 0.0) / (length * length);
  while (columnDeflection(wire, length, low * kGrowth) > 0.0)
    low *= kGrowth;
  double high = low * kGrowth;
  for (int k = 0; k < kBisections; ++k)
  {
    const double middle = 0.5 * (low + high);
    (columnDeflection(wire, length, middle) > 0.0 ? low : high) = middle;
  }
  return high;
}

double cantileverForce(const rod::Wire& wire, double length, double deflection)
{
  double low = 0.0;
  double high = stiffnessFromTip(wire, 0.0) / (length * length);
  while (cantileverDeflection(wire, length, high) < deflection)
    high *= 2.0;
  for (int k = 0; k < kBisections; ++k)
  {
    const double middle = 0.5 * (low + high);
    (cantileverDeflection(wire, length, middle) < deflection ? low : high) = middle;
  }
  return high;
}

}  // namespace endovascular_sim::benchmark
