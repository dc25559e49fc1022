#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/surface_samples.h"
#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/prepare/component_bridges.h"
#include "vessel/repair/hole_closing.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{

/** Size and defects of a mesh. */
struct MeshNumbers
{
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  double area = 0.0;   ///< surface area [m²]
  MeshReport defects;  ///< defects; volume and genus are meaningful only without defects
};

MeshNumbers numbersOf(const geometry::TriangleMesh& mesh);

/** Component that is not connected to the vessel. */
struct LoosePiece
{
  double volume = 0.0;                                 ///< [m³]
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< point nearest to the vessel [m]
  double gap = 0.0;                                    ///< distance from the vessel [m]
};

/** Narrow gaps between walls, by samples of the input. */
struct NarrowGaps
{
  int kept = 0;                                               ///< samples in gaps that the result retains
  int closed = 0;                                             ///< samples in gaps that the result has closed
  double widest_closed = 0.0;                                 ///< width of the widest closed gap [m]
  Eigen::Vector3d closed_location = Eigen::Vector3d::Zero();  ///< location of the widest closed gap [m]
  double narrowest_kept = 0.0;                                ///< width of the narrowest retained gap [m]; 0 if none
};

/** Inscribed radius at a point of the centreline, in the union of the input and in the result. */
struct RadiusChange
{
  int branch = 0;
  double arc = 0.0;     ///< arc length from the start of the branch [m]
  double before = 0.0;  ///< radius in the union [m]
  double after = 0.0;   ///< radius in the result [m]
};

/** Opened end. */
struct Opening
{
  std::string end;                                     ///< name of the branch
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< intersection of plane and centreline [m]
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  ///< unit normal of the plane
  double radius = 0.0;                                 ///< radius of the lumen at the plane [m]
};

/** Report of the changes made by preparation. */
struct PrepareReport
{
  std::string source;
  double voxel = 0.0;         ///< edge of a voxel [m]
  double max_distance = 0.0;  ///< distance tolerance [m]
  bool hollow = false;        ///< true if the lumen is a cavity of the input
  MeshNumbers before;
  MeshNumbers after;
  std::vector<ClosedHole> holes;
  std::vector<Gap> bridges;
  std::vector<LoosePiece> dropped;                ///< dropped components
  int crumbs = 0;                                 ///< number of dropped components of negligible volume
  double crumb_volume = 0.0;                      ///< total volume of the crumbs [m³]
  std::vector<Eigen::Vector3d> separated_sheets;  ///< locations where touching sheets were separated by a voxel [m]
  geometry::Deviation input_to_result;            ///< distances from the input's outer wall
  geometry::Deviation result_to_input;            ///< distances from the result, without lids and bridges
  double inner_area = 0.0;                        ///< area of the input's walls that do not bound the lumen [m²]
  double lid_area = 0.0;                          ///< area of the result on lids and bridges [m²]
  double largest_move = 0.0;                      ///< largest displacement of a vertex by smoothing [m]
  NarrowGaps gaps;
  std::vector<RadiusChange> radii;
  std::vector<Opening> openings;
  int rims = 0;  ///< number of boundary loops of the result; equals the number of openings

  /** True if the distances in both directions are within the tolerance. */
  bool withinDistance() const;

  /** Human-readable report, in millimetres. */
  std::string text(const CentrelineTree& tree) const;

  /** JSON report in SI units, including the centreline. */
  std::string json(const CentrelineTree& tree) const;
};

}  // namespace endovascular_sim::vessel
