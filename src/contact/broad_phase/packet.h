#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::contact
{

// Packets of four nearby features of the wall, tested together in single precision relative to a nearby origin. The
// tests cull conservatively: their tolerance kPacketSlack exceeds the rounding error for points up to 0.1 m from the
// origin and walls of up to 1 m.

constexpr int kPacketSize = 4;
using Packet4f = Eigen::Array<float, kPacketSize, 1>;

constexpr float kPacketSlack = 1e-6F;                                    ///< m
constexpr float kPacketOpen = 1e30F;                                     ///< slope of an unbounded cone
constexpr float kNeverReached = std::numeric_limits<float>::infinity();  ///< clearance of an empty lane [m]

/** A vector per lane. */
struct PacketVectors
{
  Packet4f x = Packet4f::Zero();
  Packet4f y = Packet4f::Zero();
  Packet4f z = Packet4f::Zero();

  EIGEN_STRONG_INLINE Packet4f dot(const Eigen::Vector3f& v) const { return x * v.x() + y * v.y() + z * v.z(); }
  EIGEN_STRONG_INLINE Packet4f dot(const PacketVectors& v) const { return x * v.x + y * v.y + z * v.z; }
  /** Differences between another point and these points. */
  EIGEN_STRONG_INLINE PacketVectors to(const Eigen::Vector3f& v) const { return {v.x() - x, v.y() - y, v.z() - z}; }

  void set(int lane, const Eigen::Vector3d& v)
  {
    x[lane] = static_cast<float>(v.x());
    y[lane] = static_cast<float>(v.y());
    z[lane] = static_cast<float>(v.z());
  }
};

/** Four features of the wall with their indices and clearances.
 *  @tparam Lanes geometry of the features: types Shape (of one feature) and Probe (the query, with a displacement), a
 *  function set(lane, shape, origin), and culled(probe), positive where a feature can be no contact */
template <class Lanes>
class Packet
{
public:
  using Probe = typename Lanes::Probe;

  /** @param origin reference point of the packet [m]
   *  @param clearance displacement of wire and wall below which the feature is culled [m] */
  void set(int lane, int index, const typename Lanes::Shape& shape, const Eigen::Vector3d& origin, float clearance)
  {
    lanes_.set(lane, shape, origin);
    clearance_[lane] = clearance;
    indices_[lane] = index;
  }

  int index(int lane) const { return indices_[lane]; }

  /** Positive in the lanes that are culled. */
  EIGEN_STRONG_INLINE Packet4f culled(const Probe& probe) const
  {
    return (clearance_ - probe.displacement).max(lanes_.culled(probe));
  }

private:
  Lanes lanes_;
  Packet4f clearance_ = Packet4f::Constant(kNeverReached);
  std::array<int, kPacketSize> indices_{};
};

/** Visits the indices of the features that are not culled, in the order of the packets. */
template <class Lanes, class Visit>
EIGEN_STRONG_INLINE void forEachCandidate(const std::vector<Packet<Lanes>>& packets, const typename Lanes::Probe& probe,
                                          Visit&& visit)
{
  for (const Packet<Lanes>& packet : packets)
  {
    const Packet4f culled = packet.culled(probe);
    for (int lane = 0; lane < kPacketSize; ++lane)
      if (culled[lane] <= 0.0F)
        visit(packet.index(lane));
  }
}

}  // namespace endovascular_sim::contact
