#pragma once

#include <string>
#include <vector>

namespace endovascular_sim::benchmark
{

/** One pushed and turned wire in a bent channel, or in free space where its state is disturbed. */
struct HardCase
{
  std::string label;
  std::string scheme = "kkt";
  double bending_stiffness = 300e-6;  ///< EI of the shaft [N·m²]
  double stiffness_jump = 20.0;       ///< EI of the shaft over that of the tip
  double time_step = 1e-3;            ///< [s]
  double speed = 0.035;               ///< [m/s]
  double turns = 0.5;                 ///< of the handle, over the run
  double bend_radius = 0.03;          ///< of the channel's axis [m]
  double tip_radius = 0.012;          ///< of the J [m]; 0: straight
  int nodes = 150;
  std::string sampling;      ///< YAML that replaces the uniform nodes; empty: uniform
  bool whole = false;        ///< runs until the way and the turns are done, whatever the limit of steps
  bool reverses = false;     ///< pushes, then pulls at once, then pushes
  double disturbance = 0.0;  ///< by which every node is moved once, at random [m]
  double nearly_folded =
      0.0;  ///< angle that is left between two neighbouring edges folded onto each other [rad]; 0: none
};

/** Scene text of the case. The channel's radius is a tenth of the bend's, within 0.8 and 3 mm; the wire's is a third of
 *  it, at most 0.4 mm. */
std::string sceneText(const HardCase& hard);

/** What became of a case. */
struct Verdict
{
  std::string word;    ///< good, refused or bad
  std::string reason;  ///< empty for good
  double max_strain = 0.0;
  double penetration = 0.0;    ///< [m]
  double energy_excess = 0.0;  ///< of the largest energy [1]
  double solves = 0.0;         ///< per step
  int halved = 0;
  int truncated = 0;
  int refused = 0;
  int steps = 0;
  double turned = 0.0;  ///< turns of the handle that were reached
};

/** Nodes times steps: what a run will take, roughly. */
double expectedWork(const HardCase& hard, int max_steps);

/** Runs a case for at most @p max_steps and judges it: no NaN, strain ≤ 1e-3, penetration ≤ 0.1 mm, nothing outside,
 *  no more energy than the work put in. */
Verdict judge(const HardCase& hard, int max_steps);

}  // namespace endovascular_sim::benchmark
