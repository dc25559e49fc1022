#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"
#include "contact/narrow_phase/wall_bounds.h"
#include "contact/wall/wall.h"
#include "geometry/closest_points_on_segments.h"

namespace endovascular_sim::contact
{

/** Kind of a feature of the wall; Feature::id is 3·index + kind. */
enum class FeatureKind
{
  kFace = 0,
  kEdge = 1,
  kVertex = 2,
};

inline std::int64_t featureId(int index, FeatureKind kind)
{
  return std::int64_t{3} * index + static_cast<int>(kind);
}

inline FeatureKind kindOf(const Feature& feature)
{
  return static_cast<FeatureKind>(feature.id % 3);
}

/** Exact local minima of the distance between the wire's axis and single features of the wall.
 *
 *  A node of the wire is tested against a triangle, an edge of the wire against a reflex edge of the wall. A local
 *  minimum passes the normal-cone test: the offset from the wall lies in the cone of normals of the feature. */
class NarrowPhase
{
public:
  /** Both arguments must outlive the object. @param bounds bounds of the wall's features */
  NarrowPhase(const Wall& wall, const WallBounds& bounds) : wall_(wall), bounds_(bounds) {}

  /** A local minimum of the distance. */
  struct Minimum
  {
    Feature feature;        ///< its gap is measured from the axis; edge, friction, stiffness and clearance are unset
    double distance = 0.0;  ///< from the axis to the feature [m]
    /** Whether the point of the axis lies behind the feature. It is outside the lumen only if the globally nearest
     *  feature confirms it. */
    bool outside = false;
  };

  /** Closest feature of a point on one triangle.
   *  @param cutoff largest distance of interest [m]
   *  @param minimum receives the feature if there is one; its parameter remains unset
   *  @return whether the closest point of the triangle is a local minimum of the distance within the cutoff */
  bool faceFeature(const Eigen::Vector3d& point, int triangle, double cutoff, Minimum& minimum) const;

  /** An edge of the wire. */
  struct WireEdge
  {
    /** @param taper radius at @p b minus radius at @p a [m] */
    WireEdge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper);

    Eigen::Vector3d begin, end;                    ///< positions of its nodes [m]
    double taper;                                  ///< [m]
    std::optional<geometry::TaperedSegment> cone;  ///< where it tapers

    Eigen::Vector3d pointAt(double parameter) const { return begin + parameter * (end - begin); }
  };

  /** Closest feature of an edge of the wire, off its nodes, on one reflex edge of the wall.
   *  @param cutoff, minimum, return value as for faceFeature */
  bool edgeEdgeFeature(const WireEdge& wire_edge, int wall_edge, double cutoff, Minimum& minimum) const;

  /** Radius of curvature of the wall across the wire minus the wire's radius; infinite where the wall is not concave
   *  there and for edges and vertices [m].
   *  @param wire_edge vector between the nodes of the feature's edge [m]
   *  @param radius radius of the wire at the feature [m] */
  double clearanceRadius(const Feature& feature, const Eigen::Vector3d& wire_edge, double radius) const;

private:
  Eigen::Vector3d closestPointOnEdge(const Eigen::Vector3d& point, int wall_edge) const;
  bool vertexIsMinimum(int vertex, const Eigen::Vector3d& offset) const;
  bool borderFeature(int triangle, int border_edge, int border_vertex, const Eigen::Vector3d& offset,
                     Minimum& minimum) const;

  const Wall& wall_;
  const WallBounds& bounds_;
};

}  // namespace endovascular_sim::contact
