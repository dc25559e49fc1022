#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::contrast
{

/** Vertex on the line between two earlier vertices, (1 − weight)·from + weight·to. */
struct CutVertex
{
  int from = 0;
  int to = 0;
  double weight = 0.0;
};

/** Part of a triangle of the wall that belongs to one cell, oriented like the triangle. */
struct WallPiece
{
  Eigen::Vector3i corners;  ///< those of the triangle where no plane cuts it
  int part = 0;             ///< of the lumen
  int triangle = 0;         ///< index in the mesh
};

/** Triangle of a cap between two parts of the lumen; its normal points from `plus` to `minus`. */
struct LumenCap
{
  Eigen::Vector3i corners;
  int plus = 0;
  int minus = 0;
};

/** Lumen of a vessel, divided by planes normal to its centreline.
 *
 *  The parts fill the lumen without gap or overlap: walls of a part and its caps, + where it is `plus` and reversed
 * where it is `minus`, form a closed surface. New vertices are combinations of those of the mesh, so that the parts
 * follow a wall that moves. Usually a part is a cell. A cell without a lumen of its own shares the part of a neighbour:
 * it ends inside of its parent's lumen, or planes cross there. */
struct LumenCells
{
  std::size_t mesh_vertices = 0;           ///< vertices 0 to mesh_vertices − 1 are those of the mesh
  std::vector<Eigen::Vector3i> triangles;  ///< those of the mesh
  std::vector<CutVertex> cuts;             ///< the other vertices
  std::vector<WallPiece> walls;            ///< ascending index of the triangle
  std::vector<LumenCap> caps;
  std::vector<int> part_of_cell;  ///< for each cell: its part
  std::vector<double> volumes;    ///< of the cells [m³]; cells of one part share its volume by length and section
  std::vector<double> of_part;    ///< for each cell: share of its part's volume
  std::vector<double> mouths;     ///< for each branch: arc length at which its lumen begins [m]; NaN: it has none
  std::size_t parts = 0;

  /** True for a mesh of the same triangles, whose vertices may have moved. */
  bool fits(const geometry::TriangleMesh& mesh) const;

  /** Positions of all vertices. @param vertices those of the mesh [m] */
  std::vector<Eigen::Vector3d> place(const std::vector<Eigen::Vector3d>& vertices) const;

  /** Volumes of the parts with the given positions of all vertices [m³]. */
  std::vector<double> partVolumes(const std::vector<Eigen::Vector3d>& positions) const;

  /** Concentrations of the parts: the mean over their cells by volume, which keeps the mass.
   *  @param cells one value per cell */
  std::vector<double> partConcentrations(const std::vector<double>& cells) const;
};

}  // namespace endovascular_sim::contrast
