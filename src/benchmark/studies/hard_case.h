#pragma once

#include <string>
#include <vector>

namespace endovascular_sim::benchmark
{

/** Pushed and rotated wire in a bent channel, or a wire in free space with a perturbed state. */
struct HardCase
{
  std::string label;
  std::string scheme = "kkt";
  double bending_stiffness = 300e-6;  ///< EI of the shaft [N·m²]
  double stiffness_jump = 20.0;       ///< ratio of EI of shaft and tip
  double time_step = 1e-3;            ///< time step [s]
  double speed = 0.035;               ///< speed of the push [m/s]
  double turns = 0.5;                 ///< number of turns of the handle over the run
  double bend_radius = 0.03;          ///< radius of curvature of the axis of the channel [m]
  double tip_radius = 0.012;          ///< radius of the J tip [m]; 0: straight
  int nodes = 150;
  std::string sampling;       ///< YAML that replaces the uniform nodes; empty: uniform
  bool whole = false;         ///< completes travel and turns regardless of the limit of steps
  bool reverses = false;      ///< sudden reversals: push, pull, push
  double perturbation = 0.0;  ///< amplitude of one random displacement of every node [m]
  double fold_angle = 0.0;    ///< angle between two adjacent edges folded onto each other [rad]; 0: none
};

/** Scene text of the case. The radius of the channel is a tenth of that of the bend, 0.8 to 3 mm; that of the wire is a
 *  third of it, at most 0.4 mm. */
std::string sceneText(const HardCase& hard);

/** Result of a case. */
struct Verdict
{
  std::string word;    ///< "good", "rejected" or "bad"
  std::string reason;  ///< empty for good
  double max_strain = 0.0;
  double penetration = 0.0;    ///< largest penetration depth [m]
  double energy_excess = 0.0;  ///< energy excess over the largest energy [1]
  double solves = 0.0;         ///< mean number of solves per step
  int bisections = 0;          ///< bisections of the time step
  int truncated = 0;           ///< solves truncated by the trust region
  int rejected = 0;            ///< rejected steps
  int steps = 0;
  double turned = 0.0;  ///< completed turns of the handle
};

/** Estimated cost of a run: nodes times steps. */
double expectedWork(const HardCase& hard, int max_steps);

/** Runs a case for at most @p max_steps and evaluates it. Good: no NaN, strain ≤ 1e-3, penetration ≤ 0.1 mm, no node
 *  outside, no more energy than the applied work. */
Verdict judge(const HardCase& hard, int max_steps);

}  // namespace endovascular_sim::benchmark
