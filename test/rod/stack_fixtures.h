#pragma once

#include <vector>

#include "rod/coaxial/concentric_stack.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{

/** Wire with a straight shaft and a pre-curved tip. */
inline Wire curvedTipWire(double length, double tip_length, double bending_stiffness, double radius, double curvature)
{
  Wire wire = uniformWire(length - tip_length, bending_stiffness, radius, 6000.0);
  Section tip = uniformWire(tip_length, 0.5 * bending_stiffness, 0.8 * radius, 6000.0).sections[0];
  tip.rest_curvature = Eigen::Vector2d(0.0, curvature);
  wire.sections.push_back(tip);
  return wire;
}

/** Equally spaced nodes from 0 to @p length. */
inline std::vector<double> equalNodes(double length, int nodes)
{
  std::vector<double> position;
  for (int i = 0; i < nodes; ++i)
    position.push_back(length * i / (nodes - 1));
  return position;
}

/** Viscous fluid without weight, in which a wire comes to rest. */
inline Environment calm()
{
  Environment environment;
  environment.fluid_density = 1060.0;
  environment.damping = 20.0;
  return environment;
}

}  // namespace endovascular_sim::rod
