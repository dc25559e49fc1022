#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "procedure/observation.h"
#include "results/wall_force_map.h"
#include "scene/model/scene.h"
#include "simulation/contact_forces.h"
#include "simulation/simulation.h"

namespace endovascular_sim::results
{

/** Distance from the foremost tip within which contacts count as contacts of the tip [m]. */
constexpr double kTipReach = 5e-3;

/** Numbers of steps with a fault of the simulator. Their forces do not follow from the trainee's motion alone. */
struct FaultCounts
{
  std::uint32_t rejected_steps = 0;  ///< steps without a solution, in which the wire was held
  std::uint32_t stale_steps = 0;     ///< steps with a stale contact set

  bool any() const { return rejected_steps > 0 || stale_steps > 0; }
};

/** Faults of a single step. */
FaultCounts faultsOf(const rod::StepReport& report);

/** Adds a step to a map of the wall forces. The forces of a step with a fault of the simulator are omitted.
 *  @param dt duration of the step [s] */
void addStep(WallForceMap& map, const simulation::Simulation& simulation,
             const std::vector<simulation::WallContact>& contacts, double dt);

/** Forces of one step on the wall. */
struct WallLoad
{
  double sum = 0.0;      ///< sum of the normal forces [N]
  double largest = 0.0;  ///< largest normal force of one contact [N]
  double at_tip = 0.0;   ///< sum of the normal forces within kTipReach of the foremost tip [N]

  /** Adds a contact.
   *  @param position position of the contact [m]
   *  @param force normal force [N]
   *  @param tip foremost tip [m] */
  void add(const Eigen::Vector3d& position, double force, const Eigen::Vector3d& tip);
};

/** Largest forces of all steps since the previous sample, that of the sample included. Steps with a fault of the
 *  simulator are left out. */
struct Peaks
{
  std::vector<double> hand_force;   ///< axial force of the largest magnitude on each hand, with its sign [N]
  std::vector<double> hand_torque;  ///< torque of the largest magnitude on each hand, with its sign [N·m]
  WallLoad wall;                    ///< each of its values by itself

  /** Takes a step into account. */
  void add(const simulation::Simulation& simulation, const WallLoad& load);
  /** Takes the forces [N] and torques [N·m] on the hands in a step into account. */
  void addHands(const std::vector<double>& forces, const std::vector<double>& torques);
};

/** Sample of a session at one time. */
struct Sample
{
  procedure::Observation observation;
  WallLoad wall;       ///< of the step of the sample
  Peaks peaks;         ///< of all steps since the previous sample
  FaultCounts faults;  ///< faults since the previous sample

  /** True if all values are finite. */
  bool isFinite() const;
};

/** Instrument with the largest insertion. */
int foremostOf(const procedure::Observation& observation);

/** Sampler of a simulation at the first step of every interval of a fixed rate, with faults and peaks of all steps. The
 *  offline tool and the node graph use this class, so that equal trajectories give equal samples. */
class SessionSampler
{
public:
  static constexpr double kRate = 20.0;  ///< sampling rate [Hz]

  /** Index of the sampling interval at @p time [s]. */
  static std::int64_t intervalAt(double time);

  /** Adds a step; to be called after every step.
   *  @param contacts wall contacts of the step
   *  @return true if sample() is the sample of this step */
  bool addStep(const scene::Scene& scene, const simulation::Simulation& simulation,
               const std::vector<simulation::WallContact>& contacts);

  /** Newest sample, without the branches of the tips (procedure::locate()). */
  const Sample& sample() const { return sample_; }

  /** Peaks of the steps since the newest sample. */
  const Peaks& pending() const { return peaks_; }

private:
  std::int64_t interval_ = -1;  ///< interval of the newest sample
  FaultCounts faults_;          ///< faults since the newest sample
  Peaks peaks_;                 ///< peaks since the newest sample
  Sample sample_;
};

}  // namespace endovascular_sim::results
