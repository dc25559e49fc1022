#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "rod/model/state.h"

namespace endovascular_sim::benchmark
{

/** A clamped wire with loads, as a scene: the free part begins at the origin along x, d1 along y. */
struct BenchWire
{
  std::string scheme = "kkt";
  int nodes = 100;
  double length = 0.1;                                  ///< of the free part [m]
  double radius = 1.8e-4;                               ///< [m]
  double bending_stiffness = 1e-4;                      ///< EI [N·m²]
  double near_stiffness = 1.0;                          ///< EI of the half next to the clamp, of bending_stiffness
  double torsion_ratio = 1.0;                           ///< GJ/EI
  double density = 7900.0;                              ///< [kg/m³]
  double gravity = 0.0;                                 ///< along −y [m/s²]
  double rest_curvature = 0.0;                          ///< of the whole free part, towards d1 [1/m]
  Eigen::Vector3d tip_force = Eigen::Vector3d::Zero();  ///< [N]
  double time_step = 1e-3;                              ///< [s]
  double damping = 0.0;                                 ///< [1/s]
  double strain_tolerance = 1e-7;
  double distal_shift = 0.0;  ///< of a clamped far end towards the near one [m]; 0: the far end is free
};

/** Scene text of a clamped wire. The discrete rods `kkt` and `paper` act as clamped in the middle of the clamped edge,
 *  so half an edge is added before the origin; `mixed` is clamped at its node (docs/PHYSICS.md). */
std::string sceneText(const BenchWire& wire);

/** A wire at rest, and what it took. */
struct RestResult
{
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< [m]
  rod::State state;
  rod::Energy energy;
  double step_us = 0.0;  ///< median time of a step [µs]
  int steps = 0;
  bool settled = false;  ///< false: still moving at the limit of steps, or a step was refused
};

/** Steps until nothing moves by more than @p tolerance [m] in a step. */
RestResult runToRest(const std::string& scene_text, double tolerance, int max_steps);

/** Median time of a step over a stretch of the scene [µs]. */
double medianStepTime(const std::string& scene_text, int steps);

}  // namespace endovascular_sim::benchmark
