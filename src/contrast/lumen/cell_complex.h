#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "contrast/lumen/lumen_cells.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::contrast
{

/** Plane with its normal. */
struct CutPlane
{
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit
};

/** Closed curve in which a plane cuts the surface of a region, around a point. */
struct Section
{
  /** Edge of the surface from the side behind the plane to that before it. */
  struct Crossing
  {
    int behind = 0;
    int before = 0;
  };
  std::vector<Crossing> crossings;   ///< counter-clockwise about the normal
  std::vector<Eigen::Vector3d> rim;  ///< points on these edges, in the plane [m]
  double reach = 0.0;                ///< largest distance from the plane's point [m]

  /** True if the curve goes around a point of the plane. */
  bool surrounds(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
};

/** Lumen divided into regions, each with a closed surface of triangles: wall, and caps that it shares with other
 *  regions. A cut divides one region, and splits all triangles at the edges that it crosses, so that no gap opens
 *  between any regions. Where the lumen has a handle, two or more curves together divide it: a curve that does not is
 * kept, and becomes a cap when a later cut leaves different regions on its sides. */
class CellComplex
{
public:
  /** Triangle between two regions, or of the wall. */
  struct Face
  {
    Eigen::Vector3i corners;
    int plus = 0;       ///< region out of which the normal points
    int minus = -1;     ///< region into which it points; −1: outside of the lumen
    int triangle = -1;  ///< of the mesh; −1 in a cap
  };

  /** One region, 0. @param mesh closed, outward oriented wall */
  explicit CellComplex(const geometry::TriangleMesh& mesh);

  /** Smallest curve about the point of a plane in which it cuts the surface of a region; empty if the point is not
   *  inside of it. */
  std::optional<Section> section(int region, const CutPlane& plane);

  /** Regions on both sides of a cut; one of them keeps the number of the divided one. */
  struct Sides
  {
    int behind = 0;
    int before = 0;
  };

  /** Divides a region along a section of it, and the earlier ones that wait.
   *  @return empty if they do not divide the surface: a handle of the lumen; this section waits, too, unless it crosses
   *          one that waits */
  std::optional<Sides> cut(int region, const CutPlane& plane, const Section& section);

  /** Region inside of the wall at a vertex of the mesh. */
  int regionAt(int vertex) const;

  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<CutVertex>& cuts() const { return cuts_; }
  std::size_t regions() const { return faces_of_region_.size(); }

private:
  struct Split
  {
    int low, high, vertex;
  };

  /** Curve on the surface of a region that did not divide it. */
  struct Ring
  {
    int region;
    std::vector<int> vertices;  ///< consecutive, counter-clockwise about the normal of its plane
  };

  static bool isBefore(const Split& a, const Split& b);
  bool touches(int face, int region) const;
  Eigen::Vector3i outward(int face, int region) const;
  void compact(int region);
  int addVertex(const Section::Crossing& crossing, const CutPlane& plane);
  std::vector<Split> splitEdges(const Section& section, const CutPlane& plane, std::vector<int>& ring);
  void splitFace(int face, const std::vector<Split>& splits);
  void append(const Face& face);
  int neighbour(int face, int region, int a, int b) const;
  bool crossesRing(const Section& section) const;
  std::vector<std::pair<int, int>> barriersOf(int region, const std::vector<int>& ring) const;
  std::optional<Sides> divide(int region, const std::vector<int>& ring);
  int regionBefore(int a, int b, const Sides& sides) const;
  void capRings(int region, const Sides& sides);
  void addCaps(const std::vector<int>& ring, std::size_t first, std::size_t last, const Sides& sides);

  std::vector<Eigen::Vector3d> positions_;
  std::size_t mesh_vertices_;
  std::vector<CutVertex> cuts_;
  std::vector<Face> faces_;
  std::vector<std::vector<int>> faces_of_region_;  ///< with some that are no longer its faces
  std::vector<std::vector<int>> faces_at_vertex_;  ///< with some that no longer touch it
  std::vector<Ring> rings_;                        ///< that wait
  std::vector<int> mark_;                          ///< of faces, while a region is divided
  int marks_ = 0;
};

}  // namespace endovascular_sim::contrast
