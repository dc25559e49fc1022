#pragma once

#include <vector>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/model/wire.h"

namespace endovascular_sim::rod
{

/** Carries a state from one sampling of a wire to another in which some edges are halved and some pairs of edges are
 *  one; a merge undoes a split to round-off.
 *
 *  - A new node lies on the arc through its neighbours: half the chord less h²/8 times the mean curvature vector. The
 *    halves are then longer than their rest length by (κh)²/32; the next solve takes that back.
 *  - Linear momentum is conserved. A new node moves with the mean of its neighbours, each weighted with the mass it
 *    gives; a node that goes gives that mean back and shares what its momentum had beyond it. Splitting loses the
 *    kinetic energy of the mean, ½ m_a m_b/(m_a + m_b) |v_a − v_b|² of the masses given; merging returns no more.
 *  - Nodes keep their moments and the wall's forces; a new one gets the mean moment of its neighbours and no force, one
 *    that goes gives them half of its force each. What the new shape asks for beyond that is set as offsets of the
 *    curvature and, by the stepper that knows the contacts, of the gaps: they fade over some steps.
 *  - A new node's friction has the stretch of its neighbours'.
 *  - Tension is that of the edge, twist is interpolated; merging takes the mean. */
class Resampling
{
public:
  /** @param from the sampling that @p state has
   *  @param to the one it gets; each of its edges is one of @p from, half of one, or two of them together
   *  @throws std::logic_error when it is not */
  void carry(const Wire& wire, const Discretisation& from, const Discretisation& to, State& state);

private:
  /** A node that comes between the nodes a and a+1 or goes from there, in indices of the sampling without it. */
  struct Change
  {
    int coarse;                      ///< a in the sampling without the node
    int fine;                        ///< the node itself in the sampling with it
    bool split;                      ///< it comes
    double mass_before, mass_after;  ///< mass that a and a+1 give to the node, or get from it [kg]
    double cell_before, cell_after;  ///< length of the cells likewise [m]
  };

  void findChanges(const Wire& wire, const Discretisation& from, const Discretisation& to);
  void addChange(const Wire& wire, const Discretisation& coarse, const Discretisation& fine, int coarse_node,
                 int fine_node, bool split);
  void carryEdges(const Discretisation& from, const Discretisation& to, const State& state);
  void carryTwist(const Discretisation& from, const Discretisation& to, int first_node,
                  const std::vector<double>& angle, std::vector<double>& next) const;
  void carryLoad(const Discretisation& from, const Discretisation& to, const std::vector<double>& load,
                 std::vector<double>& next) const;
  void carryNodes(const Discretisation& from, const Discretisation& to, const State& state);
  void insert(const Change& change, const Discretisation& from, const State& state);
  void remove(const Change& change, const Discretisation& to, const State& state);
  void carryMoments(const Discretisation& from, const Discretisation& to, const State& state);

  State next_;
  std::vector<Change> changes_;
  std::vector<int> new_node_;  ///< of each old one; −1: it goes
};

/** Lets the offsets of gaps and curvatures fade, so that the wire settles to its new nodes unnoticed.
 *  @return true while any are left */
bool fadeOffsets(State& state, double dt);

}  // namespace endovascular_sim::rod
