#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Reads the triangles of an OBJ, STL (ASCII or binary) or PLY file; polygons are cut into triangles.
 *
 *  Vertices with equal coordinates are joined, in the order in which the file names them. Coordinates pass through
 *  single precision (a relative 6e-8). Nothing else is changed: the result may have holes or faces turned inward.
 *  @param path file; its extension tells the format
 *  @param unit metres per unit of the file (0.001 for millimetres)
 *  @throws InputError when the file is missing, of another format, damaged, or without triangles */
geometry::TriangleMesh readMesh(const std::string& path, double unit);

/** Writes an OBJ file in metres, for a look at it in other programs.
 *  @throws InputError when the file cannot be written */
void writeObj(const geometry::TriangleMesh& mesh, const std::string& path);

}  // namespace endovascular_sim::vessel
