#pragma once

#include <cstdint>
#include <limits>

#include "common/phase_timer.h"
#include "contact/contract/contact_set.h"
#include "rod/contact/contact_list.h"
#include "rod/contact/contact_margins.h"
#include "rod/contact/node_renumbering.h"
#include "rod/contact/wire_surface.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Builds the queries of a contact solver and sends them.
 *
 *  The margin of each node is the contact margin, with two exceptions. Where a solve of this or the last step would
 *  have moved nodes by more than 0.6 margins (a snap-through), these nodes and two on either side have three margins:
 *  fewer solves are truncated. Wide bodies, once a balloon is filled, have at most 5 µm + 4·v: v is their largest
 *  recent motion or growth per step, halved from step to step. */
class ContactQueryBuilder
{
public:
  /** @param rod, boundary, settings, surface must outlive this */
  ContactQueryBuilder(const Discretisation& rod, const Boundary& boundary, const StepperSettings& settings,
                      const WireSurface& surface);
  ContactQueryBuilder(const ContactQueryBuilder&) = delete;  // it refers to its owner's members
  ContactQueryBuilder& operator=(const ContactQueryBuilder&) = delete;

  /** @param source null without a vessel
   *  @param pass counter of the queries in the caller's step */
  void beginStep(const StepInput& input, contact::ContactSource* source, std::uint32_t& pass, PhaseTimer& timer);

  bool hasSource() const { return source_ != nullptr; }

  /** Queries the features near a state. Parameters of the answer refer to whole edges, also in the mouth. */
  void detect(const State& state, contact::ContactSet& answer, StepReport& report);

  /** Describes the nodes beyond the introducer's mouth for a query for free distances.
   *  @return the first node */
  int describe(const State& state);

  /** Queries the free distances of the described state.
   *  @param first_edge edges before it are omitted
   *  @param wanted see contact::ContactSource [m] */
  void freeDistances(int first_edge, double wanted, contact::ContactSet& answer, StepReport& report);

  /** Notes the nodes that a solve would move in a snap-through. @param first first moved node */
  void noteSnapThrough(const NodalMotion& motion, int first);
  void noteWideMotion(double distance);  ///< largest motion of the wide bodies in a solve [m]
  void noteWideGrowth(double growth);    ///< growth of a wide body's radius [m]

  /** The last query. */
  const contact::Query& query() const { return query_; }
  /** Margins of the last query for features. */
  const MarginRule& marginRule() const { return margin_rule_; }
  /** Edge with the introducer's mouth in the last query for features, or −1. */
  int mouthEdge() const { return mouth_edge_; }
  /** Parameter of the mouth on that edge. */
  double mouth() const { return mouth_; }

  void resample(const NodeRenumbering& renumbering);
  void archive(Archive& archive);
  void archiveStaleness(Archive& archive);

private:
  double describeNodes(const State& state);
  void updateMarginRule();
  void send(double wanted_free_distance, contact::ContactSet& answer, StepReport& report);

  const Discretisation& rod_;
  const Boundary& boundary_;
  const StepperSettings& settings_;
  const WireSurface& surface_;
  contact::Query query_;
  MarginRule margin_rule_;
  NodeRange snap_;                                                ///< nodes in a snap-through in this step
  NodeRange snap_before_;                                         ///< nodes in a snap-through in the last step
  double wide_motion_ = std::numeric_limits<double>::infinity();  ///< recent peak motion of wide bodies [m]
  double mouth_ = 0.0;
  int mouth_edge_ = -1;
  contact::ContactSource* source_ = nullptr;
  PhaseTimer* timer_ = nullptr;
  std::uint32_t* pass_ = nullptr;
  std::uint64_t step_ = 0;
  std::uint32_t substep_ = 0;
  std::uint64_t vessel_version_ = 0;
  bool step_is_stale_ = false;  ///< an answer of this step has failed to come
};

}  // namespace endovascular_sim::rod
