#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vessel/io/mesh_builder.h"

namespace endovascular_sim::vessel
{

/** Cells of one kind of a VTK file, each a list of point indices. */
struct VtkCells
{
  std::vector<long long> points;  ///< indices of all cells, one cell after the other
  std::vector<std::size_t> ends;  ///< end of each cell in `points`

  std::size_t size() const { return ends.size(); }
  /** Point indices of a cell. */
  std::vector<long long> cell(std::size_t k) const;
};

/** Polygonal data of a VTK file, XML (.vtp) or legacy (.vtk): what surfaces and centrelines need of it. */
struct VtkPolyData
{
  std::vector<Eigen::Vector3d> points;  ///< [units of the file]
  VtkCells lines;
  VtkCells strips;  ///< triangle strips
  VtkCells polygons;
  std::vector<double> radii;  ///< point array MaximumInscribedSphereRadius or Radius [units of the file]; empty: none
  std::string space;          ///< header or field that names the coordinate system, as 3D Slicer writes it
};

/** Reads a VTK file of polygonal data by its extension, .vtp or .vtk.
 *  @param path names the file in errors
 *  @throws InputError for a file that is damaged or of another kind of data */
VtkPolyData readVtkPolyData(std::string_view bytes, const std::string& path);

/** True for the name of a VTK file, .vtp or .vtk. */
bool isVtkFile(const std::string& path);

/** Adds points, polygons and triangle strips to a mesh. */
void addSurface(const VtkPolyData& data, MeshBuilder& mesh);

/** True for the name of an array that holds radii of a centreline. */
bool namesRadii(const std::string& array);

}  // namespace endovascular_sim::vessel
