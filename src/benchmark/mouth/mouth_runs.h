#pragma once

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
};

/** Forces of a run at every step on the way in and out, and those of MouthReference. */
struct MouthCurves
{
  std::vector<MouthForce> in, out, reference;
};

/** Comparison of a way with the reference, which is interpolated linearly. */
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

MouthDeviation deviationOf(const std::vector<MouthForce>& way, const std::vector<MouthForce>& reference);

}  // namespace endovascular_sim::benchmark
