#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/prepare/pieces.h"
#include "vessel/prepare/prepare_report.h"

namespace endovascular_sim::vessel
{

/** How a vessel is to be prepared. */
struct PrepareOptions
{
  double max_distance = 2e-4;  ///< of the result's wall from the input's, both ways [m]
  double voxel = 0.0;          ///< [m]; 0: two thirds of max_distance
  double bridge = 0.0;         ///< loose pieces closer than this to the vessel are joined to it by a tube [m]
  std::vector<Plug> plugs;     ///< discs that stop up the openings of a wall with a thickness
  bool hollow = false;         ///< the lumen is the largest hollow inside of the wall, not what its outside encloses
  bool smooth = false;         ///< take the edges of facets out, within max_distance
  int smoothing_rounds = 30;
  int facets_around = 24;         ///< of the result, around every lumen
  double longest_facet = 2.5e-3;  ///< [m]
  std::vector<std::string>
      open;               ///< ends to be opened: "all", "largest", a count, a branch, or "x,y,z" [m] near an end
  double cut_back = 1.0;  ///< from the tip of an end to its cut, in radii of the lumen
};

/** A vessel ready for a scene: closed but for the ends that were opened, two-manifold, outward, in one piece. */
struct PreparedVessel
{
  geometry::TriangleMesh mesh;  ///< [m]
  CentrelineTree centreline;    ///< of the closed vessel [m]
  PrepareReport report;
};

/** Called when a stage begins, with its name. */
using Progress = std::function<void(const std::string& stage)>;

/** Unites, closes, re-meshes, smooths, opens and measures a vessel.
 *  @param input any triangles [m]: pieces that overlap, holes, faces turned either way
 *  @param source names the mesh in errors
 *  @throws InputError for options out of range, a mesh that shuts nothing off, an end that does not exist */
PreparedVessel prepareVessel(const geometry::TriangleMesh& input, const std::string& source,
                             const PrepareOptions& options, const Progress& progress = {});

}  // namespace endovascular_sim::vessel
