#pragma once

#include <string>
#include <string_view>

#include "vessel/io/mesh_builder.h"

namespace endovascular_sim::vessel
{

/** Reads the facets of an STL file, binary or ASCII. The file is binary when its size matches the number of triangles
 * in its header; otherwise a text that begins with `solid` is ASCII. A binary file with surplus bytes after its
 * triangles is read with a warning. Normals are ignored.
 *  @param path names the file in errors
 *  @throws InputError for a truncated or malformed file */
void readStl(std::string_view bytes, const std::string& path, MeshBuilder& mesh);

}  // namespace endovascular_sim::vessel
