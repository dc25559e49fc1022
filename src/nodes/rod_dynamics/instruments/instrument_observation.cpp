#include "nodes/rod_dynamics/instruments/instrument_observation.h"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>

#include "nodes/conversions/contact_conversions.h"
#include "simulation/instrument_tip.h"

namespace endovascular_sim::nodes
{
geometry_msgs::Pose tipPose(const simulation::Simulation& simulation, std::size_t instrument)
{
  const double inserted = std::max(0.0, simulation.hand(static_cast<int>(instrument)).insertion);
  const Eigen::Vector3d tip = simulation::pointAt(simulation, inserted);
  const Eigen::Quaterniond turn(simulation::tipFrame(simulation, static_cast<int>(instrument)));
  geometry_msgs::Pose pose;
  pose.position = toPoint(tip);
  pose.orientation.x = turn.x();
  pose.orientation.y = turn.y();
  pose.orientation.z = turn.z();
  pose.orientation.w = turn.w();
  return pose;
}

bool isOn(const simulation::Simulation& simulation, std::size_t instrument, const simulation::WallContact& contact)
{
  const std::vector<double>& arc = simulation.discretisation().position;
  const double inserted = arc[static_cast<std::size_t>(contact.node)] - arc.back() + simulation.state().inserted_length;
  for (auto k = static_cast<int>(instrument) + 1; k < simulation.instruments(); ++k)
    if (simulation.hand(k).insertion >= inserted)
      return false;
  return instrument == 0 || simulation.hand(static_cast<int>(instrument)).insertion >= inserted;
}

}  // namespace endovascular_sim::nodes
