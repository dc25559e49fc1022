#pragma once

#include <openvdb/openvdb.h>

namespace endovascular_sim::vessel
{

/** Makes hollows inside of closed walls a part of the inside: the space between the outer and the inner surface of a
 *  vessel's wall is not its lumen. A hollow is what a flood from the outside does not reach without coming closer than
 *  half a voxel to a triangle, and what is wider than the band somewhere.
 *  @param grid signed distances in voxels, as meshToVolume() makes them (hollows are positive) */
void fillCavities(openvdb::FloatGrid& grid);

}  // namespace endovascular_sim::vessel
