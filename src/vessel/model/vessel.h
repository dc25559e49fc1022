#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::vessel
{

/** A vessel ready for use: a checked mesh, its centreline, and where both came from. */
struct Vessel
{
  geometry::TriangleMesh mesh;        ///< patient frame [m]
  CentrelineTree centreline;          ///< patient frame [m]; empty when it was not asked for
  std::string source;                 ///< file or generator
  std::vector<std::string> notes;     ///< what was repaired or changed, for people
  std::vector<PlacedLesion> lesions;  ///< of the anatomy, then those that were put on it
};

}  // namespace endovascular_sim::vessel
