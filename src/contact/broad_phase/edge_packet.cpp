#include "contact/broad_phase/edge_packet.h"

#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::contact
{

void EdgeLanes::set(int lane, const EdgeBounds& bounds, const Eigen::Vector3d& origin)
{
  const Eigen::Vector3d along =
      bounds.half_length > 0.0 ? Eigen::Vector3d(bounds.half / bounds.half_length) : Eigen::Vector3d::Zero();
  middles_.set(lane, bounds.middle - origin);
  normals_.set(lane, bounds.normal);
  along_.set(lane, along);
  across_.set(lane, bounds.normal.cross(along));
  half_[lane] = static_cast<float>(bounds.half_length);
  cone_slope_[lane] = std::isinf(bounds.cone_slope) ? kPacketOpen : static_cast<float>(bounds.cone_slope);
}

EdgeLanes::Probe::Probe(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper, const Eigen::Vector3d& origin,
                        double cutoff_, double displacement_)
  : begin((a - origin).cast<float>()), end((b - origin).cast<float>())
{
  const Eigen::Vector3d edge = b - a;
  const double whole = edge.norm();
  direction = whole > 0.0 ? Eigen::Vector3f((edge / whole).cast<float>()) : Eigen::Vector3f::Zero();
  length = static_cast<float>(whole);
  // Distance minus radius is least where both grow equally along the axis: at most taper slope × distance from the
  // foot.
  beyond = (whole > 0.0 ? static_cast<float>(std::abs(taper) / whole * cutoff_) : 0.0F) + kPacketSlack;
  cutoff = static_cast<float>(cutoff_) + kPacketSlack;
  displacement = static_cast<float>(displacement_) + kPacketSlack;
}

}  // namespace endovascular_sim::contact
