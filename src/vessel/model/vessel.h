#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::vessel
{

/** Vessel ready for simulation: checked mesh, centreline and provenance. */
struct Vessel
{
  geometry::TriangleMesh mesh;        ///< patient frame [m]
  CentrelineTree centreline;          ///< patient frame [m]; empty if not requested
  std::string source;                 ///< file or generator
  std::vector<std::string> notes;     ///< repairs and modifications, as text
  std::vector<std::string> warnings;  ///< unusual values of its file, each with key and likely unit
  std::vector<PlacedLesion> lesions;  ///< lesions of the anatomy, then added ones
};

}  // namespace endovascular_sim::vessel
