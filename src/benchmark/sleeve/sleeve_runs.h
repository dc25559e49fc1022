#pragma once

#include <vector>

namespace endovascular_sim::benchmark
{

/** Insertion of a rod through the introducer towards a pin at a distance of 0.2 m, and its withdrawal. */
struct SleeveMotion
{
  double guide_length = 19e-3;  ///< of the introducer [m]
  int nodes = 241;              ///< of the whole wire of 0.8 m
  double time_step = 1e-3;      ///< [s]
  double speed = 6.7e-3;        ///< of the insertion [m/s]
  /** Inserted lengths over the distance at which the force is recorded, increasing from 1 to 3. */
  std::vector<double> lengths;
};

/** Force on the hand at an inserted length, over EI/L². */
struct SleeveForce
{
  double length = 0.0;           ///< inserted length over L, of the step that reaches the given one
  double force = 0.0;            ///< drag and damping excluded
  double configurational = 0.0;  ///< configurational force of the sleeve, negative: it pushes the rod out [EI/L²]
  double energy = 0.0;           ///< bending energy, over EI/L
};

/** Forces of a run: on the way in, and on the way back in the same order of lengths. */
struct SleeveCurve
{
  std::vector<SleeveForce> in;
  std::vector<SleeveForce> out;
};

/** Runs the `kkt` scheme.
 *  @throws std::runtime_error for a rejected step */
SleeveCurve runSleeve(const SleeveMotion& motion);

}  // namespace endovascular_sim::benchmark
