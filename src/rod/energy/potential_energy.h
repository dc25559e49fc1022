#pragma once

#include <vector>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Potential energies of a wire at given positions and twist angles [J]. */
struct PotentialEnergy
{
  double bending = 0.0;
  double twist = 0.0;
  double guide = 0.0;    ///< guide and sheath of the introducer
  double gravity = 0.0;  ///< weight less buoyancy

  double sum() const { return bending + twist + guide + gravity; }
};

PotentialEnergy operator-(const PotentialEnergy& a, const PotentialEnergy& b);
PotentialEnergy operator*(double factor, const PotentialEnergy& energy);

/** Adds bending and twist of a wire at given twist angles. In contrast to QuasiStaticTwist, nothing is relaxed, and the
 *  part before State::first_node counts too: it is straight. Offsets of the rest curvature (State::curvature_offset)
 *  count as rest curvature. The constant ½∫EI|κ̄|² of the pre-curved sections is omitted: in the straight part it would
 *  depend on the nodes. The bending energy of an unloaded curved tip is therefore negative.
 *  @param rod one layer with the first nodes of the state
 *  @param hold hold of the twist's proximal end
 *  @param state positions of all nodes; see completed()
 *  @param twist_angle angles of the layer's edges [rad] */
void addElasticEnergy(const Discretisation& rod, const TwistBoundary& hold, const State& state,
                      const std::vector<double>& twist_angle, PotentialEnergy& energy);

}  // namespace endovascular_sim::rod
