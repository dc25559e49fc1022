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

double equivalentYoungModulus(double bending_stiffness, double radius)
{
  return 4.0 * bending_stiffness / (M_PI * radius * radius * radius * radius);
}

}  // namespace endovascular_sim::instrument
