#pragma once

#include <cstdint>
#include <vector>

#include "endovascular_sim/BalloonLoad.h"
#include "endovascular_sim/WallDisplacement.h"
#include "intervention/vessel_dilatation.h"
#include "nodes/runtime/priority_inheritance_mutex.h"
#include "simulation/wall_history.h"

namespace endovascular_sim::nodes
{

/** Deformable wall of vessel_server: responds to a BalloonLoad with a WallDisplacement. Thread-safe as noted. */
class WallDeformationServer
{
public:
  /** @param vessel the vessel in version 1 */
  explicit WallDeformationServer(const vessel::Vessel& vessel)
    : opening_(vessel, intervention::DilatationLaw{}), base_(vessel.mesh)
  {
  }

  /** Applies the next load; call it from one thread only.
   *  @param[out] displacement all fields but the header
   *  @return false when the load does not follow the newest version: the sender has another wall than this one */
  bool press(const BalloonLoad& load, WallDisplacement& displacement);

  /** Wall with its recent displacements. Contact detection lags behind the newest version by at most
   *  simulation::kWallLag versions, and can follow from the mesh. */
  struct Snapshot
  {
    std::uint64_t version = 1;                    ///< version of the mesh
    geometry::TriangleMesh mesh;                  ///< wall before the displacements
    std::vector<WallDisplacement> displacements;  ///< one per later version, in order
  };
  Snapshot snapshot() const;  ///< thread-safe

  std::uint64_t version() const;  ///< newest version; thread-safe

private:
  intervention::VesselDilatation opening_;  ///< used by the thread of press() only
  mutable PriorityInheritanceMutex mutex_;  ///< guards the following members
  simulation::WallHistory<WallDisplacement> history_;
  geometry::TriangleMesh base_;  ///< mesh in the history's base version
};

}  // namespace endovascular_sim::nodes
