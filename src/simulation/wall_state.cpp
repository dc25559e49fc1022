#include "simulation/wall_state.h"

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::simulation
{

std::string wallState(intervention::VesselDilatation& opening, WallHistory<intervention::WallDisplacement>& history,
                      intervention::WallDisplacement& detected)
{
  Archive archive;
  archive(opening, history, detected);
  return archive.bytes();
}

void loadWallState(const std::string& state, intervention::VesselDilatation& opening,
                   WallHistory<intervention::WallDisplacement>& history, intervention::WallDisplacement& detected)
{
  Archive archive(state);
  archive(opening, history, detected);
  const std::size_t vertices = opening.initialVertices().size();
  intervention::requireFit(detected, vertices);
  std::uint64_t version = history.base();
  for (const auto& pending : history.pending())
  {
    intervention::requireFit(pending.displacement, vertices);
    requireLoaded(pending.version == ++version, "holds versions of the wall that do not follow each other");
  }
  requireLoaded(version == history.newest(), "holds a version of the wall that no displacement leads to");
  if (!archive.atEnd())
    throw ArchiveError("holds more than the state of a wall");
}

}  // namespace endovascular_sim::simulation
