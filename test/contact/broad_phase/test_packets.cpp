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

constexpr double kLimit = 0.7e-3;  // m
constexpr double kFar = 3e-6;      // m by which something is clearly out of the question
const Eigen::Vector3d kOrigin(0.1, -0.2, 0.3);

/** Shapes of a millimetre round an origin. */
class Quads : public testing::Test
{
protected:
  double next(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Eigen::Vector3d direction() { return Eigen::Vector3d(next(-1, 1), next(-1, 1), next(-1, 1)).normalized(); }
  Eigen::Vector3d place() { return kOrigin + 1e-3 * Eigen::Vector3d(next(-1, 1), next(-1, 1), next(-1, 1)); }
  double slope()
  {
    const double s = next(0.0, 1.2);
    return s > 1.0 ? std::numeric_limits<double>::infinity() : s;
  }

  TriangleSlab prism()
  {
    const std::array<Eigen::Vector3d, 3> corners{place(), place(), place()};
    middle_ = (corners[0] + corners[1] + corners[2]) / 3.0;
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    TriangleSlab prism;
    const auto set = [&prism](int lane, const Eigen::Vector3d& n, const Eigen::Vector3d& on)
    {
      for (int axis = 0; axis < 3; ++axis)
        prism.planes[axis][lane] = n[axis];
      prism.planes[3][lane] = -n.dot(on);
    };
    set(0, normal, corners[0]);
    for (int k = 0; k < 3; ++k)
      set(k + 1, normal.cross(corners[(k + 1) % 3] - corners[k]).normalized(), corners[k]);
    prism.edge_slope = slope();
    prism.corner_slope = slope();
    return prism;
  }

  EdgeBounds ball()
  {
    const Eigen::Vector3d along = direction();
    const double half = next(0.05e-3, 0.5e-3);
    return {place(), along.cross(direction()).normalized(), half * along, half, slope(), true};
  }

  std::mt19937 random_{7};
  Eigen::Vector3d middle_ = kOrigin;  ///< of the last prism's triangle
};

/** By how much a point misses what a triangle asks of it, not positive where it does not [m]. */
double missed(const TriangleSlab& prism, const Eigen::Vector3d& point)
{
  const Eigen::Array4d above = prism.heights(point);
  const double beyond = std::max(0.0, TriangleSlab::outsideOf(above));
  std::array<double, 3> off{std::abs(above[1]), std::abs(above[2]), std::abs(above[3])};
  std::sort(off.begin(), off.end());
  const auto outside = [&above](double distance, double slope)
  { return above[0] < 0.0 || std::isinf(slope) ? 0.0 : distance - above[0] * slope; };
  const double aside = std::max(outside(beyond, prism.bulge()),
                                std::min(outside(off[0], prism.edge_slope), outside(off[1], prism.corner_slope)));
  return std::max(std::hypot(above[0], beyond) - kLimit, beyond > 0.0 ? aside : 0.0);
}

TEST_F(Quads, HideNoTriangleThatAPointMayTouchAndEveryOneThatItClearlyMayNot)
{
  int touched = 0;
  int hidden = 0;
  for (int trial = 0; trial < 20000; ++trial)
  {
    TrianglePacket quad;
    std::array<TriangleSlab, kQuad> prisms;
    for (int lane = 0; lane < kQuad; ++lane)
      quad.set(lane, lane, prisms[static_cast<std::size_t>(lane)] = prism(), kOrigin, 0.0F);
    const Eigen::Vector3d point = place();
    const Packet4f answer = quad.hidden(TrianglePacket::Place(point, kOrigin, kLimit, 0.0));
    for (int lane = 0; lane < kQuad; ++lane)
    {
      const TriangleSlab& triangle = prisms[static_cast<std::size_t>(lane)];
      const double by = missed(triangle, point);
      const bool clearly = by > 3.0 * kFar && std::abs(triangle.heights(point)[0]) > kFar;
      EXPECT_TRUE(by > 0.0 || answer[lane] <= 0.0F) << trial;
      EXPECT_TRUE(!clearly || answer[lane] > 0.0F) << trial << ": by " << by;
      touched += by <= 0.0;
      hidden += answer[lane] > 0.0F;
    }
  }
  EXPECT_GT(touched, 1000);
  EXPECT_GT(hidden, 10000);
}

/** Whether the surface of a wire's edge touches a ridge between the edge's ends: an offset that lies behind it, or in
 *  the cone above it. */
bool touches(const EdgeBounds& ball, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper)
{
  const Eigen::Vector3d end0 = ball.middle - ball.half;
  const Eigen::Vector3d end1 = ball.middle + ball.half;
  const geometry::SegmentPair pair = taper == 0.0 ? geometry::closestPointsOfSegments(a, b, end0, end1)
                                                  : geometry::closestPointsOfCone({a, b, taper}, end0, end1);
  if (pair.first <= 0.0 || pair.first >= 1.0)
    return false;
  const Eigen::Vector3d offset = a + pair.first * (b - a) - end0 - pair.second * (end1 - end0);
  const double height = offset.dot(ball.normal);
  const double beside = (offset - height * ball.normal).norm();
  return offset.norm() <= kLimit && (height < 0.0 || std::isinf(ball.lean) || beside <= ball.lean * height);
}

TEST_F(Quads, HideNoRidgeThatAWireTouchesBetweenItsNodesHoweverItTapers)
{
  int touched = 0;
  int hidden = 0;
  for (int trial = 0; trial < 20000; ++trial)
  {
    EdgePacket quad;
    std::array<EdgeBounds, kQuad> balls;
    for (int lane = 0; lane < kQuad; ++lane)
      quad.set(lane, lane, balls[static_cast<std::size_t>(lane)] = ball(), kOrigin, 0.0F);
    const Eigen::Vector3d a = place();
    const Eigen::Vector3d b = a + next(0.2e-3, 1e-3) * direction();
    const double taper = trial % 2 == 0 ? 0.0 : next(-0.9, 0.9) * (b - a).norm();
    const Packet4f answer = quad.hidden(EdgePacket::Place(a, b, taper, kOrigin, kLimit, 0.0));
    for (int lane = 0; lane < kQuad; ++lane)
    {
      const bool touching = touches(balls[static_cast<std::size_t>(lane)], a, b, taper);
      EXPECT_TRUE(!touching || answer[lane] <= 0.0F) << trial;
      touched += touching;
      hidden += answer[lane] > 0.0F;
    }
  }
  EXPECT_GT(touched, 1000);
  EXPECT_GT(hidden, 40000);
}

TEST_F(Quads, HideWhatIsListedForLaterAndTheLanesThatAreEmpty)
{
  const TriangleSlab triangle = prism();
  const EdgeBounds ridge = ball();
  const Eigen::Vector3d centre = ridge.middle + 0.1e-3 * ridge.normal;
  const Eigen::Vector3d across = ridge.normal.cross(ridge.half).normalized();
  for (const double moved : {0.05e-3, 0.15e-3})
  {
    TrianglePacket prisms;
    prisms.set(0, 5, triangle, kOrigin, 0.1e-3F);
    const Packet4f of_prisms = prisms.hidden(TrianglePacket::Place(middle_, kOrigin, kLimit, moved));
    EdgePacket ridges;
    ridges.set(0, 6, ridge, kOrigin, 0.1e-3F);
    const Packet4f of_ridges = ridges.hidden(
        EdgePacket::Place(centre - 0.3e-3 * across, centre + 0.3e-3 * across, 0.0, kOrigin, kLimit, moved));
    EXPECT_EQ(of_ridges[0] > 0.0F, moved < 0.1e-3);
    EXPECT_EQ(of_prisms[0] > 0.0F, moved < 0.1e-3);
    for (int lane = 1; lane < kQuad; ++lane)
    {
      EXPECT_GT(of_prisms[lane], 0.0F);
      EXPECT_GT(of_ridges[lane], 0.0F);
    }
    EXPECT_EQ(prisms.index(0), 5);
    EXPECT_EQ(ridges.index(0), 6);
  }
}

}  // namespace
}  // namespace endovascular_sim::contact
