#pragma once

namespace endovascular_sim::flow
{

/** Drag per length and speed of a long cylinder across a stream [N·s/m²]: force per length = value · relative speed.
 *  Drag coefficient 1 + 10 Re^(−2/3) for Re ≥ 1 (White 2011, eq. 7.62 of the 7th edition), below that Lamb's
 *  8π/(Re (2.002 − ln Re)), scaled so that both meet at Re = 1.
 *  @param diameter [m]
 *  @param speed relative speed across the axis [m/s]; its sign has no effect
 *  @param density, viscosity of the fluid [kg/m³], [Pa·s] */
double crosswiseDrag(double diameter, double speed, double density, double viscosity);

/** Drag per length and speed along the axis of a cylinder in a tube [N·s/m²]: force per length = value · mean speed of
 *  the fluid in the annulus, for a concentric cylinder at rest in laminar flow (Bird, Stewart & Lightfoot 2002, §2.4).
 *  @param radius of the cylinder [m]
 *  @param lumen radius of the tube [m]
 *  @throws std::invalid_argument unless 0 < radius < lumen */
double axialDrag(double radius, double lumen, double viscosity);

}  // namespace endovascular_sim::flow
