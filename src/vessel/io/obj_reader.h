#pragma once

#include <string>
#include <string_view>

#include "vessel/io/mesh_builder.h"

namespace endovascular_sim::vessel
{

/** Reads vertices (`v`) and faces (`f`, with texture and normal numbers, negative numbers relative to the last vertex)
 * of a Wavefront OBJ text; all other statements are ignored.
 *  @param path names the file in errors
 *  @throws InputError with the line of a malformed statement */
void readObj(std::string_view text, const std::string& path, MeshBuilder& mesh);

}  // namespace endovascular_sim::vessel
