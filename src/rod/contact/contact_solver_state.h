#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "rod/contact/contact_margins.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Depth of a wire's surface up to which a soft wall gives way by its stiffness; from there on it is rigid [m]. The
 *  wire's axis stays in the undeformed lumen. @param radius of the wire [m] */
double softWallTravel(double radius);

/** Contact of a rod whose unknowns include its nodes' positions, apart from how its matrix is laid out: contact sets
 *  asked for and kept, one-sided springs with an active set, the trust region by free distances, lagged wall forces.
 *  The rules are those of docs/CONTACT.md. What touches is the chord between two nodes. */
class ContactSolver
{
public:
  /** A one-sided spring between the wall and a point of an edge. */
  struct Spring
  {
    int node = 0;            ///< the edge's first node
    double weight0 = 0.0;    ///< share of that node
    double weight1 = 0.0;    ///< share of the next one
    double stiffness = 0.0;  ///< [N/m]
    double gap = 0.0;        ///< that the wall's law sees [m]
    double force = 0.0;      ///< after an accepted solve [N]
    double reached = 0.0;    ///< gap at the point that the search for the active set has reached [m]
    double resisted = 0.0;   ///< stiffness times gap that the systems solved so far had there [N]
    bool active = false;

    void archive(Archive& archive);
  };
  using Motion = std::vector<Eigen::Vector3d>;  ///< a solve's increment of every node [m]

  /** @param rod, boundary, settings must outlive this */
  ContactSolver(const Discretisation& rod, const Boundary& boundary, const StepperSettings& settings)
    : rod_(rod), boundary_(boundary), settings_(settings), margin_rule_(uniformMargin(settings.contact_margin))
  {
  }
  ContactSolver(const ContactSolver&) = delete;  // it refers to its owner's members
  ContactSolver& operator=(const ContactSolver&) = delete;

  /** @param source null without a vessel */
  void beginStep(const StepInput& input, contact::ContactSource* source, std::uint32_t& pass, PhaseTimer& timer);

  /** Least radius of the surface at every node until the nodes change; the present contacts come closer by as much as
   * it grows [m]. */
  void setRadii(const std::vector<double>& radii);

  /** How far a node may move before the features within reach of it are not all among the present contacts [m]. */
  double marginOf(int node) const;

  /** Margins of the last query for features. */
  const MarginRule& marginRule() const { return margin_rule_; }

  bool present() const { return source_ != nullptr; }
  const contact::ContactSet& set() const { return contacts_; }
  /** The state was taken back to before the present contacts were found. */
  void invalidate()
  {
    valid_ = false;
    stale_motion_budget_ = 0.0;
  }

  /** Asks for the state's contacts. */
  void detect(const State& state, StepReport& report);

  /** Once more for a state that was moved back; the last solve's contacts are kept. */
  void detectAgain(const State& state, StepReport& report);

  /** Before a motion: notes by how much the present contacts are deeper in walls that do not give way than is
   * tolerated. Tolerated is less than would take the wire's axis to the wall. */
  void noteDepths();

  /** Whether a present contact is deeper than is tolerated, and than any was then at that node. */
  bool isDeeper() const;

  /** Detects where the last answer is missing or old. */
  void refresh(const State& state, StepReport& report);

  /** Springs for the present contacts; active are those that the velocity would close within @p dt. */
  void prepare(const State& state, double dt);

  std::size_t count() const { return springs_.size(); }
  const Spring& spring(std::size_t index) const { return springs_[index]; }
  const contact::Feature& feature(std::size_t index) const { return contacts_.features[index]; }

  /** After a solve: closes and opens springs, later passes only close.
   *  Contact springs make the solved problem convex and piecewise quadratic, each solve is Newton's step on it. The
   *  springs are those at the least energy on the way from the point reached so far to the solution: full steps may
   * cycle.
   *  @param same_rest of the system but for the springs as at the last solve; else the way begins at the solution
   *  @return true when something changed */
  bool updateActiveSet(const Motion& motion, int pass, bool same_rest);
  /** Lowest node of the springs that the last such update closed or opened; beyond all nodes where it did with none. */
  int firstChanged() const { return first_changed_; }

  /** Share of the motion, at most @p factor, in which no point moves further than its free distance. */
  double truncation(const State& state, const Motion& motion, double factor, StepReport& report);

  /** Sets the state's wall forces from the springs of the last solve after its accepted motion. */
  void updateWallForces(State& state, const Motion& motion);

  /** True when the last detection shows a contact deeper than tolerated that the last solve did not resist. */
  bool foundUnknown(const State& state) const;

  /** Keeps, beside what the last detection found, the contacts between nodes that pressed before it and that it did not
   *  find again, each as the plane that it was, until releaseRetained(). A wide body rolls from ridge to ridge as it
   * tilts; with those of one tilt alone the solves of a step go to and fro between them. A node's own contacts are not
   * kept: the facet beside takes their place. */
  void retainActiveContacts(const State& state);

  /** At the end of a step. */
  void releaseRetained();

  /** Takes the contacts to another sampling of the wire, before the rod is changed: where the nodes that were asked
   *  about stay the same ones, so do their contacts; elsewhere they keep their place along the wire, for when the next
   *  set comes too late. */
  void resample(const Discretisation& to);

  /** After a change of nodes and the next detection: sets the state's wall offsets where they are not a number, so that
   *  contacts go on with the forces that they had. */
  void settle(State& state);

  /** Saves or loads what the next step needs. */
  void archive(Archive& archive);

private:
  /** What a contact did before the nodes changed. */
  struct Carried
  {
    std::int64_t id;  ///< of the feature
    double place;     ///< along the wire [m]
    double force;     ///< [N]

    void archive(Archive& archive);
  };

  Spring springOf(int index) const;
  void addStiffLayer();
  void removeStiffLayer();
  void carry();
  void settleOffset(int index, std::vector<double>& offset) const;
  double carriedForce(const contact::Feature& feature) const;
  static void moveNodes(int added, std::vector<double>& of_nodes);
  void moveToSampling(contact::Feature& feature, const Discretisation& to) const;
  void listCrossings(const State& state);
  double radiusOf(int node) const;
  double radiusAt(const contact::Feature& feature) const;
  double toleratedDepth(const contact::Feature& feature) const;
  double excessDepth(const contact::Feature& feature) const;
  double usualMargin(int node) const;
  double listedMargin(int node) const;
  bool isWideAt(int node) const;
  void keepMargins();
  void findClearances();
  void keepReaches();
  double leastAround(int node, double (ContactSolver::*value)(int) const) const;
  void widenQueryForSnaps();
  void noteFastNodes(const Motion& motion, int first);
  void spendMargins(const std::vector<double>& radii);
  double growthTo(double radius, int node) const;
  double lengthOf(int index) const;
  double shareAtNode(int index) const;
  double lengthTowards(int index, int edge, double place, int direction) const;
  double shareOfLeastEnergy();
  double approach(const Spring& spring, const Eigen::Vector3d& normal, const Motion& motion) const;
  double marginsIn(const Motion& motion, int first) const;
  void noteWideMotion(const Motion& motion, int first, double factor);
  double wantedWideMargin() const;
  double freshTruncation(const State& state, const Motion& motion, double factor, double margins, StepReport& report);
  double listedTruncation(const State& state, const Motion& motion, double factor) const;
  double freeDistanceTruncation(const State& state, const Motion& motion, double factor, StepReport& report);
  double staleTruncation(const Motion& motion);
  double gapAt(const State& state, const contact::Feature& feature) const;
  double offsetAt(const State& state, const contact::Feature& feature) const;
  void ask(const State& state, contact::ContactSet& answer, StepReport& report);
  void askFreeDistances(const State& state, const Motion& motion, double factor, StepReport& report);
  void send(double wanted_free_distance, contact::ContactSet& answer, StepReport& report);
  void widen();

  const Discretisation& rod_;
  const Boundary& boundary_;
  const StepperSettings& settings_;
  contact::ContactSet contacts_, previous_contacts_, free_distances_;
  std::vector<Spring> springs_, previous_springs_;
  std::vector<double> gap_after_;       ///< of every spring after the motion of the last solve [m]
  std::vector<std::size_t> resisting_;  ///< springs that a line search regards
  std::size_t kept_ = 0;                ///< at the end of contacts_: not found by the last detection
  std::size_t kept_before_ = 0;         ///< the same of previous_contacts_
  int first_changed_ = 0;
  std::vector<double> depths_;    ///< of every node's contacts before a motion, beyond what is tolerated [m]
  std::vector<Carried> carried_;  ///< from a change of nodes to the next step
  std::vector<bool> fresh_;       ///< nodes whose edges have changed
  std::vector<int> crossings_;    ///< compliant contacts between nodes, along the wire
  bool valid_ = false;
  bool moved_on_ = false;  ///< contacts were found since the last solve, whose ones are the previous ones
  bool step_is_stale_ = false;
  std::vector<double> margins_;  ///< of the nodes in the last fresh contact set, less what they have grown by since [m]
  std::vector<double> reaches_;  ///< how far the nodes may move, by their margins and what they are clear of [m]
  std::vector<double> clearances_;                                ///< for those [m]
  bool any_wide_ = false;                                         ///< of the bodies
  NodeRange fast_;                                                ///< in this step so far
  NodeRange fast_before_;                                         ///< in the last one
  double wide_motion_ = std::numeric_limits<double>::infinity();  ///< of the wide body that moved most of late [m]
  double stale_motion_budget_ = 0.0;  ///< share of every node's margin that the last fresh contact set still covers
  contact::Query query_;
  MarginRule margin_rule_;  ///< of the last query for features
  double mouth_ = 0.0;      ///< share of an edge at which the introducer's mouth stands, where the last set begins
  int mouth_edge_ = -1;     ///< that edge, or −1
  contact::ContactSource* source_ = nullptr;
  PhaseTimer* timer_ = nullptr;
  std::uint32_t* pass_ = nullptr;
  std::uint64_t step_ = 0;
  std::uint32_t substep_ = 0;
  std::uint64_t vessel_version_ = 0;
  std::vector<double> radii_;  ///< least ones, per node; empty: the rod's own [m]
};

}  // namespace endovascular_sim::rod
