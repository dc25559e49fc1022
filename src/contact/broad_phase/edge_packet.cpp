#include "contact/broad_phase/edge_packet.h"

#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::contact
{

void EdgePacket::set(int lane, int wall_edge, const EdgeBounds& ball, const Eigen::Vector3d& origin, float clear)
{
  const Eigen::Vector3d along =
      ball.half_length > 0.0 ? Eigen::Vector3d(ball.half / ball.half_length) : Eigen::Vector3d::Zero();
  middles_.set(lane, ball.middle - origin);
  normals_.set(lane, ball.normal);
  along_.set(lane, along);
  across_.set(lane, ball.normal.cross(along));
  half_[lane] = static_cast<float>(ball.half_length);
  lean_[lane] = std::isinf(ball.lean) ? kQuadOpen : static_cast<float>(ball.lean);
  clear_[lane] = ball.reflex ? clear : kNever;
  edges_[lane] = wall_edge;
}

EdgePacket::Place::Place(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper,
                         const Eigen::Vector3d& origin, double limit_, double moved_)
  : begin((a - origin).cast<float>()), end((b - origin).cast<float>())
{
  const Eigen::Vector3d edge = b - a;
  const double whole = edge.norm();
  direction = whole > 0.0 ? Eigen::Vector3f((edge / whole).cast<float>()) : Eigen::Vector3f::Zero();
  length = static_cast<float>(whole);
  // Distance less radius is least where the distance grows along the axis as the radius does: beside the foot by the
  // distance times the taper's slope.
  beyond = (whole > 0.0 ? static_cast<float>(std::abs(taper) / whole * limit_) : 0.0F) + kQuadSlack;
  limit = static_cast<float>(limit_) + kQuadSlack;
  moved = static_cast<float>(moved_) + kQuadSlack;
}

}  // namespace endovascular_sim::contact
