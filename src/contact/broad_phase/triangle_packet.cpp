#include "contact/broad_phase/triangle_packet.h"

#include <cmath>

namespace endovascular_sim::contact
{

void TrianglePacket::set(int lane, int triangle, const TriangleSlab& prism, const Eigen::Vector3d& origin, float clear)
{
  const Eigen::Array4d heights = prism.heights(origin);
  for (int plane = 0; plane < 4; ++plane)
  {
    planes_[plane].normal.set(lane, {prism.planes[0][plane], prism.planes[1][plane], prism.planes[2][plane]});
    planes_[plane].offset[lane] = static_cast<float>(heights[plane]);
  }
  const auto slope = [](double tangent) { return std::isinf(tangent) ? kQuadOpen : static_cast<float>(tangent); };
  edge_slope_[lane] = slope(prism.edge_slope);
  corner_slope_[lane] = slope(prism.corner_slope);
  clear_[lane] = clear;
  triangles_[lane] = triangle;
}

TrianglePacket::Place::Place(const Eigen::Vector3d& point, const Eigen::Vector3d& origin, double limit_, double moved_)
  : from_origin((point - origin).cast<float>()),
    limit(static_cast<float>(limit_) + kQuadSlack),
    squared_limit((1.0F + 1e-5F) * limit * limit),
    moved(static_cast<float>(moved_) + kQuadSlack)
{
}

}  // namespace endovascular_sim::contact
