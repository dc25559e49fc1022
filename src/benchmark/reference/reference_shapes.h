#pragma once

#include "benchmark/reference/reference_wire.h"

namespace endovascular_sim::benchmark
{

/** A clamped wire whose ends are brought together by a tenth of its length. */
struct Buckled
{
  double force = 0.0;       ///< PL²/EI
  double deflection = 0.0;  ///< of the middle, over L
  double step_us = 0.0;     ///< median time of a step [µs]
};
constexpr double kBuckledForce = 41.57025579315579;
constexpr double kBuckledDeflection = 0.19492431137557378;
Buckled buckle(int nodes);

/** Twist at which a ring of EI = GJ loses stability, by the static solver. */
double criticalTwist(int nodes);

/** Largest error of the envelope of a localised helix (van der Heijden & Thompson 2000; Bergou et al. 2008), 27 turns,
 *  L/s* = 24: with φ the angle of the tangent to the axis, (cos φ − cos φ0)/(1 − cos φ0) = tanh²(s/s*). */
struct LocalisedHelix
{
  double envelope_error = 0.0;
  double torque_error = 0.0;  ///< relative
  double step_us = 0.0;       ///< median time of a step [µs]
  bool converged = false;
};

/** By the static solver. */
LocalisedHelix localisedHelix(int nodes);

/** By steps of `kkt` from the same guess. */
LocalisedHelix localisedHelixInSteps(int nodes);

}  // namespace endovascular_sim::benchmark
