#pragma once

#include <array>

#include <Eigen/Core>

#include "contact/broad_phase/packet.h"
#include "contact/narrow_phase/triangle_slab.h"

namespace endovascular_sim::contact
{

/** Four triangles' prisms side by side. */
class TrianglePacket
{
public:
  /** @param origin from which it is seen [m]
   *  @param clear by how much wire and wall have to come closer before it counts [m] */
  void set(int lane, int triangle, const TriangleSlab& prism, const Eigen::Vector3d& origin, float clear);

  int index(int lane) const { return triangles_[lane]; }

  /** A point from which it is looked. */
  struct Place
  {
    /** @param limit distance up to which features are wanted [m]
     *  @param moved by which wire and wall have come closer [m] */
    Place(const Eigen::Vector3d& point, const Eigen::Vector3d& origin, double limit, double moved);

    Eigen::Vector3f from_origin;
    float limit, squared_limit, moved;
  };

  /** Positive where a triangle's point that is closest to the place can be no local minimum of the distance within the
   * limit. */
  EIGEN_STRONG_INLINE Packet4f hidden(const Place& place) const
  {
    const Packet4f height = over(0, place);
    const Packet4f one = over(1, place);
    const Packet4f two = over(2, place);
    const Packet4f three = over(3, place);
    const Packet4f beyond = -one.min(two).min(three) - kQuadSlack;
    // From the line along the nearest edge, and along the next one.
    const Packet4f least = one.abs().min(two.abs());
    const Packet4f edge = least.min(three.abs());
    const Packet4f corner = least.max(one.abs().max(two.abs()).min(three.abs()));
    const Packet4f up = height + kQuadSlack;
    const Packet4f aside = (edge - up * edge_slope_).min(corner - up * corner_slope_) - kQuadSlack;
    // Behind the plane anything will do.
    const Packet4f hidden =
        aside.max(beyond - up * edge_slope_.max(corner_slope_)).min(kQuadOpen * (height - kQuadSlack));
    const Packet4f border = hidden.max(height.square() + beyond.max(0.0F).square() - place.squared_limit);
    return (clear_ - place.moved).max(height.abs() - place.limit).max(beyond.min(border));
  }

private:
  EIGEN_STRONG_INLINE Packet4f over(int plane, const Place& place) const
  {
    return planes_[plane].normal.dot(place.from_origin) + planes_[plane].offset;
  }

  struct Planes
  {
    QuadVectors normal;
    Packet4f offset = Packet4f::Zero();  ///< [m]
  };

  std::array<Planes, 4> planes_;  ///< the triangles' own and those along their edges
  Packet4f edge_slope_ = Packet4f::Zero();
  Packet4f corner_slope_ = Packet4f::Zero();
  Packet4f clear_ = Packet4f::Constant(kNever);
  std::array<int, kQuad> triangles_{};
};

}  // namespace endovascular_sim::contact
