#include <algorithm>
#include <cmath>

#include "rod/paper/paper_stepper.h"

// Contact impulses of the `paper` scheme, from the features at the beginning of the step.

namespace endovascular_sim::rod
{

PaperStepper::Spring PaperStepper::spring(const contact::Feature& feature, const State& state, double dt) const
{
  Spring spring;
  spring.node = std::min(feature.edge, rod_.nodes() - 2);
  spring.weight1 = feature.edge + 1 < rod_.nodes() ? feature.parameter : 1.0;
  spring.weight0 = 1.0 - spring.weight1;
  // Effective mass of a point between two nodes.
  spring.mass = 1.0 / (spring.weight0 * spring.weight0 / rod_.mass[spring.node] +
                       spring.weight1 * spring.weight1 / rod_.mass[spring.node + 1]);
  const Eigen::Vector3d velocity =
      spring.weight0 * state.velocity[spring.node] + spring.weight1 * state.velocity[spring.node + 1];
  spring.active = feature.gap + std::min(0.0, dt * feature.normal.dot(velocity)) < 0.0;
  return spring;
}

/** Adds the impulse (6) of the paper, once per feature, in the depth of the wire's surface along the normal, and its
 *  derivative. */
void PaperStepper::addContacts(const State& state, double dt)
{
  springs_.clear();
  for (const contact::Feature& feature : contacts_.features)
  {
    springs_.push_back(spring(feature, state, dt));
    const Spring& s = springs_.back();
    if (!s.active || s.node < first_)
      continue;
    const Eigen::Vector3d push = (-s.mass * feature.gap) * feature.normal;
    const Eigen::Matrix3d block = s.mass * feature.normal * feature.normal.transpose();
    addForce(s.node, s.weight0 * push);
    addForce(s.node + 1, s.weight1 * push);
    addBlock(s.node, s.node, s.weight0 * s.weight0 * block);
    addBlock(s.node + 1, s.node, s.weight0 * s.weight1 * block);
    addBlock(s.node + 1, s.node + 1, s.weight1 * s.weight1 * block);
  }
}

void PaperStepper::updateWallForces(State& state, double dt)
{
  for (int i = first_; i < rod_.nodes(); ++i)
    state.wall_force[i].setZero();
  for (std::size_t c = 0; c < springs_.size(); ++c)
  {
    const Spring& s = springs_[c];
    const contact::Feature& feature = contacts_.features[c];
    if (!s.active || s.node < first_)
      continue;
    const Eigen::Vector3d motion = s.weight0 * displacement(s.node) + s.weight1 * displacement(s.node + 1);
    const double force = -s.mass * (feature.gap + feature.normal.dot(motion)) / (dt * dt);
    for (int side = 0; side < 2 && force > 0.0; ++side)
    {
      const int node = s.node + side;
      const double weight = side == 0 ? s.weight0 : s.weight1;
      if (weight <= 0.0)
        continue;
      state.wall_force[node] += (weight * force) * feature.normal;
      state.friction_coefficient[node] = std::isnan(rod_.friction[node]) ? feature.friction : rod_.friction[node];
    }
  }
}

}  // namespace endovascular_sim::rod
