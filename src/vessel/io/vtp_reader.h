#pragma once

#include <string>
#include <string_view>

#include "vessel/io/vtk_poly_data.h"

namespace endovascular_sim::vessel
{

/** Reads an XML file of VTK's polygonal data (.vtp): ASCII, base64 or appended arrays, plain or compressed by zlib.
 *  Points, polygons, triangle strips and lines of all pieces are joined; other arrays than radii are skipped.
 *  @param path names the file in errors
 *  @throws InputError for a damaged file, another kind of data, or another compression */
VtkPolyData readVtp(std::string_view bytes, const std::string& path);

}  // namespace endovascular_sim::vessel
