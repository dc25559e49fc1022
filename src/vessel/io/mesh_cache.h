#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Reads a mesh kept under a key; nothing when there is none, it is damaged, or belongs to another key. */
std::optional<geometry::TriangleMesh> readCachedMesh(const std::string& file, std::uint64_t key);

/** Keeps a mesh under a key. Written beside and renamed, so that readers see all of it or nothing.
 *  @return false when it cannot be written */
bool writeCachedMesh(const std::string& file, std::uint64_t key, const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::vessel
