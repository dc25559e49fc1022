#include "rod/boundary/hemostatic_valve.h"

#include "rod/friction/coulomb_law.h"

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
  const CoulombLaw law{friction_, kPreSliding};
  law.cut(stretch);
  const Eigen::Vector2d pull = law.tangent(0.0) * stretch;
  state.hand_parts.valve = pull.x();
  state.valve_torque = radius * pull.y();
  state.hand_force += state.hand_parts.valve;
  state.hand_torque += state.valve_torque;
}

}  // namespace endovascular_sim::rod
