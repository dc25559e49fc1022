#pragma once

#include <cstddef>

#include <geometry_msgs/Pose.h>

#include "simulation/contact_forces.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Tip of an instrument in the patient frame, with its material frame (simulation::tipFrame): x along its tangent. The
 *  introducer while the instrument is outside. */
geometry_msgs::Pose tipPose(const simulation::Simulation& simulation, std::size_t instrument);

/** True if a contact is one of the wall with this instrument: the outermost one that reaches the contact's node. */
bool isOn(const simulation::Simulation& simulation, std::size_t instrument, const simulation::WallContact& contact);

}  // namespace endovascular_sim::nodes
