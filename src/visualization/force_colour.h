#pragma once

namespace endovascular_sim::visualization
{

/** RGB colour with components in [0, 1]. */
struct Colour
{
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;
};

/** Linear interpolation from @p a (share 0) to @p b (share 1). */
Colour blend(const Colour& a, const Colour& b, float share);

/** Colour of a contact force: steel grey at 0, then yellow, orange to red at @p full_scale and beyond.
 *  @param force magnitude of the force [N]
 *  @param full_scale force that is shown in red [N] */
Colour forceColour(double force, double full_scale);

}  // namespace endovascular_sim::visualization
