#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Reads a cached mesh; empty if the file is missing, damaged or stored under another key. */
std::optional<geometry::TriangleMesh> readCachedMesh(const std::string& file, std::uint64_t key);

/** Writes a mesh to the cache under a key, atomically by renaming a temporary file.
 *  @return false if the file cannot be written */
bool writeCachedMesh(const std::string& file, std::uint64_t key, const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::vessel
