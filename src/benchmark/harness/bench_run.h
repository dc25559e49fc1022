#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "contact/detector.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::benchmark
{

/** What a stretch of a run did. */
struct RunSummary
{
  int steps = 0;
  int refused = 0;       ///< steps without a solution: the wire was held
  int halved = 0;        ///< bisections of the time step
  int truncated = 0;     ///< solves that the trust region cut short
  double solves = 0.0;   ///< mean per step
  double mean_us = 0.0;  ///< time of a step [µs]
  double median_us = 0.0;
  double p99_us = 0.0;
  std::array<double, kPhaseCount> phase_us{};  ///< median of every phase [µs]
  double worst_penetration = 0.0;              ///< of the wire's surface [m]
  int nodes_outside = 0;                       ///< seen by the exact distance, every tenth of a second
  double max_strain = 0.0;
  bool finite = true;            ///< no NaN and nothing beyond all bounds
  double energy_excess = 0.0;    ///< most that elastic and kinetic energy stood above the work put in [J]
  double largest_energy = 0.0;   ///< [J]
  double mean_hand_force = 0.0;  ///< [N]
};

/** A scene run offline for a study: the loop of `simulate`, with what studies look at. */
class BenchRun
{
public:
  /** @throws InputError when the scene is refused */
  BenchRun(const std::string& scene_text, const std::vector<std::string>& overrides = {});

  /** Runs on for a time of the scene and measures it. */
  RunSummary advance(double seconds);

  /** Begins the energy's account anew, after the state was changed from outside. */
  void forgetEnergy();

  simulation::Simulation& simulation() { return *simulation_; }
  const scene::Scene& scene() const { return scene_; }
  const contact::Detector* wall() const { return wall_.get(); }  ///< null without a vessel

private:
  void observe(RunSummary& summary);
  void checkEnergy(RunSummary& summary);

  scene::Scene scene_;
  std::unique_ptr<contact::Detector> wall_;
  std::unique_ptr<simulation::Simulation> simulation_;
  double work_ = 0.0;  ///< that the hand has put in [J]
  double last_insertion_ = 0.0;
  double last_rotation_ = 0.0;
  double last_mass_ = 0.0;  ///< of the simulated part [kg]
  double last_force_ = 0.0;
  double last_torque_ = 0.0;
  double first_energy_ = 0.0;
};

/** Positions of the wire's nodes beyond the introducer, by arc length from the tip: for comparing samplings.
 *  @param spacing between the places [m] */
std::vector<Eigen::Vector3d> centreline(const simulation::Simulation& simulation, double spacing);

/** Root mean square and largest distance of two centrelines' places, as far as both reach [m]. */
struct CurveDistance
{
  double rms = 0.0;
  double largest = 0.0;
};
CurveDistance distanceBetween(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b);

}  // namespace endovascular_sim::benchmark
