#pragma once

#include <array>

#include <Eigen/Core>

#include "contact/broad_phase/packet.h"
#include "contact/narrow_phase/edge_bounds.h"

namespace endovascular_sim::contact
{

/** Four reflex edges of the mesh side by side. */
class EdgePacket
{
public:
  /** @param origin from which it is seen [m]
   *  @param clear by how much wire and wall have to come closer before it counts [m] */
  void set(int lane, int wall_edge, const EdgeBounds& ball, const Eigen::Vector3d& origin, float clear);

  int index(int lane) const { return edges_[lane]; }

  /** An edge of the wire from which it is looked. */
  struct Place
  {
    /** @param a, b its ends [m]
     *  @param taper the radius at b minus that at a [m]
     *  @param limit distance up to which features are wanted [m]
     *  @param moved by which wire and wall have come closer [m] */
    Place(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper, const Eigen::Vector3d& origin, double limit,
          double moved);

    Eigen::Vector3f begin, end;  ///< from the origin [m]
    Eigen::Vector3f direction;   ///< unit; 0 without length
    float length;                ///< [m]
    float beyond;                ///< an end: how far off a cone may still touch between the ends [m]
    float limit, moved;
  };

  /** Positive where a ridge can touch the wire's edge nowhere between its ends within the limit. Inside the lumen that
   *  place lies above the ridge as seen along the ridge's normal, or nearly so. */
  EIGEN_STRONG_INLINE Packet4f hidden(const Place& place) const
  {
    const QuadVectors to_begin = middles_.to(place.begin);
    const QuadVectors to_end = middles_.to(place.end);
    const Packet4f begin_height = to_begin.dot(normals_);
    const Packet4f end_height = to_end.dot(normals_);
    const Packet4f low = begin_height.min(end_height);
    const Packet4f high = begin_height.max(end_height).min(place.limit);
    // Behind the ridge anything up to the limit will do.
    const Packet4f beside =
        ((high + kQuadSlack) * lean_ + kQuadSlack).max(kQuadOpen * (kQuadSlack - low)).min(place.limit);
    const Packet4f across = apart(to_begin.dot(across_), to_end.dot(across_)) - beside;
    const Packet4f along = apart(to_begin.dot(along_), to_end.dot(along_)) - beside - half_;
    const Packet4f middle = -to_begin.dot(place.direction);
    const Packet4f reach = along_.dot(place.direction).abs() * half_ + place.beyond;
    return (clear_ - place.moved)
        .max(low - place.limit)
        .max(across)
        .max(along)
        .max((-middle - reach).max(middle - reach - place.length));
  }

private:
  /** How far a segment's places lie off the middle at least, by those of its ends. */
  static EIGEN_STRONG_INLINE Packet4f apart(const Packet4f& begin, const Packet4f& end)
  {
    return begin.min(end).max(-begin.max(end));
  }

  QuadVectors middles_;                   ///< [m]
  QuadVectors normals_, along_, across_;  ///< unit, each ⟂ the others
  Packet4f half_ = Packet4f::Zero();      ///< length [m]
  Packet4f lean_ = Packet4f::Zero();
  Packet4f clear_ = Packet4f::Constant(kNever);
  std::array<int, kQuad> edges_{};
};

}  // namespace endovascular_sim::contact
