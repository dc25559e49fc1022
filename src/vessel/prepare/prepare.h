#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/prepare/opening_plugs.h"
#include "vessel/prepare/prepare_report.h"

namespace endovascular_sim::vessel
{

/** Options of the mesh preparation. */
struct PrepareOptions
{
  double max_distance = 2e-4;  ///< tolerance of the distance between input and result, in both directions [m]
  double voxel = 0.0;          ///< edge of a voxel [m]; 0 selects two thirds of max_distance
  double bridge = 0.0;         ///< largest gap to a loose component that is bridged by a tube [m]
  std::vector<Plug> plugs;     ///< plugs of the openings of a thick wall
  bool hollow = false;         ///< true: the lumen is the largest cavity inside a thick wall
  bool smooth = false;         ///< smooth the facets within max_distance
  int smoothing_rounds = 30;
  int facets_around = 24;         ///< facets of the result around every lumen
  double longest_facet = 2.5e-3;  ///< longest edge of the result [m]
  /** Selectors of the ends to open: "all", "largest", a count, a branch, or "x,y,z" [m] near an end. */
  std::vector<std::string> open;
  double cut_back = 1.0;   ///< distance from the tip of an end to its cut, in radii of the lumen
  bool centreline = true;  ///< false: no centreline is extracted, and no end can be opened
  /** false: of the comparisons with the input, the report holds the distances from the result to the input only. */
  bool full_report = true;
};

/** Vessel ready for a scene: one connected, outward oriented two-manifold, closed except for the opened ends. */
struct PreparedVessel
{
  geometry::TriangleMesh mesh;  ///< [m]
  CentrelineTree centreline;    ///< centreline of the closed vessel [m]
  PrepareReport report;
};

/** Callback at the beginning of every stage, with the stage's name. */
using Progress = std::function<void(const std::string& stage)>;

/** Prepares a vessel: union, hole closing, remeshing, smoothing, opening of ends, measurement.
 *  @param input triangle soup of any orientation [m], with overlapping components and holes
 *  @param source name of the mesh in errors
 *  @throws InputError for invalid options, a mesh that encloses no volume, or an unknown end */
PreparedVessel prepareVessel(const geometry::TriangleMesh& input, const std::string& source,
                             const PrepareOptions& options, const Progress& progress = {});

}  // namespace endovascular_sim::vessel
