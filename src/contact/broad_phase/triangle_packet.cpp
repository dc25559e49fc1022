#include "contact/broad_phase/triangle_packet.h"

#include <cmath>

namespace endovascular_sim::contact
{

void TriangleLanes::set(int lane, const TriangleSlab& slab, const Eigen::Vector3d& origin)
{
  const Eigen::Array4d heights = slab.heights(origin);
  for (int plane = 0; plane < 4; ++plane)
  {
    planes_[plane].normal.set(lane, {slab.planes[0][plane], slab.planes[1][plane], slab.planes[2][plane]});
    planes_[plane].offset[lane] = static_cast<float>(heights[plane]);
  }
  const auto slope = [](double tangent) { return std::isinf(tangent) ? kPacketOpen : static_cast<float>(tangent); };
  edge_slope_[lane] = slope(slab.edge_slope);
  corner_slope_[lane] = slope(slab.corner_slope);
}

TriangleLanes::Probe::Probe(const Eigen::Vector3d& point, const Eigen::Vector3d& origin, double cutoff_,
                            double displacement_)
  : from_origin((point - origin).cast<float>()),
    cutoff(static_cast<float>(cutoff_) + kPacketSlack),
    squared_cutoff((1.0F + 1e-5F) * cutoff * cutoff),
    displacement(static_cast<float>(displacement_) + kPacketSlack)
{
}

}  // namespace endovascular_sim::contact
