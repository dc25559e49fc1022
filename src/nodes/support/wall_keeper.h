#pragma once

#include <cstdint>
#include <deque>

#include "endovascular_sim/VesselMoved.h"
#include "endovascular_sim/VesselPressing.h"
#include "intervention/vessel_opening.h"
#include "nodes/support/priority_mutex.h"

namespace endovascular_sim::nodes
{

/** The vessel's side of a treatment: what vessel_server answers to a VesselPressing. For several threads. */
class WallKeeper
{
public:
  /** @param vessel version 1 of it */
  explicit WallKeeper(const vessel::Vessel& vessel) : opening_(vessel, intervention::OpeningLaw{}), base_(vessel.mesh)
  {
  }

  /** From one thread only.
   *  @return false when the message is not the next one: a rod that knows another wall than this one */
  bool press(const VesselPressing& pressing, VesselMoved& answer);

  /** A mesh and what has moved since, in order. Contact may still be found with a wall two versions back. */
  struct Snapshot
  {
    std::uint64_t version = 1;
    vessel::TriangleMesh mesh;
    std::vector<VesselMoved> moved;
  };
  Snapshot snapshot() const;

  std::uint64_t version() const;  ///< newest

private:
  intervention::VesselOpening opening_;  ///< the pressing thread's
  mutable PriorityMutex mutex_;          ///< of what follows
  std::uint64_t version_ = 1;
  vessel::TriangleMesh base_;       ///< the wall before recent_
  std::deque<VesselMoved> recent_;  ///< the last versions
};

}  // namespace endovascular_sim::nodes
