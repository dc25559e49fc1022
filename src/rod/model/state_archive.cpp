#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "rod/model/state.h"

namespace endovascular_sim::rod
{

void archive(Archive& archive, EndMotion& motion)
{
  archive(motion.displacement, motion.tilt, motion.rotation);
}

void archive(Archive& archive, HandForceParts& parts)
{
  archive(parts.bending, parts.friction, parts.inertia, parts.drag, parts.load, parts.valve, parts.configurational);
}

void archive(Archive& archive, LayerState& layer)
{
  archive(layer.inserted_length, layer.rotation, layer.speed, layer.twist_angle, layer.friction_stretch,
          layer.friction_turn, layer.friction_share, layer.load, layer.bore_shift, layer.force_offset, layer.hand_force,
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

static void requireFit(const LayerState& layer, std::size_t nodes)
{
  requireLength(nodes, layer.load, layer.bore_shift);
  requireLength(nodes - 1, layer.twist_angle);
  requireFinite(layer.inserted_length, layer.rotation, layer.speed, layer.twist_angle, layer.friction_stretch,
                layer.friction_turn, layer.friction_share, layer.load, layer.bore_shift, layer.force_offset,
                layer.hand_force, layer.hand_torque);
}

// wall_offset and hand_parts contain NaN in valid states.
void requireFit(const State& state, int nodes, int layers)
{
  const auto n = static_cast<std::size_t>(nodes);
  requireLength(n, state.position, state.velocity, state.wall_force, state.friction_coefficient, state.friction_stretch,
                state.wall_offset, state.curvature_offset);
  requireLength(n - 1, state.tension, state.twist_angle);
  requireLength(static_cast<std::size_t>(layers), state.layers);
  requireIndex(state.first_node, 0, std::max(1, nodes - 2));
  requireIndex(state.reference, 0, std::max(1, layers));
  requireFinite(state.inserted_length, state.rotation, state.position, state.velocity, state.tension, state.moment,
                state.twist_angle, state.wall_force, state.friction_coefficient, state.friction_stretch,
                state.curvature_offset, state.hand_force, state.hand_torque, state.valve_torque, state.valve_stretch);
  requireFinite(state.distal.displacement, state.distal.tilt, state.distal.rotation, state.tip_transport,
                state.distal_torque, state.distal_anchor, state.proximal_force, state.distal_force);
  for (const double offset : state.wall_offset)
    requireLoaded(!std::isinf(offset), "holds numbers that are not finite");
  for (const LayerState& layer : state.layers)
    requireFit(layer, n);
}

}  // namespace endovascular_sim::rod
