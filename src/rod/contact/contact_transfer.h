#pragma once

#include <cstdint>
#include <vector>

#include "rod/contact/contact_list.h"
#include "rod/contact/contact_springs.h"
#include "rod/contact/node_renumbering.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Transfer of contacts to another sampling of the wire.
 *
 *  A new node between two others lies on the arc, which reaches into the wall that the chord touched: the wall would
 *  push it out at once. Therefore new nodes get a wall offset with which every contact keeps the force that it had. */
class ContactTransfer
{
public:
  /** @param rod must outlive this */
  explicit ContactTransfer(const Discretisation& rod) : rod_(rod) {}

  /** Moves features to another sampling: with their edges, or else to the same position along the wire. */
  void moveFeatures(const Discretisation& to, const NodeRenumbering& renumbering,
                    std::vector<contact::Feature>& features) const;

  /** Stores the forces of the contacts of the last step by their positions along the wire. */
  void storeForces(const ContactList& contacts);

  /** Sets the state's wall offsets where they are NaN, after the change of nodes and the next detection. */
  void settle(const ContactList& contacts, ContactSprings& springs, State& state);

  void archive(Archive& archive);

private:
  /** Contact before the change of nodes. */
  struct StoredForce
  {
    std::int64_t id;  ///< of the feature
    double position;  ///< along the wire [m]
    double force;     ///< [N]

    void archive(Archive& archive);
  };

  double positionOf(const contact::Feature& feature) const;
  double storedForce(const contact::Feature& feature) const;
  void settleOffset(const contact::Feature& feature, const ContactSpring& spring, std::vector<double>& offset) const;

  const Discretisation& rod_;
  std::vector<StoredForce> stored_;  ///< from the change of nodes to the next step
  std::vector<bool> fresh_;          ///< nodes without a wall offset
};

}  // namespace endovascular_sim::rod
