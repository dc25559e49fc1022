#pragma once

namespace endovascular_sim::instrument
{

/** Stiffness of a cross-section. */
struct Stiffness
{
  double bending = 0.0;    ///< EI [N·m²]
  double torsional = 0.0;  ///< GJ [N·m²]
  double axial = 0.0;      ///< EA [N]
};

/** Shear modulus G = E / (2 (1 + ν)) of an isotropic material [Pa].
 *  @param young_modulus E [Pa]
 *  @param poisson_ratio ν in (−1, 0.5] */
double shearModulus(double young_modulus, double poisson_ratio);

/** Stiffness of a solid circular section: EI = E·π r⁴/4, GJ = G·π r⁴/2, EA = E·π r².
 *  @param young_modulus E [Pa]
 *  @param shear_modulus G [Pa]
 *  @param radius r [m] */
Stiffness solidSection(double young_modulus, double shear_modulus, double radius);

/** Stiffness of an annular section (tube): EI = E·π (r⁴ − i⁴)/4, GJ = G·π (r⁴ − i⁴)/2, EA = E·π (r² − i²).
 *  @param young_modulus E of the wall [Pa]
 *  @param shear_modulus G of the wall [Pa]
 *  @param radius outer radius r [m]
 *  @param inner_radius inner radius i < r [m]; 0 gives a solid section */
Stiffness hollowSection(double young_modulus, double shear_modulus, double radius, double inner_radius);

/** Young's modulus [Pa] of a homogeneous section with the given bending stiffness EI [N·m²].
 *  @param radius outer radius [m]
 *  @param inner_radius inner radius of a tube [m] */
double equivalentYoungModulus(double bending_stiffness, double radius, double inner_radius = 0.0);

}  // namespace endovascular_sim::instrument
