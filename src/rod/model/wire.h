#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::rod
{

/** Part of a wire with constant properties. */
struct Section
{
  double length = 0.0;               ///< [m]
  double bending_stiffness = 0.0;    ///< EI [N·m²]
  double torsional_stiffness = 0.0;  ///< GJ [N·m²]
  double axial_stiffness = 0.0;      ///< EA [N]
  double radius = 0.0;               ///< outer radius [m]
  double density = 0.0;              ///< mass per volume of the solid cylinder of this radius [kg/m³]
  /** Coulomb coefficient against the wall; NaN: the wall's own coefficient. */
  double friction = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector2d rest_curvature = Eigen::Vector2d::Zero();  ///< components in the material frame [1/m]
};

/** Wire, or shaft of a catheter: sections from the proximal end to the tip. */
struct Wire
{
  std::vector<Section> sections;

  /** Sum of the sections' lengths [m]. */
  double length() const;

  /** Length from the first section with rest curvature to the tip [m]; 0 for a straight wire. */
  double curvedTipLength() const;

  /** Outer radius at an arc length from the proximal end [m]. */
  double radiusAt(double position) const;
};

}  // namespace endovascular_sim::rod
