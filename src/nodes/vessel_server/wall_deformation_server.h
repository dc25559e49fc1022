#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "endovascular_sim/BalloonLoad.h"
#include "endovascular_sim/WallDisplacement.h"
#include "intervention/vessel_dilatation.h"
#include "nodes/runtime/priority_inheritance_mutex.h"
#include "simulation/wall_history.h"

namespace endovascular_sim::nodes
{

/** Deformable wall of vessel_server: responds to a BalloonLoad with a WallDisplacement. Thread-safe. */
class WallDeformationServer
{
public:
  /** @param vessel the vessel in version 1 */
  explicit WallDeformationServer(const vessel::Vessel& vessel);

  /** Applies the next load.
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
  Snapshot snapshot() const;

  std::uint64_t version() const;  ///< newest version
  std::uint64_t base() const;     ///< version of the snapshot's mesh; after load() that of contact detection
  bool atRisk() const;            ///< true where the stretch of the wall is so large that it may tear

  /** State of the wall, with the bytes of simulation::wallState().
   *  @param detected version that contact detection searches
   *  @throws std::invalid_argument for a version that lags by more than simulation::kWallLag, or does not exist */
  std::string save(std::uint64_t detected);

  /** Continues from a state of save(). A refused one has no effect. @throws ArchiveError as simulation::loadWallState()
   */
  void load(const std::string& state);

  /** Returns to version 1. */
  void reset() { load(initial_); }

private:
  std::string stateAt(std::uint64_t detected);
  void adopt(const std::string& state);

  mutable PriorityInheritanceMutex opening_mutex_;  ///< locked before mutex_
  intervention::VesselDilatation opening_;          ///< guarded by opening_mutex_
  mutable PriorityInheritanceMutex mutex_;          ///< guards the following members
  simulation::WallHistory<WallDisplacement> history_;
  geometry::TriangleMesh base_;  ///< mesh in the history's base version
  std::string initial_;          ///< state of version 1; constant
};

}  // namespace endovascular_sim::nodes
