#pragma once

#include <optional>
#include <string>
#include <vector>

namespace endovascular_sim::benchmark
{

/** An instrument that is pushed out of the introducer into a frictionless tube of 8 mm, and withdrawn. */
struct MouthMotion
{
  std::string instrument;           ///< of config/instruments
  int nodes = 0;                    ///< uniform; 0: adaptive
  double speed = 25e-3;             ///< [m/s]
  double travel = 0.06;             ///< [m]
  double bend_curvature = 0.0;      ///< of the tube, 20 mm beyond the mouth, towards the rest curvature [1/m]
  double reference_step = 0.25e-3;  ///< distance between the inserted lengths of the reference [m]
};

/** Force at an inserted length. */
struct MouthForce
{
  double insertion = 0.0;  ///< [m]
  double force = 0.0;      ///< [N]
  bool plane = true;       ///< the wire lies in the plane of its rest curvature
};

/** Inserted lengths at which a way leaves the plane of the rest curvature, and returns to it [m]. */
struct PlaneLeft
{
  double from = 0.0;
  double to = 0.0;
};

/** Forces of a run at every step on the way in and out, and those of MouthReference. */
struct MouthCurves
{
  std::vector<MouthForce> in, out, reference;
};

/** Comparison of a way with the reference, which is interpolated linearly. The reference is plane: forces of a wire
 * that has left the plane are not compared. */
struct MouthDeviation
{
  double largest = 0.0;       ///< deviation of the force [N]
  double at = 0.0;            ///< inserted length of that deviation [m]
  double of_tolerance = 0.0;  ///< largest deviation over 20 mN + 3 % of the reference
  double change = 0.0;        ///< largest change per millisecond in excess of the reference's [N]
};

/** Runs the `kkt` scheme and the reference.
 *  @throws std::runtime_error for a rejected step, or without an equilibrium */
MouthCurves runMouth(const MouthMotion& motion);

/** First part of a way out of the plane; empty: none. */
std::optional<PlaneLeft> planeLeft(const std::vector<MouthForce>& way);

MouthDeviation deviationOf(const std::vector<MouthForce>& way, const std::vector<MouthForce>& reference);

}  // namespace endovascular_sim::benchmark
