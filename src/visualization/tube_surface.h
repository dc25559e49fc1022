#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "visualization/force_colour.h"

namespace endovascular_sim::visualization
{

/** Colour with an opacity in [0, 1]. */
struct TranslucentColour
{
  Colour colour;
  float opacity = 1.0F;
};

/** Indexed triangles with a normal and a colour per vertex, for smooth shading. The buffers keep their capacity. */
struct Surface
{
  std::vector<Eigen::Vector3f> positions;  ///< [m]
  std::vector<Eigen::Vector3f> normals;    ///< unit, outward
  std::vector<TranslucentColour> colours;
  std::vector<std::uint32_t> triangles;  ///< three vertices each, counter-clockwise seen from outside

  void clear();
};

/** Centreline of a tube. All lists have the same length. */
struct TubeAxis
{
  std::vector<Eigen::Vector3d> points;     ///< [m]
  std::vector<double> radii;               ///< [m]
  std::vector<TranslucentColour> colours;  ///< of the rings

  void clear();
  void add(const Eigen::Vector3d& point, double radius, const TranslucentColour& colour);
};

/** Builds smooth tubes with a fixed number of sides. */
class TubeBuilder
{
public:
  /** @param sides number of vertices of a ring, at least 3; fewer count as 3 */
  explicit TubeBuilder(int sides);

  int sides() const { return static_cast<int>(circle_.size()); }

  /** Appends the surface of a tube: a ring per point, and a flat disc at each end.
   *
   *  Rings are normal to the bisector of the adjacent segments. Their orientation is transported by projection, so that
   *  the tube does not twist. A radius is constant in the normals: they are exact for cylinders.
   *  @param axis finite points and radii (problemOfTube()); coinciding adjacent points are skipped. Nothing is appended
   *         for fewer than two distinct points */
  void append(const TubeAxis& axis, Surface& surface);

private:
  void appendRing(const Eigen::Vector3d& centre, const Eigen::Vector3d& tangent, std::size_t point,
                  const TubeAxis& axis, Surface& surface);
  void appendDisc(std::size_t point, const Eigen::Vector3d& outward, std::uint32_t ring, bool is_end,
                  const TubeAxis& axis, Surface& surface);

  std::vector<Eigen::Vector2f> circle_;  ///< cosine and sine of each side
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();
  std::vector<std::size_t> kept_;  ///< points without coinciding ones
};

/** Reason why a tube cannot be drawn; nothing for a valid one.
 *  @return null, or "empty", "inconsistent lengths", "not finite" or "negative radius" */
const char* problemOfTube(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& radii);

}  // namespace endovascular_sim::visualization
