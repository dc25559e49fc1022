#include "common/archive.h"
#include "rod/model/state.h"

namespace endovascular_sim::rod
{

void archive(Archive& archive, EndMotion& motion)
{
  archive(motion.displacement, motion.tilt, motion.rotation);
}

void archive(Archive& archive, HandForceParts& parts)
{
  archive(parts.bending, parts.friction, parts.inertia, parts.drag, parts.load, parts.valve);
}

void archive(Archive& archive, LayerState& layer)
{
  archive(layer.inserted_length, layer.rotation, layer.speed, layer.twist_angle, layer.friction_stretch,
          layer.friction_turn, layer.friction_share, layer.load, layer.force_offset, layer.hand_force,
          layer.hand_torque);
}

void archive(Archive& archive, State& state)
{
  archive(state.first_node, state.inserted_length, state.rotation, state.position, state.velocity, state.tension,
          state.moment, state.twist_angle, state.wall_force, state.friction_coefficient, state.friction_stretch,
          state.wall_offset, state.curvature_offset, state.hand_force, state.hand_torque, state.hand_parts,
          state.valve_torque, state.valve_stretch, state.layers, state.reference, state.distal, state.tip_transport,
          state.distal_torque, state.distal_anchor, state.proximal_force, state.distal_force);
}

}  // namespace endovascular_sim::rod
