#pragma once

#include <Eigen/Core>

#include "contact/broad_phase/packet.h"
#include "contact/narrow_phase/edge_bounds.h"

namespace endovascular_sim::contact
{

/** Bounds of four reflex edges of the wall. */
class EdgeLanes
{
public:
  using Shape = EdgeBounds;

  /** An edge of the wire as the query. */
  struct Probe
  {
    /** @param a, b positions of the edge's nodes [m]
     *  @param taper radius at b minus radius at a [m]
     *  @param origin reference point of the packets [m]
     *  @param cutoff largest distance of interest [m]
     *  @param displacement bound of the wire's and the wall's displacement since the packets were built [m] */
    Probe(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper, const Eigen::Vector3d& origin,
          double cutoff, double displacement);

    Eigen::Vector3f begin, end;  ///< from the origin [m]
    Eigen::Vector3f direction;   ///< unit; zero for an edge without length
    float length;                ///< [m]
    float beyond;  ///< largest distance of the foot beyond an end for a contact between the ends: the taper [m]
    float cutoff, displacement;
  };

  void set(int lane, const EdgeBounds& bounds, const Eigen::Vector3d& origin);

  /** Positive where no contact within the cutoff lies between the ends of the wire's edge. In the lumen the point of
   *  contact on the axis lies in the reflex edge's normal cone. */
  EIGEN_STRONG_INLINE Packet4f culled(const Probe& probe) const
  {
    const PacketVectors to_begin = middles_.to(probe.begin);
    const PacketVectors to_end = middles_.to(probe.end);
    const Packet4f begin_height = to_begin.dot(normals_);
    const Packet4f end_height = to_end.dot(normals_);
    const Packet4f low = begin_height.min(end_height);
    const Packet4f high = begin_height.max(end_height).min(probe.cutoff);
    // Behind the reflex edge the cone does not apply: anything up to the cutoff counts.
    const Packet4f beside =
        ((high + kPacketSlack) * cone_slope_ + kPacketSlack).max(kPacketOpen * (kPacketSlack - low)).min(probe.cutoff);
    const Packet4f across = distanceApart(to_begin.dot(across_), to_end.dot(across_)) - beside;
    const Packet4f along = distanceApart(to_begin.dot(along_), to_end.dot(along_)) - beside - half_;
    const Packet4f middle = -to_begin.dot(probe.direction);
    const Packet4f reach = along_.dot(probe.direction).abs() * half_ + probe.beyond;
    return (low - probe.cutoff).max(across).max(along).max((-middle - reach).max(middle - reach - probe.length));
  }

private:
  /** Distance from zero to the interval between two coordinates; negative if the interval contains zero. */
  static EIGEN_STRONG_INLINE Packet4f distanceApart(const Packet4f& begin, const Packet4f& end)
  {
    return begin.min(end).max(-begin.max(end));
  }

  PacketVectors middles_;                   ///< [m]
  PacketVectors normals_, along_, across_;  ///< orthonormal
  Packet4f half_ = Packet4f::Zero();        ///< half lengths [m]
  Packet4f cone_slope_ = Packet4f::Zero();
};

using EdgePacket = Packet<EdgeLanes>;

}  // namespace endovascular_sim::contact
