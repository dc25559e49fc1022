#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rod/model/wire.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::benchmark
{

/** A value found by a scheme, and what it took. */
struct Measured
{
  double value = 0.0;
  double step_us = 0.0;  ///< median time of a step [µs]
  std::string note;      ///< empty: it went as it should
};

/** A straight wire of one section, and its number of nodes. */
struct ReferenceRod
{
  double length = 0.1;                ///< [m]
  double bending_stiffness = 1e-4;    ///< EI [N·m²]
  double torsional_stiffness = 1e-4;  ///< GJ [N·m²]
  double radius = 1.8e-4;             ///< [m]
  double density = 8000.0;            ///< [kg/m³]
  double rest_curvature = 0.0;        ///< towards the boundary's director [1/m]
  int nodes = 100;

  double lineDensity() const;  ///< [kg/m]
};

/** A scheme's stepper with its state and what drives it, without a scene: for references whose walls, loads and first
 *  shapes no scene describes. */
class ReferenceWire
{
public:
  ReferenceWire(const std::string& scheme, const ReferenceRod& rod, const rod::Boundary& boundary,
                const rod::Environment& environment, rod::StepperSettings settings, double inserted_length = 0.0);

  /** One step, with its time taken.
   *  @return false when it was refused */
  bool step(double dt);

  /** Steps until no node moves by more than @p tolerance [m] in a step.
   *  @param from_rest every step begins at rest: a damped Newton iteration on the energy
   *  @return false when it does not come to that */
  bool settle(double dt, bool from_rest, double tolerance, int max_steps);

  double stepTime() const;  ///< median so far [µs]

  rod::State state;
  rod::StepInput input;
  contact::ContactSource* wall = nullptr;

private:
  std::unique_ptr<rod::Stepper> stepper_;
  PhaseTimer timer_;
  std::vector<double> times_;
};

/** A bench wire along x that is clamped at the origin with @p rod.length free: the discrete rods' clamp acts in the
 *  middle of an edge, so half an edge is added to @p rod before it. */
rod::Boundary clampAtOrigin(const std::string& scheme, ReferenceRod& rod);

}  // namespace endovascular_sim::benchmark
