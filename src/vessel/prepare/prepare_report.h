#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/surface_samples.h"
#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/prepare/pieces.h"
#include "vessel/repair/hole_closing.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{

/** Numbers of a mesh, before or after. */
struct MeshNumbers
{
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  double area = 0.0;   ///< [m²]
  MeshReport defects;  ///< with volume and genus, which mean little while the mesh has defects
};

MeshNumbers numbersOf(const geometry::TriangleMesh& mesh);

/** A piece that is not connected with the vessel. */
struct LoosePiece
{
  double volume = 0.0;                              ///< [m³]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< next to the vessel [m]
  double gap = 0.0;                                 ///< from the vessel [m]
};

/** Narrow spaces between walls, by samples of the input. */
struct NarrowGaps
{
  int kept = 0;                                            ///< samples where the space is there still
  int closed = 0;                                          ///< samples where it is not
  double widest_closed = 0.0;                              ///< [m]
  Eigen::Vector3d closed_place = Eigen::Vector3d::Zero();  ///< of the widest closed one [m]
  double narrowest_kept = 0.0;                             ///< [m], 0 without any
};

/** The inscribed radius at a point of the centreline, in the united input and in the result. */
struct RadiusChange
{
  int branch = 0;
  double arc = 0.0;     ///< from the branch's beginning [m]
  double before = 0.0;  ///< [m]
  double after = 0.0;   ///< [m]
};

/** An end that was opened. */
struct Opening
{
  std::string end;                                     ///< name of the branch
  Eigen::Vector3d place = Eigen::Vector3d::Zero();     ///< of the plane on the centreline [m]
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  ///< unit
  double radius = 0.0;                                 ///< of the centreline there [m]
};

/** What preparation changed, and by how much. */
struct PrepareReport
{
  std::string source;
  double voxel = 0.0;         ///< [m]
  double max_distance = 0.0;  ///< as stated [m]
  bool hollow = false;        ///< the lumen is a hollow of the input
  MeshNumbers before;
  MeshNumbers after;
  std::vector<ClosedHole> holes;
  std::vector<Gap> bridges;
  std::vector<LoosePiece> dropped;      ///< pieces of a size worth a word
  int crumbs = 0;                       ///< pieces below that, dropped
  double crumb_volume = 0.0;            ///< all of them [m³]
  std::vector<Eigen::Vector3d> parted;  ///< where touching sheets were parted by a voxel [m]
  geometry::Deviation input_to_result;  ///< from the input's outer wall
  geometry::Deviation result_to_input;  ///< from the result, lids and bridges left out
  double inner_area = 0.0;    ///< of the input's walls that are not the lumen's: buried, or outside of a hollow [m²]
  double lid_area = 0.0;      ///< of the result over closed holes and bridges [m²]
  double largest_move = 0.0;  ///< of a vertex by smoothing [m]
  NarrowGaps gaps;
  std::vector<RadiusChange> radii;
  std::vector<Opening> openings;
  int rims = 0;  ///< of the result: as many as openings

  /** Whether both distances keep what was stated. */
  bool withinDistance() const;

  /** Everything for people, in millimetres. */
  std::string text(const CentrelineTree& tree) const;

  /** Everything for programs, in SI units, with the centreline. */
  std::string json(const CentrelineTree& tree) const;
};

}  // namespace endovascular_sim::vessel
