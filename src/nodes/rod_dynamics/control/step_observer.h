#pragma once

#include <memory>
#include <vector>

#include "endovascular_sim/StepSimulation.h"
#include "nodes/rod_dynamics/instruments/drive_commands.h"
#include "nodes/rod_dynamics/instruments/instrument_publisher.h"
#include "procedure/branch_locator.h"
#include "scene/model/scene.h"
#include "simulation/contact_forces.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Observation of the steps of one call of simulation/step. */
class StepObserver
{
public:
  /** @param tree centreline of the vessel; empty without one */
  StepObserver(const scene::Scene& scene, const vessel::CentrelineTree& tree);

  /** Begins a call. */
  void begin();

  /** Adds a step of the call. */
  void addStep(const simulation::Simulation& simulation);

  /** Writes the state after the call.
   *  @param stamp of the last step */
  void report(const simulation::Simulation& simulation, const InstrumentPublisher& instruments, DriveCommands& drives,
              ros::Time stamp, StepSimulation::Response& response) const;

private:
  const scene::Scene& scene_;
  std::unique_ptr<procedure::BranchLocator> locator_;  ///< null without a centreline
  std::vector<double> largest_;                        ///< of each instrument: largest contact force of the call [N]
  std::vector<simulation::WallContact> contacts_;
};

}  // namespace endovascular_sim::nodes
