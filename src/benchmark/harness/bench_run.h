#pragma once

#include <array>
#include <string>
#include <vector>

#include "session/session.h"

namespace endovascular_sim::benchmark
{

/** Statistics over a part of a run. */
struct RunSummary
{
  int steps = 0;
  int rejected = 0;                            ///< rejected steps, in which the wire was held
  int bisections = 0;                          ///< bisections of the time step
  int truncated = 0;                           ///< solves truncated by the trust region
  double solves = 0.0;                         ///< mean number of solves per step
  double mean_us = 0.0;                        ///< mean time of a step [µs]
  double median_us = 0.0;                      ///< median time of a step [µs]
  double p99_us = 0.0;                         ///< 99th percentile of the time of a step [µs]
  std::array<double, kPhaseCount> phase_us{};  ///< median time of every phase [µs]
  double worst_penetration = 0.0;              ///< largest penetration depth of the wire's surface [m]
  int nodes_outside = 0;                       ///< nodes beyond the wall by exact distance, counted every 0.1 s
  double max_strain = 0.0;
  bool finite = true;            ///< no NaN and no diverged position
  double energy_excess = 0.0;    ///< largest excess of elastic and kinetic energy over the applied work [J]
  double largest_energy = 0.0;   ///< largest elastic and kinetic energy [J]
  double mean_hand_force = 0.0;  ///< mean force at the hand [N]
};

/** Offline run of a scene for a study: the loop of `simulate` with the statistics of a study. */
class BenchRun
{
public:
  /** @throws InputError for a rejected scene */
  BenchRun(const std::string& scene_text, const std::vector<std::string>& overrides = {});

  /** Continues the run for a simulated time and measures it.
   *  @param seconds simulated time [s] */
  RunSummary advance(double seconds);

  /** Resets the energy balance after an external change of the state. */
  void resetEnergyBalance();

  simulation::Simulation& simulation() { return session_.simulation(); }
  const scene::Scene& scene() const { return session_.scene(); }
  const contact::Detector* wall() const { return session_.detector(); }  ///< null without a vessel

private:
  void observe(RunSummary& summary);
  void checkEnergy(RunSummary& summary);

  session::Session session_;
  double work_ = 0.0;  ///< work of the hand [J]
  double last_insertion_ = 0.0;
  double last_rotation_ = 0.0;
  double last_mass_ = 0.0;  ///< mass of the simulated part [kg]
  double last_force_ = 0.0;
  double last_torque_ = 0.0;
  double first_energy_ = 0.0;
};

/** Points on the wire beyond the introducer at equal arc lengths from the tip, for comparisons of samplings.
 *  @param spacing arc length between the points [m] */
std::vector<Eigen::Vector3d> centreline(const simulation::Simulation& simulation, double spacing);

/** Distance of the corresponding points of two centrelines, over their common length [m]. */
struct CurveDistance
{
  double rms = 0.0;
  double largest = 0.0;
};
CurveDistance distanceBetween(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b);

}  // namespace endovascular_sim::benchmark
