#pragma once

#include <string>
#include <vector>

#include "visualization/tube_surface.h"

namespace endovascular_sim::visualization
{

/** Outer shape of an instrument's shaft, by the distance from its tip. */
struct InstrumentShape
{
  std::string name;
  bool is_hollow = false;           ///< true: an instrument can lie in its lumen
  std::vector<double> ends;         ///< distance of each section's proximal end from the tip, increasing [m]
  std::vector<double> outer_radii;  ///< of each section [m]; the last one continues without end

  double radiusAt(double from_tip) const;  ///< 0 without sections [m]
};

/** State of coaxial instruments on one centreline. */
struct WireState
{
  std::vector<Eigen::Vector3d> nodes;  ///< proximal to distal; the last one is the foremost tip [m]
  std::vector<double> radii;           ///< outer radius of the stack at each node [m]
  std::vector<double> forces;          ///< magnitude of the wall's force at each node [N]
  std::vector<double> insertions;      ///< of each instrument, from the inside out [m]
};

/** Drawing of coaxial instruments. */
struct WireStyle
{
  double radius_scale = 1.0;           ///< drawn radius relative to the true one [1]
  double smallest_radius = 0.0;        ///< drawn outer radius is not below; the inner instruments scale with it [m]
  std::vector<Colour> colours;         ///< of the instruments, repeated if there are fewer
  float opacity_over_another = 0.35F;  ///< of an instrument where another one lies in its lumen
  bool shows_forces = true;            ///< true: the outermost surface has the colours of force
  double full_force = 0.1;             ///< force that is drawn red [N]
};

/** Reason why a state cannot be drawn; null for a valid one.
 *  @param shapes of the instruments; may be empty: one tube with the outer radius */
const char* problemOfWire(const WireState& state, const std::vector<InstrumentShape>& shapes);

/** Axes of the tubes that draw coaxial instruments, one per instrument, from the inside out: opaque ones first, so that
 * a catheter is drawn over its wire.
 *
 *  An instrument begins at the first node and ends at its tip, which an interpolated point represents. Its radius is
 *  that of its shape; the outermost one has the radius of the state, if it is larger (folded balloon, stent).
 *  @param state valid (problemOfWire())
 *  @param axes receives the axes; keeps its capacity */
void instrumentAxes(const WireState& state, const std::vector<InstrumentShape>& shapes, const WireStyle& style,
                    std::vector<TubeAxis>& axes);

/** Colour of the outermost surface: that of its instrument without force, then the colours of forceColour(). */
Colour forceColourOver(const Colour& base, double force, double full_force);

}  // namespace endovascular_sim::visualization
