#pragma once

#include <string>

#include "common/progress.h"
#include "geometry/triangle_mesh.h"
#include "vessel/io/mesh_builder.h"

namespace endovascular_sim::vessel
{

/** Reads the triangles of an OBJ, STL, PLY or VTK file (.vtp, .vtk) in double precision; polygons are triangulated.
 *
 *  Vertices with equal coordinates are welded and numbered in the order in which faces first use them. There is no
 *  repair: the mesh may have holes or inverted faces. Every number and index of the file is checked, and memory is
 *  allocated by the size of the file, not by the counts that it announces.
 *  @param path file; its extension determines the format
 *  A file that names the space RAS, as 3D Slicer writes it, is turned to the patient frame (LPS).
 *  @param unit metres per unit of the file (0.001 for millimetres)
 *  @param remarks receives notes and warnings, if given
 *  @throws InputError if the file is missing, of another format, damaged, or without triangles */
geometry::TriangleMesh readMesh(const std::string& path, double unit, const ProgressReport& progress = {},
                                MeshRemarks* remarks = nullptr);

/** Content of a regular file of at most 2 GiB.
 *  @throws InputError when it is missing, not a regular file, empty, too large or unreadable */
std::string readMeshFile(const std::string& path);

/** Writes a mesh as an OBJ file in metres.
 *  @throws InputError if the file cannot be written */
void writeObj(const geometry::TriangleMesh& mesh, const std::string& path);

}  // namespace endovascular_sim::vessel
