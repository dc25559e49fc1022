#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "contact/broad_phase/edge_packet.h"
#include "contact/broad_phase/triangle_packet.h"
#include "geometry/closest_points_on_segments.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kCutoff = 0.7e-3;  // m
constexpr double kRounding = 3e-6;  // m: exceeds the rounding error of packets
const Eigen::Vector3d kOrigin(0.1, -0.2, 0.3);

/** Random shapes of a millimetre near an origin. */
class Packets : public testing::Test
{
protected:
  double next(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Eigen::Vector3d direction() { return Eigen::Vector3d(next(-1, 1), next(-1, 1), next(-1, 1)).normalized(); }
  Eigen::Vector3d anyPoint() { return kOrigin + 1e-3 * Eigen::Vector3d(next(-1, 1), next(-1, 1), next(-1, 1)); }
  double slope()
  {
    const double s = next(0.0, 1.2);
    return s > 1.0 ? std::numeric_limits<double>::infinity() : s;
  }

  TriangleSlab anySlab()
  {
    const std::array<Eigen::Vector3d, 3> corners{anyPoint(), anyPoint(), anyPoint()};
    centroid_ = (corners[0] + corners[1] + corners[2]) / 3.0;
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    TriangleSlab slab;
    const auto set = [&slab](int lane, const Eigen::Vector3d& n, const Eigen::Vector3d& on)
    {
      for (int axis = 0; axis < 3; ++axis)
        slab.planes[axis][lane] = n[axis];
      slab.planes[3][lane] = -n.dot(on);
    };
    set(0, normal, corners[0]);
    for (int k = 0; k < 3; ++k)
      set(k + 1, normal.cross(corners[(k + 1) % 3] - corners[k]).normalized(), corners[k]);
    slab.edge_slope = slope();
    slab.corner_slope = slope();
    return slab;
  }

  EdgeBounds anyBounds()
  {
    const Eigen::Vector3d along = direction();
    const double half = next(0.05e-3, 0.5e-3);
    return {anyPoint(), along.cross(direction()).normalized(), half * along, half, slope(), true};
  }

  std::mt19937 random_{7};
  Eigen::Vector3d centroid_ = kOrigin;  ///< of the triangle of the last slab
};

/** Violation of a slab's conditions on a local minimum in double precision; not positive if a point meets them [m]. */
double violation(const TriangleSlab& slab, const Eigen::Vector3d& point)
{
  const Eigen::Array4d heights = slab.heights(point);
  const double beyond = std::max(0.0, TriangleSlab::distanceBeyond(heights));
  std::array<double, 3> off{std::abs(heights[1]), std::abs(heights[2]), std::abs(heights[3])};
  std::sort(off.begin(), off.end());
  const auto outside = [&heights](double distance, double slope)
  { return heights[0] < 0.0 || std::isinf(slope) ? 0.0 : distance - heights[0] * slope; };
  const double aside = std::max(outside(beyond, slab.bulge()),
                                std::min(outside(off[0], slab.edge_slope), outside(off[1], slab.corner_slope)));
  return std::max(std::hypot(heights[0], beyond) - kCutoff, beyond > 0.0 ? aside : 0.0);
}

TEST_F(Packets, CullTrianglesThatClearlyCannotContactAPointAndNoOthers)
{
  int contacts = 0;
  int culled = 0;
  for (int trial = 0; trial < 20000; ++trial)
  {
    TrianglePacket packet;
    std::array<TriangleSlab, kPacketSize> slabs;
    for (int lane = 0; lane < kPacketSize; ++lane)
      packet.set(lane, lane, slabs[static_cast<std::size_t>(lane)] = anySlab(), kOrigin, 0.0F);
    const Eigen::Vector3d point = anyPoint();
    const Packet4f result = packet.culled(TrianglePacket::Probe(point, kOrigin, kCutoff, 0.0));
    for (int lane = 0; lane < kPacketSize; ++lane)
    {
      const TriangleSlab& triangle = slabs[static_cast<std::size_t>(lane)];
      const double by = violation(triangle, point);
      const bool clearly = by > 3.0 * kRounding && std::abs(triangle.heights(point)[0]) > kRounding;
      EXPECT_TRUE(by > 0.0 || result[lane] <= 0.0F) << trial;
      EXPECT_TRUE(!clearly || result[lane] > 0.0F) << trial << ": by " << by;
      contacts += by <= 0.0;
      culled += result[lane] > 0.0F;
    }
  }
  EXPECT_GT(contacts, 1000);
  EXPECT_GT(culled, 10000);
}

/** Whether the surface of a wire's edge contacts a reflex edge between its ends: the offset lies behind the reflex edge
 *  or in its cone. */
bool touches(const EdgeBounds& bounds, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper)
{
  const Eigen::Vector3d end0 = bounds.middle - bounds.half;
  const Eigen::Vector3d end1 = bounds.middle + bounds.half;
  const geometry::SegmentPair pair = taper == 0.0 ? geometry::closestPointsOfSegments(a, b, end0, end1)
                                                  : geometry::closestPointsOfCone({a, b, taper}, end0, end1);
  if (pair.first <= 0.0 || pair.first >= 1.0)
    return false;
  const Eigen::Vector3d offset = a + pair.first * (b - a) - end0 - pair.second * (end1 - end0);
  const double height = offset.dot(bounds.normal);
  const double beside = (offset - height * bounds.normal).norm();
  return offset.norm() <= kCutoff &&
         (height < 0.0 || std::isinf(bounds.cone_slope) || beside <= bounds.cone_slope * height);
}

TEST_F(Packets, CullNoReflexEdgeThatATaperedWireTouchesBetweenItsNodes)
{
  int contacts = 0;
  int culled = 0;
  for (int trial = 0; trial < 20000; ++trial)
  {
    EdgePacket packet;
    std::array<EdgeBounds, kPacketSize> bounds;
    for (int lane = 0; lane < kPacketSize; ++lane)
      packet.set(lane, lane, bounds[static_cast<std::size_t>(lane)] = anyBounds(), kOrigin, 0.0F);
    const Eigen::Vector3d a = anyPoint();
    const Eigen::Vector3d b = a + next(0.2e-3, 1e-3) * direction();
    const double taper = trial % 2 == 0 ? 0.0 : next(-0.9, 0.9) * (b - a).norm();
    const Packet4f result = packet.culled(EdgePacket::Probe(a, b, taper, kOrigin, kCutoff, 0.0));
    for (int lane = 0; lane < kPacketSize; ++lane)
    {
      const bool touching = touches(bounds[static_cast<std::size_t>(lane)], a, b, taper);
      EXPECT_TRUE(!touching || result[lane] <= 0.0F) << trial;
      contacts += touching;
      culled += result[lane] > 0.0F;
    }
  }
  EXPECT_GT(contacts, 1000);
  EXPECT_GT(culled, 40000);
}

TEST_F(Packets, CullFeaturesBelowTheirClearanceAndEmptyLanes)
{
  const TriangleSlab triangle = anySlab();
  const EdgeBounds reflex_edge = anyBounds();
  const Eigen::Vector3d centre = reflex_edge.middle + 0.1e-3 * reflex_edge.normal;
  const Eigen::Vector3d across = reflex_edge.normal.cross(reflex_edge.half).normalized();
  for (const double moved : {0.05e-3, 0.15e-3})
  {
    TrianglePacket slabs;
    slabs.set(0, 5, triangle, kOrigin, 0.1e-3F);
    const Packet4f of_triangles = slabs.culled(TrianglePacket::Probe(centroid_, kOrigin, kCutoff, moved));
    EdgePacket edges;
    edges.set(0, 6, reflex_edge, kOrigin, 0.1e-3F);
    const Packet4f of_edges = edges.culled(
        EdgePacket::Probe(centre - 0.3e-3 * across, centre + 0.3e-3 * across, 0.0, kOrigin, kCutoff, moved));
    EXPECT_EQ(of_edges[0] > 0.0F, moved < 0.1e-3);
    EXPECT_EQ(of_triangles[0] > 0.0F, moved < 0.1e-3);
    for (int lane = 1; lane < kPacketSize; ++lane)
    {
      EXPECT_GT(of_triangles[lane], 0.0F);
      EXPECT_GT(of_edges[lane], 0.0F);
    }
    EXPECT_EQ(slabs.index(0), 5);
    EXPECT_EQ(edges.index(0), 6);
  }
}

}  // namespace
}  // namespace endovascular_sim::contact
