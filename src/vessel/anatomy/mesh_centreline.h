#pragma once

#include <string>

#include <Eigen/Geometry>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Centreline of a mesh from an anatomy file, such as the one that vessel_segment or vessel_prepare writes beside the
 * mesh, or from the lines of a VTK file (.vtp, .vtk) of VMTK. An anatomy brings the names of the branches.
 *  @param file anatomy file with its own unit, or VTK file in the unit of the mesh
 *  @param unit metres per unit of a VTK file
 *  @param transform from the frame of the file to that of the mesh
 *  @param mesh wall of the vessel [m]
 *  @throws InputError if the file is invalid, or belongs to another vessel: more than one point in twenty of a branch
 * lies outside of the mesh. Points within a radius of an end are not judged: the mesh is cut there */
CentrelineTree readMeshCentreline(const std::string& file, double unit, const Eigen::Isometry3d& transform,
                                  const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::vessel
