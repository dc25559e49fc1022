#include "nodes/rod_dynamics/control/step_observer.h"

#include <algorithm>

#include "nodes/rod_dynamics/instruments/instrument_observation.h"
#include "nodes/runtime/ros_names.h"
#include "procedure/observation.h"
#include "simulation/instrument_tip.h"

namespace endovascular_sim::nodes
{

StepObserver::StepObserver(const scene::Scene& scene, const vessel::CentrelineTree& tree)
  : scene_(scene), largest_(scene.instruments.size(), 0.0)
{
  if (!tree.branches.empty())
    locator_ = std::make_unique<procedure::BranchLocator>(
        tree, scene.procedure ? scene.procedure->branches : std::vector<scene::NamedBranch>());
}

void StepObserver::begin()
{
  std::fill(largest_.begin(), largest_.end(), 0.0);
}

void StepObserver::addStep(const simulation::Simulation& simulation)
{
  simulation::wallContacts(simulation, contacts_);
  for (const simulation::WallContact& contact : contacts_)
    for (std::size_t k = 0; k < largest_.size(); ++k)
      if (isOn(simulation, k, contact))
        largest_[k] = std::max(largest_[k], contact.normal_force.norm());
}

void StepObserver::report(const simulation::Simulation& simulation, const InstrumentPublisher& instruments,
                          DriveCommands& drives, ros::Time stamp, StepSimulation::Response& response) const
{
  response.step = simulation.steps();
  response.time = simulation.time();
  response.trajectory_hash = simulation.trajectoryHash();
  const std::vector<drive::ControlState> states = drives.states();
  response.instruments.resize(largest_.size());
  for (std::size_t k = 0; k < largest_.size(); ++k)
  {
    InstrumentStatus& status = response.instruments[k];
    status.name = scene_.instruments[k].instrument.name;
    status.measured.header.stamp = stamp;
    status.measured.header.frame_id = names::kIntroducerFrame;
    instruments.measure(simulation, k, status.measured);
    status.tip = tipPose(simulation, k);
    const Eigen::Vector3d tip(status.tip.position.x, status.tip.position.y, status.tip.position.z);
    if (locator_)
      if (const int branch = locator_->at(simulation.atRest(tip)).branch; branch >= 0)
        status.branch = locator_->name(branch);
    status.largest_wall_force = largest_[k];
    status.state = drive::nameOf(states[k].state);
    status.is_busy = states[k].is_busy;
  }
}

}  // namespace endovascular_sim::nodes
