#pragma once

#include <string>
#include <string_view>

#include "vessel/io/mesh_builder.h"

namespace endovascular_sim::vessel
{

/** Reads the elements `vertex` (x, y, z) and `face` (vertex_indices) of a PLY file: ASCII, little or big endian, any
 *  scalar types; other elements and properties are skipped.
 *  @param path names the file in errors
 *  @throws InputError for a malformed header, missing properties, or fewer data than the header announces */
void readPly(std::string_view bytes, const std::string& path, MeshBuilder& mesh);

}  // namespace endovascular_sim::vessel
