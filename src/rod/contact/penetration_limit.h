#pragma once

#include <vector>

#include "rod/contact/contact_list.h"
#include "rod/model/discretisation.h"

namespace endovascular_sim::rod
{

/** Limit of the penetration of rigid walls and stiff layers by one motion. Tolerated are 80 µm, and at most 0.8 of the
 *  distance from the layer to the wire's axis. A contact that was deeper before the motion may stay as deep. */
class PenetrationLimit
{
public:
  /** @param rod must outlive this */
  explicit PenetrationLimit(const Discretisation& rod) : rod_(rod) {}

  /** Stores, node by node, the excess depth before a motion.
   *  @param mouth_edge edge with the introducer's mouth, or −1
   *  @param mouth parameter of the mouth on that edge; a contact in the mouth counts for its first node only */
  void store(const ContactList& contacts, int mouth_edge, double mouth);

  /** True if a contact exceeds the tolerated depth and every stored depth of its nodes. The comparison is per node:
   *  penetration tolerated at one node must not permit penetration at another. */
  bool isExceeded(const ContactList& contacts) const;

private:
  double excess(const contact::Feature& feature) const;

  const Discretisation& rod_;
  std::vector<double> stored_;  ///< excess depth of every node's contacts before the motion [m]
};

}  // namespace endovascular_sim::rod
