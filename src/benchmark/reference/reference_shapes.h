#pragma once

#include "benchmark/reference/reference_wire.h"

namespace endovascular_sim::benchmark
{

/** Post-buckling state of a clamped wire shortened by a tenth of its length. */
struct Buckled
{
  double force = 0.0;       ///< axial force, PL²/EI
  double deflection = 0.0;  ///< deflection of the centre over L
  double step_us = 0.0;     ///< median time of a step [µs]
};
constexpr double kBuckledForce = 41.57025579315579;         ///< exact Buckled::force
constexpr double kBuckledDeflection = 0.19492431137557378;  ///< exact Buckled::deflection

/** Buckles the wire in steps of `kkt`. */
Buckled buckle(int nodes);

/** Critical twist of a ring with EI = GJ, by the static solver [rad]. */
double criticalTwist(int nodes);

/** Errors of a localised helix of 27 turns, L/s* = 24 (van der Heijden & Thompson 2000; Bergou et al. 2008). With φ the
 *  angle between tangent and axis, the exact envelope is (cos φ − cos φ0)/(1 − cos φ0) = tanh²(s/s*). */
struct LocalisedHelix
{
  double envelope_error = 0.0;  ///< largest error of the envelope
  double torque_error = 0.0;    ///< relative error of the torque
  double step_us = 0.0;         ///< median time of a step [µs]
  bool converged = false;
};

/** Localised helix by the static solver. */
LocalisedHelix localisedHelix(int nodes);

/** Localised helix by steps of `kkt` from the same initial guess. */
LocalisedHelix localisedHelixInSteps(int nodes);

}  // namespace endovascular_sim::benchmark
