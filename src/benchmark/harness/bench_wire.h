#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "rod/model/state.h"

namespace endovascular_sim::benchmark
{

/** Clamped wire with loads; the free part starts at the origin along x, with d1 along y. */
struct BenchWire
{
  std::string scheme = "kkt";
  int nodes = 100;
  double length = 0.1;              ///< length of the free part [m]
  double radius = 1.8e-4;           ///< radius of the wire [m]
  double bending_stiffness = 1e-4;  ///< EI [N·m²]
  double near_stiffness = 1.0;      ///< ratio of EI of the half next to the clamp to bending_stiffness
  double torsion_ratio = 1.0;       ///< GJ/EI
  double density = 7900.0;          ///< [kg/m³]
  double gravity = 0.0;             ///< acceleration along −y [m/s²]
  double rest_curvature = 0.0;      ///< curvature of the whole free part, towards d1 [1/m]
  Eigen::Vector3d tip_force = Eigen::Vector3d::Zero();  ///< point load on the tip [N]
  double time_step = 1e-3;                              ///< [s]
  double damping = 0.0;                                 ///< [1/s]
  double strain_tolerance = 1e-7;
  double distal_shift = 0.0;  ///< displacement of a clamped distal end towards the proximal one [m]; 0: free distal end
};

/** Scene text of a clamped wire. The clamp of `kkt` and `paper` acts at the centre of the clamped edge, so half an edge
 * is added before the origin; that of `mixed` acts at the node (docs/PHYSICS.md). */
std::string sceneText(const BenchWire& wire);

/** Wire at rest, with the cost of the run. */
struct RestResult
{
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< [m]
  rod::State state;
  rod::Energy energy;
  double step_us = 0.0;  ///< median time of a step [µs]
  int steps = 0;
  bool settled = false;  ///< false: still moving at the limit of steps, or a step was rejected
};

/** Simulates until no node moves by more than @p tolerance [m] in a step. */
RestResult runToRest(const std::string& scene_text, double tolerance, int max_steps);

/** Median time of a step over the first steps of the scene [µs]. */
double medianStepTime(const std::string& scene_text, int steps);

}  // namespace endovascular_sim::benchmark
