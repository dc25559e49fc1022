#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "contact/wall/vertex_quadric.h"
#include "contact/wall/wall.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::contact
{

/** Smooth surface through the vertices of a wall (docs/CONTACT.md, "Smooth wall").
 *
 *  Every vertex has a quadric fitted to its neighbours. A point p of a triangle with barycentric coordinates b moves
 *  along the direction Σ b_i n_i, n_i the normals of the vertices, by the blend Σ w_i h_i of the distances h_i to the
 *  quadrics of the corners, w_i = b_i²/Σ b_j². On an edge both triangles give the same point: the surface is closed.
 * Its normal turns there by as much as the quadrics of the edge's ends disagree, in all not by more than a few degrees.
 * At a crease vertex, whose quadric does not represent its neighbours, the plane of every triangle replaces the
 * quadric: the normal jumps across the edges there. */
class SmoothWall
{
public:
  /** @param wall must outlive the object and remain unchanged */
  explicit SmoothWall(const Wall& wall);

  /** The same surface on a copy of the wall. */
  SmoothWall(const SmoothWall& other, const Wall& wall);
  SmoothWall(const SmoothWall&) = delete;
  SmoothWall& operator=(const SmoothWall&) = delete;

  /** A point of the surface. */
  struct Point
  {
    Eigen::Vector3d position;
    /** Derivatives of the position by the second and the third barycentric coordinate; the first one decreases. */
    Eigen::Matrix<double, 3, 2> tangents;
    Eigen::Vector3d normal;     ///< perpendicular to the tangents, towards the lumen, unit
    Eigen::Matrix3d curvature;  ///< mean of the quadrics' tensors in the tangent plane, positive where concave [1/m]
  };

  /** Point of the patch over a triangle. @param weights barycentric coordinates */
  Point at(int triangle, const Eigen::Vector3d& weights) const;

  /** Position alone, see at(). */
  Eigen::Vector3d positionAt(int triangle, const Eigen::Vector3d& weights) const;

  /** Bound of the distance between every point of the surface and the point of its triangle with the same barycentric
   *  coordinates [m]. It bounds the distances from the surface to the facets and from the facets to the surface. */
  double deviation() const { return deviation_; }
  double deviationOf(int triangle) const { return deviations_[triangle]; }  ///< the same of one triangle [m]

  /** Whether the surface over a triangle may contain a foot of a point: a closest point of the patch's surroundings.
   *  @param heights of the point over the planes of the triangle's slab [m]
   *  @param cutoff largest distance of interest [m] */
  bool mayHaveFoot(int triangle, const Eigen::Array4d& heights, double cutoff) const;

  bool isCrease(int vertex) const { return crease_[vertex] != 0; }
  /** Whether an edge ends at a crease, so that the normal may jump across it. */
  bool isSharp(int edge) const { return sharp_[edge] != 0; }
  /** Whether the surface may bulge into the lumen along a direction near an edge, by 1 µm over 2 mm or more. */
  bool mayBulge(int edge, const Eigen::Vector3d& along) const;
  double creaseShare() const;  ///< share of the vertices that are creases

  const Wall& wall() const { return wall_; }

private:
  void markCreases();
  void boundTilts();
  double boundOf(int triangle);
  /** Bounds over a part of a triangle [m]. */
  struct HeightBound
  {
    double whole;  ///< of the distance |h| to a corner's quadric
    double share;  ///< of its share w |h| of the displacement
  };
  HeightBound boundAt(int triangle, int corner, const std::array<Eigen::Vector3d, 3>& part) const;
  Eigen::Vector3d pointOf(int triangle, const Eigen::Vector3d& weights) const;
  Eigen::Vector3d direction(int triangle, const Eigen::Vector3d& weights) const;
  double displacement(int triangle, const Eigen::Vector3d& blend, const Eigen::Vector3d& point,
                      const Eigen::Vector3d& direction) const;

  const Wall& wall_;
  std::vector<VertexQuadric> quadrics_;
  std::vector<char> crease_;  ///< per vertex
  std::vector<char> sharp_;   ///< per edge
  std::vector<double> deviations_;
  std::vector<double> tilts_;  ///< per triangle: sine of the largest angle between its normal and those of its feet
  double deviation_ = 0.0;
};

/** Mesh that represents a smooth wall well: the mesh itself, or up to two interpolating subdivisions of it
 *  (geometry::normalSubdivision) where nine tenths of its dihedral angles are not below 24°, that of 15 facets around a
 *  tube. Its vertices remain. */
geometry::TriangleMesh refinedForSmoothWall(geometry::TriangleMesh mesh);

/** Triangulation of a smooth wall: every triangle is divided into parts², with all vertices on the surface. It is
 * closed as the wall's mesh is. @param parts of every edge */
geometry::TriangleMesh tessellate(const SmoothWall& smooth, int parts);

}  // namespace endovascular_sim::contact
