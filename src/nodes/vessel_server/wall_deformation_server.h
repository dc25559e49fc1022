#pragma once

#include <cstdint>
#include <deque>

#include "endovascular_sim/BalloonLoad.h"
#include "endovascular_sim/WallDisplacement.h"
#include "intervention/vessel_dilatation.h"
#include "nodes/runtime/priority_mutex.h"

namespace endovascular_sim::nodes
{

/** The vessel's side of a treatment: what vessel_server answers to a BalloonLoad. For several threads. */
class WallDeformationServer
{
public:
  /** @param vessel version 1 of it */
  explicit WallDeformationServer(const vessel::Vessel& vessel)
    : opening_(vessel, intervention::DilatationLaw{}), base_(vessel.mesh)
  {
  }

  /** From one thread only.
   *  @return false when the message is not the next one: a rod that knows another wall than this one */
  bool press(const BalloonLoad& pressing, WallDisplacement& answer);

  /** A mesh and what has moved since, in order. Contact may still be found with a wall two versions back. */
  struct Snapshot
  {
    std::uint64_t version = 1;
    geometry::TriangleMesh mesh;
    std::vector<WallDisplacement> moved;
  };
  Snapshot snapshot() const;

  std::uint64_t version() const;  ///< newest

private:
  intervention::VesselDilatation opening_;  ///< the pressing thread's
  mutable PriorityInheritanceMutex mutex_;  ///< of what follows
  std::uint64_t version_ = 1;
  geometry::TriangleMesh base_;          ///< the wall before recent_
  std::deque<WallDisplacement> recent_;  ///< the last versions
};

}  // namespace endovascular_sim::nodes
