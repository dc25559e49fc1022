#include "benchmark/sheet/roller_elastica.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

/** Half of the wire from the middle, where it is level, with moment and force there: the shape at an arc length. */
struct Shape
{
  double x = 0.0;
  double y = 0.0;
  double slope = 0.0;
  double moment = 0.0;
};

/** Shooting with the classical Runge-Kutta method: EI θ′ = M, M′ = −V cos θ − H sin θ with constant internal forces.
 *  The arc ends where the moment vanishes; the wire's axis must there lie ρ from the support's. */
Shape half(double stiffness, double middle_moment, double vertical, double horizontal)
{
  Shape at;
  at.moment = middle_moment;
  const auto slope = [&](const Shape& s) -> Shape
  {
    return {std::cos(s.slope), std::sin(s.slope), s.moment / stiffness,
            -vertical * std::cos(s.slope) + horizontal * std::sin(s.slope)};
  };
  const auto moved = [](const Shape& s, const Shape& by, double h) -> Shape {
    return {s.x + h * by.x, s.y + h * by.y, s.slope + h * by.slope, s.moment + h * by.moment};
  };
  double h = 2e-5;
  while (h > 1e-13)
  {
    const Shape a = slope(at);
    const Shape b = slope(moved(at, a, 0.5 * h));
    const Shape c = slope(moved(at, b, 0.5 * h));
    const Shape d = slope(moved(at, c, h));
    Shape next = moved(at, a, h / 6.0);
    next = moved(next, b, h / 3.0);
    next = moved(next, c, h / 3.0);
    next = moved(next, d, h / 6.0);
    if (next.moment < 0.0)
      h *= 0.5;  // the end lies within this step
    else
      at = next;
  }
  return at;
}

/** Deflection of a wire whose support carries N at the slope of its end: the horizontal force is N sin θ, the vertical
 *  one N cos θ. Both unknowns of the middle follow by bisection: the slope for a moment, the moment for the span. */
double deflectionByShooting(const ThreePointBend& bend, double vertical)
{
  double low_moment = 0.0;
  double high_moment = vertical * bend.span;
  Shape end;
  for (int i = 0; i < 60; ++i)
  {
    const double moment = 0.5 * (low_moment + high_moment);
    double low = 0.0;
    double high = 1.4;
    for (int k = 0; k < 50; ++k)
    {
      const double slope = 0.5 * (low + high);
      end = half(bend.bending_stiffness, moment, vertical, -vertical * std::tan(slope));
      (end.slope > slope ? low : high) = slope;
    }
    const double span = end.x + bend.reach * std::sin(end.slope);
    (span < 0.5 * bend.span ? low_moment : high_moment) = moment;
  }
  return end.y + bend.reach * (1.0 - std::cos(end.slope));
}

TEST(RollerElastica, AgreesWithShooting)
{
  for (const double reach : {0.0, 6.8e-3})
  {
    const ThreePointBend bend{0.04, 3e-4, reach};
    for (const double deflection : {1e-3, 4e-3})
    {
      const double force = elasticaForce(bend, deflection);
      EXPECT_NEAR(deflectionByShooting(bend, 0.5 * force), deflection, 1e-5 * deflection) << reach;
    }
  }
}

TEST(RollerElastica, BecomesTheBeamAtSmallDeflection)
{
  const ThreePointBend knife{0.04, 3e-4, 0.0};
  EXPECT_NEAR(elasticaForce(knife, 4e-6) / beamForce(knife, 4e-6), 1.0, 1e-6);
  // The contacts move inwards by ρ θ and down by ½ ρ θ², θ = 3 δ/L: the force grows by (18 − 4.5) ρ δ/L² in the first
  // order.
  const ThreePointBend rollers{0.04, 3e-4, 6.8e-3};
  const double deflection = 4e-6;
  EXPECT_NEAR(elasticaForce(rollers, deflection) / beamForce(rollers, deflection) - 1.0,
              13.5 * 6.8e-3 * deflection / (0.04 * 0.04), 2e-6);
}

TEST(RollerElastica, RefusesADeflectionBeyondItsRange)
{
  EXPECT_THROW(elasticaForce({0.04, 3e-4, 0.0}, 0.02), std::invalid_argument);
  EXPECT_THROW(elasticaForce({0.04, 3e-4, 0.0}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
