#pragma once

#include <string>

#include "geometry/mesh_distance.h"
#include "vessel/centreline/centreline.h"
#include "vessel/io/vtk_poly_data.h"

namespace endovascular_sim::vessel
{

/** Centreline tree of the lines of a VTK file, as VMTK, SlicerVMTK and SimVascular write them: paths from one end to
 * the others that share their begin, or pieces between the forks. What a line shares with an earlier one is dropped,
 * and its rest becomes a branch. The root is the first line if all lines begin there, else the line with the widest
 * free end.
 *  @param unit metres per unit of the file
 *  @param distance wall in the frame of the file; gives the radii where the file has none
 *  @param path names the file in errors
 *  @throws InputError for a file without lines, with too many lines or points, or with lines that do not meet */
CentrelineTree vtkCentreline(const VtkPolyData& data, double unit, const geometry::MeshDistance& distance,
                             const std::string& path);

}  // namespace endovascular_sim::vessel
