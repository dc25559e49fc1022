#pragma once

#include <Eigen/Core>

#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{

/** Index of the first node beyond the plane of the introducer; without an introducer, of the first node. */
int firstInsertedNode(const Simulation& simulation);

/** Point of the common centreline of the instruments at a length beyond the introducer [m].
 *  @param inserted length beyond the introducer [m]; negative outside */
Eigen::Vector3d pointAt(const Simulation& simulation, double inserted);

/** Rotation of an instrument's material about the centreline at its distal end [rad]: zero, sign and full turns are
 * those of HandState::rotation, which it equals without torque. */
double tipRotation(const Simulation& simulation, int instrument);

/** Material frame of an instrument's tip in the patient frame, columns tangent, d1, d2: the introducer's frame,
 *  transported along the centreline without twist, and turned about the tangent by tipRotation(). */
Eigen::Matrix3d tipFrame(const Simulation& simulation, int instrument);

}  // namespace endovascular_sim::simulation
