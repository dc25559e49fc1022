#pragma once

#include <string>
#include <vector>

#include "rod/model/state.h"

namespace endovascular_sim::benchmark
{

/** One step of a wire that is pushed. */
struct HandSample
{
  double insertion = 0.0;     ///< [m]
  double force = 0.0;         ///< at the hand [N]
  double torque = 0.0;        ///< at the hand [N·m]
  double tip_force = 0.0;     ///< normal force of the wall on the last 5 mm [N]
  rod::HandForceParts parts;  ///< of the force
};

/** Pushes the wire of a scene until its drive has travelled.
 *  @param overrides "key.path=value"
 *  @throws InputError when the scene is refused
 *  @throws std::runtime_error when a step could not be solved */
std::vector<HandSample> pushThrough(const std::string& scene_text, const std::vector<std::string>& overrides = {});

/** Mean of a value between two insertions [m]. */
double meanOf(const std::vector<HandSample>& samples, double HandSample::*value, double from = 0.0, double to = 1e3);

/** Root mean square of the force above a frequency, over the force's mean. What is slower is taken off as a mean with
 *  Gaussian weights, which halves the power at @p frequency; half a second is left out at both ends.
 *  @param time_step of the samples [s]
 *  @param frequency [Hz] */
double noiseOf(const std::vector<HandSample>& samples, double time_step, double frequency = 5.0);

/** A 0.014" wire with graded tip, pushed from a catheter in the ostium of the left coronary artery 80 mm into the
 * generated anatomy's. */
struct CoronaryPush
{
  double speed = 0.035;    ///< [m/s]
  double stiffness = 1.0;  ///< factor on EI of every section
  double shear = 1.0;      ///< factor on GJ of every section, EI kept
  double turn = 0.0;       ///< of the hand, in proportion to the insertion [rad]
  std::string tip;         ///< of the scene's instrument; empty: straight
  double friction = 0.1;
  double travel = 0.08;  ///< [m]
};
std::string sceneText(const CoronaryPush& push);

/** A plain 0.035" wire, 0.3 m, pushed at 35 mm/s.
 *  @param anatomy from the femoral artery to below the aortic bifurcation; false: a channel of 8 mm with two bends in
 *  different planes
 *  @param smoothing Loop subdivisions */
std::string shaftScene(bool anatomy, int nodes, int smoothing, double travel);

}  // namespace endovascular_sim::benchmark
