#include "contact/bvh.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

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

TEST_F(BvhOfATube, CollectsEveryTriangleWithinTheRadius)
{
  for (int trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d p = next();
    const double radius = 0.012;
    std::vector<int> found;
    bvh_.collect(p, radius, found);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (std::size_t t = 0; t < wall_.triangles.size(); ++t)
    {
      const Eigen::Vector3i& c = wall_.triangles[t];
      const Eigen::Vector3d closest =
          vessel::closestPointOnTriangle(p, wall_.vertices[c[0]], wall_.vertices[c[1]], wall_.vertices[c[2]]).point;
      if ((closest - p).norm() <= radius)
      {
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), static_cast<int>(t)));
      }
    }
  }
}

TEST_F(BvhOfATube, SaysThatNothingIsNearWhenNothingIs)
{
  EXPECT_EQ(bvh_.nearest({1.0, 1.0, 1.0}, 0.1).triangle, -1);
}

}  // namespace
}  // namespace endovascular_sim::contact
