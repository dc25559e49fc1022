#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rod/contact/active_set.h"
#include "rod/contact/contact_list.h"
#include "rod/contact/contact_query.h"
#include "rod/contact/contact_springs.h"
#include "rod/contact/contact_transfer.h"
#include "rod/contact/contact_trust_region.h"
#include "rod/contact/penetration_limit.h"
#include "rod/contact/wall_compliance.h"
#include "rod/contact/wire_surface.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Contact of a rod whose unknowns include the positions of its nodes, independent of the layout of its matrix.
 *  The chord between two nodes touches the wall.
 *
 *  The solver holds the contacts of the present state and those of the last solve. Its parts are queries with one
 *  margin per node (ContactQueryBuilder), one-sided springs (ContactSprings) with an active set (ActiveSet), the
 *  motion that the contacts permit (ContactTrustRegion), and the transfer to another sampling
 *  (ContactTransfer). The method is described in docs/CONTACT.md. */
class ContactSolver
{
public:
  using Spring = ContactSpring;
  using Motion = NodalMotion;

  /** @param rod, boundary, settings must outlive this */
  ContactSolver(const Discretisation& rod, const Boundary& boundary, const StepperSettings& settings);
  ContactSolver(const ContactSolver&) = delete;  // it refers to its owner's members
  ContactSolver& operator=(const ContactSolver&) = delete;

  /** @param source null without a vessel
   *  @param pass counter of the queries in the caller's step */
  void beginStep(const StepInput& input, contact::ContactSource* source, std::uint32_t& pass, PhaseTimer& timer);

  /** Sets the least radius of the surface at every node until the nodes change [m]. The gaps of the present contacts
   *  decrease by its growth. */
  void setRadii(const std::vector<double>& radii);

  /** Largest motion of a node for which the features within its reach are among the present contacts [m]. */
  double marginOf(int node) const { return trust_region_.reach(node); }
  /** Margins of the last query for features. */
  const MarginRule& marginRule() const { return query_.marginRule(); }

  bool present() const { return query_.hasSource(); }  ///< there is a vessel
  const contact::ContactSet& set() const { return current_.set; }

  /** Discards the present contacts, for a state restored to one before their detection. */
  void invalidate();

  /** Detects the contacts of a state. A stale answer is replaced by the earlier contacts, each as a plane. */
  void detect(const State& state, StepReport& report);

  /** Repeats the detection for a state that was moved back; the contacts of the last solve stay. */
  void detectAgain(const State& state, StepReport& report);

  /** Carries the present contacts with a wall that has moved. @param state carried with it */
  void carry(const State& state, const contact::WallMotion& wall);

  /** Stores the penetration beyond the tolerated depth before a motion (PenetrationLimit). */
  void noteDepths();

  /** True if a present contact exceeds the tolerated and the stored depth. */
  bool isDeeper() const { return penetration_.isExceeded(current_); }

  /** Detects if the last answer is missing or stale. */
  void refresh(const State& state, StepReport& report);

  /** Sets the springs of the present contacts; see ContactSprings::prepare(). */
  void prepare(const State& state, double dt, const contact::WallTravel* wall = nullptr);

  std::size_t count() const { return current_.springs.size(); }
  const Spring& spring(std::size_t index) const { return current_.springs[index]; }
  const contact::Feature& feature(std::size_t index) const { return current_.set.features[index]; }

  /** Updates the active springs after a solve; see ActiveSet::update. */
  bool updateActiveSet(const Motion& motion, int pass, bool same_rest);
  /** See ActiveSet::firstChanged. */
  int firstChanged() const { return active_set_.firstChanged(); }

  /** Share of a motion, at most @p factor, within the trust region; see ContactTrustRegion. */
  double truncation(const State& state, const Motion& motion, double factor, StepReport& report);

  /** Sets the state's wall forces from the springs of the last solve after its accepted motion. */
  void updateWallForces(State& state, const Motion& motion);

  /** Energy of the springs after the accepted motion of their solve; after updateWallForces() [J]. */
  double springEnergy() const;

  /** True if the last detection shows a contact deeper than tolerated that the last solve did not resist. */
  bool foundUnknown(const State& state) const;

  /** Retains, as planes, the active contacts between nodes that the last detection did not find again, until
   *  releaseRetained(). A wide body rolls from ridge to ridge as it tilts. With the contacts of one tilt only, the
   *  solves of a step alternate between two tilts. At a node nothing is retained: the next facet takes over. */
  void retainActiveContacts(const State& state);

  /** Drops the retained contacts, at the end of a step. */
  void releaseRetained();

  /** Transfers the contacts to another sampling of the wire, before the rod is changed. Where the queried nodes are the
   *  same, their contacts stay valid. Otherwise contacts keep their position along the wire, in case that the next
   *  set is stale. */
  void resample(const Discretisation& to);

  /** Sets the state's wall offsets where they are NaN, after a change of nodes and the next detection, so that every
   *  contact keeps the force that it had. */
  void settle(State& state) { transfer_.settle(current_, springs_, state); }

  /** Saves or loads the data needed by the next step. */
  void archive(Archive& archive);

private:
  void query(const State& state, StepReport& report);
  void addStiffLayers();
  void reuseEarlierContacts(const State& state);

  const Discretisation& rod_;
  const StepperSettings& settings_;
  ContactList current_;
  ContactList previous_;  ///< before the last detection
  WireSurface surface_;
  ContactQueryBuilder query_;
  ContactTrustRegion trust_region_;
  ContactSprings springs_;
  ActiveSet active_set_;
  PenetrationLimit penetration_;
  ContactTransfer transfer_;
  bool valid_ = false;
  bool solve_precedes_detection_ = false;  ///< the last solve was that of the previous contacts
};

}  // namespace endovascular_sim::rod
