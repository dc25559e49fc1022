#pragma once

#include <string>
#include <vector>

#include "rod/model/state.h"

namespace endovascular_sim::benchmark
{

/** Quantities at the hand after one step. */
struct HandSample
{
  double insertion = 0.0;     ///< inserted length [m]
  double force = 0.0;         ///< force at the hand [N]
  double torque = 0.0;        ///< torque at the hand [N·m]
  double tip_force = 0.0;     ///< normal force of the wall on the last 5 mm [N]
  double wall_force = 0.0;    ///< sum of the magnitudes of the wall's normal forces [N]
  double penetration = 0.0;   ///< depth of the surface beyond the wall [m]
  rod::HandForceParts parts;  ///< parts of the force
};

/** Consequence of a rejected step. */
enum class Rejection
{
  kThrows,
  kEnds  ///< the run ends before it
};

/** Simulates a scene until the end of the travel of its drive.
 *  @param overrides "key.path=value"
 *  @throws InputError for a rejected scene
 *  @throws std::runtime_error after a rejected step, with Rejection::kThrows */
std::vector<HandSample> pushThrough(const std::string& scene_text, const std::vector<std::string>& overrides = {},
                                    Rejection rejection = Rejection::kThrows);

/** Mean of a quantity between two inserted lengths [m]. */
double meanOf(const std::vector<HandSample>& samples, double HandSample::*value, double from = 0.0, double to = 1e3);

/** Root mean square of the force above a frequency over the mean force. A Gaussian low-pass filter, which halves the
 * power at @p frequency, is subtracted; half a second is omitted at both ends.
 *  @param time_step time step of the samples [s]
 *  @param frequency cut-off frequency [Hz] */
double noiseOf(const std::vector<HandSample>& samples, double time_step, double frequency = 5.0);

/** Push of a 0.014" wire with graded tip from a catheter in the ostium into the left coronary artery of the generated
 *  anatomy. */
struct CoronaryPush
{
  double speed = 0.035;    ///< speed of the push [m/s]
  double stiffness = 1.0;  ///< factor of EI of every section
  double shear = 1.0;      ///< factor of GJ of every section at constant EI
  double turn = 0.0;       ///< final rotation of the hand, proportional to the insertion [rad]
  std::string tip;         ///< value of instrument.tip; empty: straight
  double friction = 0.1;
  double travel = 0.08;        ///< length of the push [m]
  std::string scheme = "kkt";  ///< value of solver.scheme
  double time_step = 1e-3;     ///< [s]
};

/** Scene text of the push. */
std::string sceneText(const CoronaryPush& push);

/** Scene text of a plain 0.035" wire of 0.3 m pushed at 35 mm/s.
 *  @param anatomy true: from the femoral artery to below the aortic bifurcation of the generated anatomy; false: a
 * channel of 8 mm diameter with two bends in different planes
 *  @param smoothing number of Loop subdivisions
 *  @param travel length of the push [m] */
std::string shaftScene(bool anatomy, int nodes, int smoothing, double travel);

}  // namespace endovascular_sim::benchmark
