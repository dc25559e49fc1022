#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "flow/body/obstruction.h"
#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::flow
{

/** Lumens of the lesions of a vessel in its present wall, which balloons and stents open: equal areas of
 *  cross-sections normal to the centreline, every half millimetre, as vessel::lumenDiameter() measures them in the
 * whole wall.
 *
 *  The triangles near the lesions are picked once. They hold lumens of up to twice the healthy diameter. */
class LesionLumens
{
public:
  /** @param wall initial mesh [m]
   *  @param centreline of the vessel with its lesions */
  LesionLumens(const geometry::TriangleMesh& wall, const vessel::CentrelineTree& centreline,
               const std::vector<vessel::PlacedLesion>& lesions);

  /** Profiles of the lesions, in their order.
   *  @param vertices of the present wall, whose triangles are those of the initial one [m] */
  const std::vector<LumenProfile>& measure(const std::vector<Eigen::Vector3d>& vertices);

private:
  /** Plane across the lumen. */
  struct Section
  {
    Eigen::Vector3d centre, tangent;  // the tangent is the plane's normal
    Eigen::Vector3d u, v;             // of the first ray, and 90° counter-clockwise of it
  };

  /** Wall around a lesion. */
  struct Region
  {
    std::vector<Section> sections;
    std::vector<std::size_t> vertices;                // indices in the mesh
    std::vector<std::size_t> nearest;                 // for each of them: the nearest section of the initial wall
    std::vector<std::array<std::size_t, 3>> corners;  // triangles, as indices into vertices
  };

  static Region regionOf(const geometry::TriangleMesh& wall, const vessel::PlacedLesion& lesion,
                         std::vector<Section> sections);
  void measure(const Region& region, const std::vector<Eigen::Vector3d>& vertices, std::vector<double>& areas);
  void countSections(const Region& region, const std::vector<Eigen::Vector3d>& vertices);
  void cut(const Section& section, const std::array<const Eigen::Vector3d*, 3>& corners, std::vector<double>& reaches);

  std::vector<Region> regions_;
  std::vector<LumenProfile> lumens_;
  std::vector<Eigen::Vector2d> rays_;         // directions in a section
  std::vector<std::size_t> behind_;           // for each vertex of a region: number of sections that it lies beyond
  std::vector<std::vector<double>> reaches_;  // lengths of the rays of each section [m]
};

}  // namespace endovascular_sim::flow
