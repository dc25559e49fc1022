#include "rod/boundary/hemostatic_valve.h"

namespace endovascular_sim::rod
{

void HemostaticValve::release(State& state) const
{
  if (friction_ == 0.0)
    return;
  state.hand_force -= state.hand_parts.valve;
  state.hand_torque -= state.valve_torque;
}

void HemostaticValve::drag(State& state, double travel, double turn, double radius) const
{
  if (friction_ == 0.0)
    return;
  Eigen::Vector2d& stretch = state.valve_stretch;
  stretch += Eigen::Vector2d(travel, radius * turn);
  const double length = stretch.norm();
  if (length > kPreSliding)
    stretch *= kPreSliding / length;
  const Eigen::Vector2d pull = friction_ / kPreSliding * stretch;
  state.hand_parts.valve = pull.x();
  state.valve_torque = radius * pull.y();
  state.hand_force += state.hand_parts.valve;
  state.hand_torque += state.valve_torque;
}

}  // namespace endovascular_sim::rod
