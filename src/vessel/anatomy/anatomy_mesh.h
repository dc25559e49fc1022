#pragma once

#include <string>

#include "vessel/anatomy/anatomy.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::vessel
{

/** Counts changes of the generator that change its meshes: part of the cache's key. */
constexpr int kAnatomyGeneratorVersion = 2;

/** The wall of an anatomy as one watertight mesh with rounded ends and smooth junctions.
 *  @throws InputError when branches that should not meet touch, so that the lumen has a handle or an inner surface */
geometry::TriangleMesh generateAnatomyMesh(const Anatomy& anatomy, const std::vector<AnatomyChain>& chains);

/** Folder of the cache: $XDG_CACHE_HOME/endovascular_sim, or ~/.cache/endovascular_sim; empty without either. */
std::string anatomyCacheFolder();

/** Reads an anatomy file, and its mesh from the cache or, the first time, by generating it (some ten seconds).
 *  @param cache_folder where meshes are kept; empty: no cache. A damaged entry is made anew, and a folder that
 *         cannot be written only costs the time.
 *  @throws InputError when the file is refused */
Vessel loadAnatomy(const std::string& file, const std::string& cache_folder = anatomyCacheFolder());

}  // namespace endovascular_sim::vessel
