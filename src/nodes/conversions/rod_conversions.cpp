#include "nodes/conversions/rod_conversions.h"

#include "nodes/conversions/contact_conversions.h"
#include "results/run_result.h"
#include "simulation/instrument_tip.h"

namespace endovascular_sim::nodes
{

void toMessage(const simulation::Simulation& simulation, RodStateVisual& message)
{
  const rod::State& state = simulation.state();
  const rod::Discretisation& wire = simulation.discretisation();
  message.step = simulation.steps() - 1;
  message.time = simulation.time();
  message.insertion.clear();
  message.rotation.clear();
  message.tip_rotation.clear();
  message.hand_force.clear();
  message.hand_torque.clear();
  message.pressure.clear();
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    const simulation::HandState hand = simulation.hand(k);
    message.insertion.push_back(hand.insertion);
    message.rotation.push_back(hand.rotation);
    message.tip_rotation.push_back(simulation::tipRotation(simulation, k));
    message.hand_force.push_back(hand.force);
    message.hand_torque.push_back(hand.torque);
    message.pressure.push_back(hand.pressure);
  }
  const int first = simulation::firstInsertedNode(simulation);
  message.first_node = static_cast<std::uint32_t>(first);
  message.nodes.clear();
  message.radius.clear();
  message.contact_force.clear();
  for (int i = first; i < wire.nodes(); ++i)
  {
    message.nodes.push_back(toPoint(state.position[i]));
    message.radius.push_back(wire.radius[i]);
    message.contact_force.push_back(toVector(state.wall_force[i]));
  }
}

}  // namespace endovascular_sim::nodes
