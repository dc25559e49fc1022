#pragma once

#include <string>

#include "vessel/anatomy/anatomy.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::vessel
{

/** Version of the mesh generator; part of the cache key. Incremented by every change of generated meshes. */
constexpr int kAnatomyGeneratorVersion = 2;

/** Generates the wall of an anatomy as one watertight mesh with rounded ends and blended junctions.
 *  @throws InputError if unrelated branches overlap, so that the lumen has a handle or an inner surface */
geometry::TriangleMesh generateAnatomyMesh(const Anatomy& anatomy, const std::vector<AnatomyChain>& chains);

/** Folder of the mesh cache: $XDG_CACHE_HOME/endovascular_sim, or ~/.cache/endovascular_sim; empty without either. */
std::string anatomyCacheFolder();

/** Reads an anatomy file. The mesh comes from the cache, or is generated and cached (about ten seconds).
 *  @param cache_folder folder of cached meshes; empty disables the cache. Damaged entries are rebuilt. A read-only
 *           folder is no error.
 *  @throws InputError if the file is invalid */
Vessel loadAnatomy(const std::string& file, const std::string& cache_folder = anatomyCacheFolder());

}  // namespace endovascular_sim::vessel
