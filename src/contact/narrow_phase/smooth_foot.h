#pragma once

#include <Eigen/Core>

#include "contact/narrow_phase/narrow_phase.h"
#include "contact/wall/smooth_wall.h"

namespace endovascular_sim::contact
{

/** Foot of a point on a smooth wall: a local minimum of the distance. The offset is along the surface's normal; on an
 *  edge or a vertex it lies in the cone of normals. The normal is the offset's direction, which is the gradient of the
 *  signed distance. */
struct SmoothFoot
{
  int triangle = -1;                                   ///< patch that contains the foot
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();   ///< its barycentric coordinates
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< towards the lumen, unit
  Eigen::Matrix3d curvature =
      Eigen::Matrix3d::Zero();  ///< as SmoothWall::Point; zero on a sharp edge or a crease [1/m]
  double height = 0.0;          ///< signed distance, negative behind the wall [m]
  std::int64_t id = 0;          ///< as Feature::id
};

/** Search of feet on a smooth wall by walking over its patches. */
class SmoothFootSearch
{
public:
  /** @param wall must outlive the object */
  explicit SmoothFootSearch(const SmoothWall& wall) : smooth_(wall), wall_(wall.wall()) {}

  /** The foot that the walk reaches from the patch over a facet, begun at the facet's closest point. Steps of a
   *  quasi-Newton method cross edges where the next step leads on, follow them while both sides push back, and end at a
   *  vertex if all of its edges and triangles do. A walk never ends farther from the point than it began.
   *  @param triangle the facet */
  SmoothFoot walk(const Eigen::Vector3d& point, int triangle) const;

  /** A walk from an earlier foot, of a nearby point. */
  SmoothFoot walk(const Eigen::Vector3d& point, const SmoothFoot& from) const;

private:
  struct Walker;

  const SmoothWall& smooth_;
  const Wall& wall_;
};

/** Feature of the wall for a point of the wire from its foot; the gap is measured from the axis, edge and parameter are
 *  unset. */
NarrowPhase::Minimum minimumOf(const SmoothFoot& foot, const Eigen::Vector3d& point);

/** Radius of curvature of the smooth wall across the wire minus the wire's radius; infinite where it is not concave.
 *  @param wire_edge direction of the wire */
double clearanceRadiusOf(const SmoothFoot& foot, const Eigen::Vector3d& wire_edge, double radius);

}  // namespace endovascular_sim::contact
