#include "instrument/stiffness.h"

#include <cmath>

namespace endovascular_sim::instrument
{

double shearModulus(double young_modulus, double poisson_ratio)
{
  return young_modulus / (2.0 * (1.0 + poisson_ratio));
}

Stiffness solidSection(double young_modulus, double shear_modulus, double radius)
{
  const double area = M_PI * radius * radius;
  const double squared = area * radius * radius;  // π r⁴
  return {young_modulus * squared / 4.0, shear_modulus * squared / 2.0, young_modulus * area};
}

Stiffness hollowSection(double young_modulus, double shear_modulus, double radius, double inner_radius)
{
  const Stiffness outer = solidSection(young_modulus, shear_modulus, radius);
  const Stiffness lumen = solidSection(young_modulus, shear_modulus, inner_radius);
  return {outer.bending - lumen.bending, outer.torsional - lumen.torsional, outer.axial - lumen.axial};
}

double equivalentYoungModulus(double bending_stiffness, double radius, double inner_radius)
{
  const double lumen = M_PI * inner_radius * inner_radius * inner_radius * inner_radius;
  return 4.0 * bending_stiffness / (M_PI * radius * radius * radius * radius - lumen);
}

}  // namespace endovascular_sim::instrument
