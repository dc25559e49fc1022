#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rod/model/wire.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::benchmark
{

/** Value computed by a scheme, with its cost. */
struct Measured
{
  double value = 0.0;
  double step_us = 0.0;  ///< median time of a step [µs]
  std::string note;      ///< irregularity of the run; empty: none
};

/** Wire of one section with its number of nodes. */
struct ReferenceRod
{
  double length = 0.1;                ///< length of the wire [m]
  double bending_stiffness = 1e-4;    ///< EI [N·m²]
  double torsional_stiffness = 1e-4;  ///< GJ [N·m²]
  double radius = 1.8e-4;             ///< radius of the wire [m]
  double density = 8000.0;            ///< density of the material [kg/m³]
  double rest_curvature = 0.0;        ///< rest curvature towards the director of the boundary [1/m]
  int nodes = 100;

  double lineDensity() const;  ///< mass per length [kg/m]
};

/** Settings of references with contact: a stiff wall and tight tolerances. */
rod::StepperSettings stiffContactSettings();

/** Stepper with state and input but without a scene, for references with walls, loads and initial shapes that no scene
 * can describe. */
class ReferenceWire
{
public:
  ReferenceWire(const std::string& scheme, const ReferenceRod& rod, const rod::Boundary& boundary,
                const rod::Environment& environment, rod::StepperSettings settings, double inserted_length = 0.0);

  /** Advances one step and measures its time.
   *  @param dt time step [s]
   *  @return false for a rejected step */
  bool step(double dt);

  /** Steps until no node moves by more than @p tolerance [m] in a step.
   *  @param from_rest sets the velocities to zero before every step: a damped Newton iteration on the energy
   *  @return false if this is not reached */
  bool settle(double dt, bool from_rest, double tolerance, int max_steps);

  double stepTime() const;  ///< median time of the steps so far [µs]

  rod::State state;
  rod::StepInput input;
  contact::ContactSource* wall = nullptr;

private:
  std::unique_ptr<rod::Stepper> stepper_;
  PhaseTimer timer_;
  std::vector<double> times_;
};

/** Boundary of a wire along x that is clamped at the origin with @p rod.length free. The clamp of `kkt` and `paper`
 * acts at the centre of an edge, so half an edge is added to @p rod. */
rod::Boundary clampAtOrigin(const std::string& scheme, ReferenceRod& rod);

}  // namespace endovascular_sim::benchmark
