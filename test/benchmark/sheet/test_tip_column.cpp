#include "benchmark/sheet/tip_column.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

rod::Section section(double length, double stiffness)
{
  rod::Section section;
  section.length = length;
  section.bending_stiffness = stiffness;
  return section;
}

TEST(TipColumn, OfAUniformWireIsEulers)
{
  rod::Wire wire;
  wire.sections = {section(0.5, 1.6e-6)};
  // The least root of tan β = β.
  const double beta = 4.4934094579090642;
  EXPECT_NEAR(columnLoad(wire, 0.01), beta * beta * 1.6e-6 / 1e-4, 1e-6);
}

TEST(TipColumn, OfTwoSectionsSolvesTheirCharacteristicEquation)
{
  rod::Wire wire;
  wire.sections = {section(0.5, 4e-6), section(0.004, 1e-6)};
  const double load = columnLoad(wire, 0.01);
  // y = a cos ks + b sin ks + V(ℓ − s)/P in both sections; continuity of y and y′ at the joint, y = 0 at the end.
  const double k1 = std::sqrt(load / 4e-6);
  const double k2 = std::sqrt(load / 1e-6);
  const double joint = 0.006;
  const double length = 0.01;
  // With V/P = 1: y(0) = 0 gives a1 = −ℓ, y′(0) = 0 gives b1 = 1/k1.
  const double y = -length * std::cos(k1 * joint) + std::sin(k1 * joint) / k1;
  const double slope = length * k1 * std::sin(k1 * joint) + std::cos(k1 * joint);
  const double rest = length - joint;
  EXPECT_NEAR((y * std::cos(k2 * rest) + slope * std::sin(k2 * rest) / k2) / length, 0.0, 1e-4);
}

TEST(TipCantilever, IsThatOfBeamTheoryForSmallDeflections)
{
  rod::Wire wire;
  wire.sections = {section(0.5, 1.6e-6)};
  EXPECT_NEAR(cantileverForce(wire, 0.01, 1e-6) / (3.0 * 1.6e-6 * 1e-6 / 1e-6), 1.0, 1e-5);
}

TEST(TipCantilever, HasTheDeflectionOfTheExactElastica)
{
  rod::Wire wire;
  wire.sections = {section(0.5, 1.6e-6)};
  // F ℓ²/EI = 1: y/ℓ = 0.3017207738.
  EXPECT_NEAR(cantileverForce(wire, 0.01, 0.003017207738), 1.6e-6 / 1e-4, 1e-8);
}

TEST(TipCantilever, OfTwoSectionsIsThatOfTheirCompliancesAtSmallDeflection)
{
  rod::Wire wire;
  wire.sections = {section(0.5, 4e-6), section(0.004, 1e-6)};
  const double compliance = (std::pow(0.01, 3) - std::pow(0.004, 3)) / (3.0 * 4e-6) + std::pow(0.004, 3) / (3.0 * 1e-6);
  EXPECT_NEAR(cantileverForce(wire, 0.01, 1e-6) * compliance / 1e-6, 1.0, 1e-5);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
