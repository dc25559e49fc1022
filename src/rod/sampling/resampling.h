#pragma once

#include <vector>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/model/wire.h"

namespace endovascular_sim::rod
{

/** Transfer of a state from one sampling of a wire to another, in which some edges are split into halves and some pairs
 *  of edges are merged. A merge undoes a split to round-off.
 *
 *  - A new node lies on the arc through its neighbours: the middle of the chord less h²/8 times the mean curvature
 *    vector. The halves are then longer than their rest length by (κh)²/32; the next solve removes this strain.
 *  - Linear momentum is conserved. A new node gets the mean velocity of its neighbours, each weighted with the mass
 * that it gives. A removed node returns that momentum, and its neighbours share the rest. Splitting loses the kinetic
 *    energy ½ m_a m_b/(m_a + m_b) |v_a − v_b|² of the masses m_a, m_b given; merging returns no more.
 *  - Nodes keep their moments and the wall's forces. A new node gets the mean moment of its neighbours and no force; a
 *    removed one gives half of its force to each of them. Offsets of the curvature and of the gaps (which the stepper
 *    sets) balance the remaining difference; they fade over some steps.
 *  - A new node gets the elastic displacement of its neighbours' friction.
 *  - A half edge gets the tension of the whole edge and interpolated twist; a merged edge gets the mean of both. */
class Resampling
{
public:
  /** Transfers a state.
   *  @param from sampling of @p state
   *  @param to new sampling; each of its edges is an edge of @p from, half of one, or two of them together
   *  @throws std::logic_error for other samplings */
  void carry(const Wire& wire, const Discretisation& from, const Discretisation& to, State& state);

private:
  /** Node that is inserted or removed between two others. */
  struct Change
  {
    int coarse;                      ///< index of the node before, in the sampling without the node
    int fine;                        ///< index of the node, in the sampling with it
    bool split;                      ///< true: inserted; false: removed
    double mass_before, mass_after;  ///< mass that the node before and the one after give or get [kg]
    double cell_before, cell_after;  ///< length of their cells that they give or get [m]
  };

  void findChanges(const Wire& wire, const Discretisation& from, const Discretisation& to);
  void addChange(const Wire& wire, const Discretisation& coarse, const Discretisation& fine, int coarse_node,
                 int fine_node, bool split);
  void carryEdges(const Discretisation& from, const Discretisation& to, const State& state);
  void carryTwist(const Discretisation& from, const Discretisation& to, int first_node,
                  const std::vector<double>& angle, std::vector<double>& next) const;
  template <typename Value>
  void carryMeans(const Discretisation& from, const Discretisation& to, const std::vector<Value>& value,
                  std::vector<Value>& next) const;
  void carryNodes(const Discretisation& from, const Discretisation& to, const State& state);
  void insert(const Change& change, const Discretisation& from, const State& state);
  void remove(const Change& change, const Discretisation& to, const State& state);
  void carryMoments(const Discretisation& from, const Discretisation& to, const State& state);

  State next_;
  std::vector<Change> changes_;
  std::vector<int> new_node_;  ///< new index of every old node; −1: removed
};

/** Fades the offsets of gaps and curvatures, so that the wire adapts smoothly to its new nodes.
 *  @return true while any remain */
bool fadeOffsets(State& state, double dt);

}  // namespace endovascular_sim::rod
