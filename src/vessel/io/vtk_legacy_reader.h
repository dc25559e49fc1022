#pragma once

#include <string>
#include <string_view>

#include "vessel/io/vtk_poly_data.h"

namespace endovascular_sim::vessel
{

/** Reads a legacy VTK file (.vtk) with the data set POLYDATA, ASCII or binary, of the versions up to 5.1. Points,
 *  polygons, triangle strips and lines are read; other arrays than radii are skipped.
 *  @param path names the file in errors
 *  @throws InputError for a damaged file or another kind of data */
VtkPolyData readLegacyVtk(std::string_view bytes, const std::string& path);

}  // namespace endovascular_sim::vessel
