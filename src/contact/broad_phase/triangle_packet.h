#pragma once

#include <array>

#include <Eigen/Core>

#include "contact/broad_phase/packet.h"
#include "contact/narrow_phase/triangle_slab.h"

namespace endovascular_sim::contact
{

/** Slabs of four triangles. */
class TriangleLanes
{
public:
  using Shape = TriangleSlab;

  /** A query point. */
  struct Probe
  {
    /** @param origin reference point of the packets [m]
     *  @param cutoff largest distance of interest [m]
     *  @param displacement bound of the wire's and the wall's displacement since the packets were built [m] */
    Probe(const Eigen::Vector3d& point, const Eigen::Vector3d& origin, double cutoff, double displacement);

    Eigen::Vector3f from_origin;
    float cutoff, squared_cutoff, displacement;
  };

  void set(int lane, const TriangleSlab& slab, const Eigen::Vector3d& origin);

  /** Positive where the triangle's closest point to the probe can be no local minimum of the distance within the
   *  cutoff. */
  EIGEN_STRONG_INLINE Packet4f culled(const Probe& probe) const
  {
    const Packet4f height = heightOver(0, probe);
    const Packet4f one = heightOver(1, probe);
    const Packet4f two = heightOver(2, probe);
    const Packet4f three = heightOver(3, probe);
    const Packet4f beyond = -one.min(two).min(three) - kPacketSlack;
    // Distances from the line along the nearest edge, and from the second nearest.
    const Packet4f least = one.abs().min(two.abs());
    const Packet4f edge = least.min(three.abs());
    const Packet4f corner = least.max(one.abs().max(two.abs()).min(three.abs()));
    const Packet4f up = height + kPacketSlack;
    const Packet4f aside = (edge - up * edge_slope_).min(corner - up * corner_slope_) - kPacketSlack;
    // The cones bound points in front of the triangle's plane only.
    const Packet4f outside_cones =
        aside.max(beyond - up * edge_slope_.max(corner_slope_)).min(kPacketOpen * (height - kPacketSlack));
    const Packet4f border = outside_cones.max(height.square() + beyond.max(0.0F).square() - probe.squared_cutoff);
    return (height.abs() - probe.cutoff).max(beyond.min(border));
  }

private:
  EIGEN_STRONG_INLINE Packet4f heightOver(int plane, const Probe& probe) const
  {
    return planes_[plane].normal.dot(probe.from_origin) + planes_[plane].offset;
  }

  struct Planes
  {
    PacketVectors normal;
    Packet4f offset = Packet4f::Zero();  ///< height of the origin [m]
  };

  std::array<Planes, 4> planes_;  ///< in the order of TriangleSlab
  Packet4f edge_slope_ = Packet4f::Zero();
  Packet4f corner_slope_ = Packet4f::Zero();
};

using TrianglePacket = Packet<TriangleLanes>;

}  // namespace endovascular_sim::contact
