#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rod/stepping/stepper.h"

namespace endovascular_sim::benchmark
{

/** Rotation of a wire by some angle and back. */
struct ReversalMotion
{
  double rate = 2.0;        ///< speed of the handle's rotation [rad/s]
  double time_step = 1e-3;  ///< [s]
  double amplitude = 2.0;   ///< angle of the reversal [rad]
  int samples = 40;         ///< samples of either way, at equal angles
};

/** Torque at the hand over the handle's rotation. */
struct ReversalCurve
{
  std::vector<double> angle;   ///< [rad], 0 to the amplitude and back
  std::vector<double> torque;  ///< [N·m]
  double step_us = 0.0;        ///< mean processor time of a step of the second half of the way up [µs]
  double solves = 0.0;         ///< mean number of linear factorisations per step of that part

  /** Torque at the reversal [N·m]. */
  double slidingTorque() const { return torque[torque.size() / 2]; }
};

/** Largest deviation of the way back from a reference with the same samples, relative to its sliding torque [1]. */
double worstDeviation(const ReversalCurve& curve, const ReversalCurve& reference);

/** Wire at rest on a wall with friction, whose handle can be rotated. */
class ReversalCase
{
public:
  virtual ~ReversalCase() = default;

  /** Rotates a copy of the wire at rest. */
  ReversalCurve run(const ReversalMotion& motion);

protected:
  /** @param settings of the solver */
  explicit ReversalCase(rod::StepperSettings settings) : settings_(settings) {}

  virtual std::unique_ptr<rod::Stepper> makeStepper(const rod::StepperSettings& settings) const = 0;
  virtual contact::ContactSource& wall() = 0;
  /** Sets the rotation of the handle that turns [rad]. */
  virtual void turnHandle(rod::StepInput& input, double rotation) const { input.rotation = rotation; }
  /** Torque at the handle that turns [N·m]. */
  virtual double torque(const rod::State& state) const { return state.hand_torque; }
  /** Brings the wire to its place. */
  virtual void prepare(rod::Stepper& stepper, rod::State& state, rod::StepInput& input) = 0;

  /** One step.
   *  @throws std::runtime_error for a rejected step */
  int advance(rod::Stepper& stepper, rod::State& state, rod::StepInput& input, double time_step);

private:
  rod::StepperSettings settings_;
  bool prepared_ = false;
  rod::State rest_;
  rod::StepInput rest_input_;
};

/** Straight wire of 0.035" pushed by 120 mm into the tube of `tube.yaml`: 50 mm straight, 90° of 30 mm radius,
 * straight; friction coefficient 0.1. */
std::unique_ptr<ReversalCase> reversalInBend(const rod::StepperSettings& settings = rod::StepperSettings());

/** Heavy soft wire in a straight trough, friction coefficient 0.2. The wire rolls from one side to the other, over
 *  Δθ = 2 (c/r) atan μ with clearance c and radius r, while the torque changes between ± μ r N. */
std::unique_ptr<ReversalCase> reversalInTrough(const rod::StepperSettings& settings = rod::StepperSettings());

}  // namespace endovascular_sim::benchmark
