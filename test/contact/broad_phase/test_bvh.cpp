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

TEST_F(BvhOfATube, FindsTheNearestTriangleThatBruteForceFinds)
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

TEST_F(BvhOfATube, CollectsTheTrianglesWhoseBoxesMeetThatOfAViewWhileItKnowsNoCones)
{
  std::uniform_real_distribution<double> size(1e-4, 0.01);
  std::size_t met = 0;
  for (std::size_t trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d along(size(random_), size(random_), size(random_));
    const Eigen::Vector3d begin = wall_.vertices[trial * 7 % wall_.vertices.size()] + along.reverse();
    const double farthest = size(random_);
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(farthest);
    const Eigen::AlignedBox3d box(begin - around, begin + along + around);
    std::vector<int> found, ridged;
    bvh_.collect({begin, along, farthest, 0.0}, {begin, along, farthest, 0.0}, found, ridged);
    EXPECT_EQ(found, ridged);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (std::size_t t = 0; t < wall_.triangles.size(); ++t)
    {
      const bool is_found = std::binary_search(found.begin(), found.end(), static_cast<int>(t));
      const Eigen::AlignedBox3d triangle = boxOf(wall_, static_cast<int>(t));
      EXPECT_TRUE(is_found || !triangle.intersects(box)) << "none is missed";
      EXPECT_TRUE(!is_found || triangle.exteriorDistance(box) < 1e-7) << "none is far off";
      met += is_found;
    }
  }
  EXPECT_GT(met, 1000U);
}

TEST_F(BvhOfATube, SaysThatNothingIsNearWhenNothingIs)
{
  EXPECT_EQ(bvh_.nearest({1.0, 1.0, 1.0}, 0.1).triangle, -1);
}

/** With facets of 0.3 mm, finer than a wire is thick. */
geometry::TriangleMesh fineTube()
{
  vessel::TubeShape shape;
  shape.radius = 3e-3;
  shape.facet_length = 0.3e-3;
  shape.facets_around = 60;
  shape.pieces = {{0.01, 0.0, 0.0}};
  return vessel::tubeMesh(shape);
}

class ConesInTheTree : public testing::Test
{
protected:
  static constexpr double kLimit = 0.6e-3;  // m

  ConesInTheTree() : cones_(wall_.triangles.size())
  {
    const std::array<double, 4> facet{0.0, 0.02, 0.7, std::numeric_limits<double>::infinity()};
    const std::array<double, 4> ridge{-1.0, 0.05, -1.0, 0.5};
    for (Bvh::Cone& cone : cones_)
      cone = {facet[die(2)], ridge[die(3)]};
    bvh_.setCones(cones_);
  }

  /** 0 nearly always, else up to 3: one open cone opens all those above it. */
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

  /** A view of the wall from about a wire's radius above it. */
  Bvh::View view()
  {
    const std::size_t t = pick(wall_.triangles.size());
    const Eigen::Vector3d normal = wall_.normals[t];
    const Eigen::Vector3d along = normal.cross(inUnitBall()) * 1e-3 * share();
    const double room = 0.15e-3 * share();
    return {wall_.vertices[wall_.triangles[t][0]] + (0.1e-3 + 0.5e-3 * share()) * normal, along, kLimit + room, room};
  }

  /** What may be closest to a place of a view, by looking at every triangle. @param tangent of the triangle's cone */
  template <typename Tangent>
  void expectAllOf(const Bvh::View& from, std::vector<int> found, const Tangent& tangent)
  {
    std::sort(found.begin(), found.end());
    const Eigen::Vector3d place = from.begin + share() * from.along + from.room * inUnitBall();
    for (int t = 0; t < static_cast<int>(wall_.triangles.size()); ++t)
    {
      const double widest = tangent(cones_[t]);
      if (widest < 0.0 || boxOf(wall_, t).exteriorDistance(place) > kLimit)
        continue;
      const Eigen::Vector3i& c = wall_.triangles[t];
      const Eigen::Vector3d offset =
          place -
          geometry::closestPointOnTriangle(place, wall_.vertices[c[0]], wall_.vertices[c[1]], wall_.vertices[c[2]])
              .point;
      const double height = offset.dot(wall_.normals[t]);
      const double beside = (offset - height * wall_.normals[t]).norm();
      if (offset.norm() > kLimit || (height > 0.0 && beside > widest * height))
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

TEST_F(ConesInTheTree, HideNothingThatCanBeClosestToAPlaceThatMovesWithinItsRoom)
{
  std::size_t collected = 0;
  std::size_t in_reach = 0;
  for (int trial = 0; trial < 1000; ++trial)
  {
    const Bvh::View facets = view();
    Bvh::View ridges = facets;
    ridges.along *= 2.0;
    std::vector<int> triangles, ridged;
    bvh_.collect(facets, ridges, triangles, ridged);
    for (int place = 0; place < 3; ++place)
    {
      expectAllOf(facets, triangles, [](const Bvh::Cone& cone) { return cone.facet; });
      expectAllOf(ridges, ridged, [](const Bvh::Cone& cone) { return cone.ridge; });
    }
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(facets.farthest);
    const Eigen::Vector3d end = facets.begin + facets.along;
    const Eigen::AlignedBox3d box(facets.begin.cwiseMin(end) - around, facets.begin.cwiseMax(end) + around);
    collected += triangles.size();
    for (int t = 0; t < static_cast<int>(wall_.triangles.size()); ++t)
      in_reach += boxOf(wall_, t).intersects(box);
  }
  EXPECT_GT(closest_, 1000U);
  EXPECT_LT(collected, in_reach * 2 / 3) << "and that they hide much of the rest, or this tests nothing";
}

TEST_F(ConesInTheTree, HideNothingThatHasBeenOpened)
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
    const Bvh::View from = view();
    std::vector<int> triangles, ridged;
    bvh_.collect(from, from, triangles, ridged);
    expectAllOf(from, triangles, [](const Bvh::Cone& cone) { return cone.facet; });
    expectAllOf(from, ridged, [](const Bvh::Cone& cone) { return cone.ridge; });
  }
  EXPECT_GT(closest_, 1000U);
}

}  // namespace
}  // namespace endovascular_sim::contact
