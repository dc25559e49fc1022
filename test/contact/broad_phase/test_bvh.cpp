#include "contact/broad_phase/bvh.h"

#include <algorithm>
#include <array>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

Eigen::AlignedBox3d boxOf(const Wall& wall, int triangle)
{
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 3; ++corner)
    box.extend(wall.vertices[wall.triangles[triangle][corner]]);
  return box;
}

class BvhOfATube : public testing::Test
{
protected:
  Eigen::Vector3d next()
  {
    std::uniform_real_distribution<double> uniform(-0.03, 0.09);
    return {uniform(random_), uniform(random_), uniform(random_)};
  }
  Wall wall_{bentTube()};
  Bvh bvh_{wall_};
  std::mt19937 random_{5};
};

TEST_F(BvhOfATube, FindsTheNearestTriangle)
{
  for (int trial = 0; trial < 500; ++trial)
  {
    const Eigen::Vector3d p = next();
    int triangle = -1;
    const double expected = bruteDistance(wall_, p, triangle);
    const Bvh::Nearest nearest = bvh_.nearest(p, 1.0);
    EXPECT_NEAR(nearest.distance, expected, 1e-15);
  }
}

TEST_F(BvhOfATube, CollectsTheTrianglesWhoseBoxesOverlapTheSegmentsBoxWhileConesAreOpen)
{
  std::uniform_real_distribution<double> size(1e-4, 0.01);
  std::size_t met = 0;
  for (std::size_t trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d along(size(random_), size(random_), size(random_));
    const Eigen::Vector3d begin = wall_.vertices[trial * 7 % wall_.vertices.size()] + along.reverse();
    const double cutoff = size(random_);
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(cutoff);
    const Eigen::AlignedBox3d box(begin - around, begin + along + around);
    std::vector<int> found, owners;
    bvh_.collect({begin, along, cutoff, 0.0}, {begin, along, cutoff, 0.0}, found, owners);
    EXPECT_EQ(found, owners);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (std::size_t t = 0; t < wall_.triangles.size(); ++t)
    {
      const bool is_found = std::binary_search(found.begin(), found.end(), static_cast<int>(t));
      const Eigen::AlignedBox3d triangle = boxOf(wall_, static_cast<int>(t));
      EXPECT_TRUE(is_found || !triangle.intersects(box)) << "missed";
      EXPECT_TRUE(!is_found || triangle.exteriorDistance(box) < 1e-7) << "too far";
      met += is_found;
    }
  }
  EXPECT_GT(met, 1000U);
}

TEST_F(BvhOfATube, FindsNoTriangleBeyondTheGivenDistance)
{
  EXPECT_EQ(bvh_.nearest({1.0, 1.0, 1.0}, 0.1).triangle, -1);
}

/** A tube with facets of 0.3 mm, smaller than a wire's radius. */
geometry::TriangleMesh fineTube()
{
  vessel::TubeShape shape;
  shape.radius = 3e-3;
  shape.facet_length = 0.3e-3;
  shape.facets_around = 60;
  shape.pieces = {{0.01, 0.0, 0.0}};
  return vessel::tubeMesh(shape);
}

class NormalCones : public testing::Test
{
protected:
  static constexpr double kCutoff = 0.6e-3;  // m

  NormalCones() : cones_(wall_.triangles.size())
  {
    const std::array<double, 4> facet{0.0, 0.02, 0.7, std::numeric_limits<double>::infinity()};
    const std::array<double, 4> reflex_edge{-1.0, 0.05, -1.0, 0.5};
    for (Bvh::Cone& cone : cones_)
      cone = {facet[die(2)], reflex_edge[die(3)]};
    bvh_.setCones(cones_);
  }

  /** Nearly always 0, otherwise up to 3. Open cones are rare because each opens all its ancestors. */
  std::size_t die(int odds) { return std::uniform_int_distribution<int>(0, 20)(random_) > odds ? 0U : pick(4U); }
  std::size_t pick(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  double share() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  Eigen::Vector3d inUnitBall()
  {
    Eigen::Vector3d v;
    do
      v = Eigen::Vector3d(share(), share(), share()) * 2.0 - Eigen::Vector3d::Ones();
    while (v.norm() > 1.0);
    return v;
  }

  /** A random segment at about a wire's radius from the wall. */
  Bvh::QuerySegment segment()
  {
    const std::size_t t = pick(wall_.triangles.size());
    const Eigen::Vector3d normal = wall_.normals[t];
    const Eigen::Vector3d along = normal.cross(inUnitBall()) * 1e-3 * share();
    const double skin = 0.15e-3 * share();
    return {wall_.vertices[wall_.triangles[t][0]] + (0.1e-3 + 0.5e-3 * share()) * normal, along, kCutoff + skin, skin};
  }

  /** Expects every triangle that brute force finds closest to a random point of a segment.
   *  @param tangent function that selects the slope of a cone */
  template <typename Tangent>
  void expectAllOf(const Bvh::QuerySegment& from, std::vector<int> found, const Tangent& tangent)
  {
    std::sort(found.begin(), found.end());
    const Eigen::Vector3d point = from.begin + share() * from.along + from.skin * inUnitBall();
    for (int t = 0; t < static_cast<int>(wall_.triangles.size()); ++t)
    {
      const double widest = tangent(cones_[t]);
      if (widest < 0.0 || boxOf(wall_, t).exteriorDistance(point) > kCutoff)
        continue;
      const Eigen::Vector3i& c = wall_.triangles[t];
      const Eigen::Vector3d offset =
          point -
          geometry::closestPointOnTriangle(point, wall_.vertices[c[0]], wall_.vertices[c[1]], wall_.vertices[c[2]])
              .point;
      const double height = offset.dot(wall_.normals[t]);
      const double beside = (offset - height * wall_.normals[t]).norm();
      if (offset.norm() > kCutoff || (height > 0.0 && beside > widest * height))
        continue;
      ++closest_;
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), t)) << "triangle " << t;
    }
  }

  Wall wall_{bumpy(fineTube(), 0.05)};
  Bvh bvh_{wall_};
  std::vector<Bvh::Cone> cones_;
  std::mt19937 random_{7};
  std::size_t closest_ = 0;
};

TEST_F(NormalCones, CullNoTriangleClosestToAPointDisplacedWithinTheSkin)
{
  std::size_t collected = 0;
  std::size_t in_reach = 0;
  for (int trial = 0; trial < 1000; ++trial)
  {
    const Bvh::QuerySegment facets = segment();
    Bvh::QuerySegment edges = facets;
    edges.along *= 2.0;
    std::vector<int> triangles, owners;
    bvh_.collect(facets, edges, triangles, owners);
    for (int point = 0; point < 3; ++point)
    {
      expectAllOf(facets, triangles, [](const Bvh::Cone& cone) { return cone.facet; });
      expectAllOf(edges, owners, [](const Bvh::Cone& cone) { return cone.reflex_edge; });
    }
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(facets.cutoff);
    const Eigen::Vector3d end = facets.begin + facets.along;
    const Eigen::AlignedBox3d box(facets.begin.cwiseMin(end) - around, facets.begin.cwiseMax(end) + around);
    collected += triangles.size();
    for (int t = 0; t < static_cast<int>(wall_.triangles.size()); ++t)
      in_reach += boxOf(wall_, t).intersects(box);
  }
  EXPECT_GT(closest_, 1000U);
  EXPECT_LT(collected, in_reach * 2 / 3) << "the cones must cull many of the others";
}

TEST_F(NormalCones, CullNothingOnceOpened)
{
  std::vector<int> opened;
  for (int t = 0; t < static_cast<int>(wall_.triangles.size()); t += 5)
  {
    opened.push_back(t);
    cones_[t] = Bvh::Cone{};
  }
  bvh_.openCones(opened);
  for (int trial = 0; trial < 200; ++trial)
  {
    const Bvh::QuerySegment from = segment();
    std::vector<int> triangles, owners;
    bvh_.collect(from, from, triangles, owners);
    expectAllOf(from, triangles, [](const Bvh::Cone& cone) { return cone.facet; });
    expectAllOf(from, owners, [](const Bvh::Cone& cone) { return cone.reflex_edge; });
  }
  EXPECT_GT(closest_, 1000U);
}

}  // namespace
}  // namespace endovascular_sim::contact
