#include "contact/bvh.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

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

TEST_F(BvhOfATube, CollectsTheTrianglesWhoseBoxesMeetABox)
{
  std::uniform_real_distribution<double> size(1e-4, 0.01);
  std::size_t met = 0;
  for (std::size_t trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d half(size(random_), size(random_), size(random_));
    const Eigen::Vector3d middle = wall_.vertices[trial * 7 % wall_.vertices.size()] + half.reverse();
    const Eigen::AlignedBox3d box(middle - half, middle + half);
    std::vector<int> found;
    bvh_.collectBox(box.min(), box.max(), found);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (std::size_t t = 0; t < wall_.triangles.size(); ++t)
    {
      Eigen::AlignedBox3d around;
      for (int corner = 0; corner < 3; ++corner)
        around.extend(wall_.vertices[wall_.triangles[t][corner]]);
      const bool is_found = std::binary_search(found.begin(), found.end(), static_cast<int>(t));
      EXPECT_TRUE(is_found || !around.intersects(box)) << "none is missed";
      EXPECT_TRUE(!is_found || around.exteriorDistance(box) < 1e-7) << "none is far off";
      met += is_found;
    }
  }
  EXPECT_GT(met, 1000U);
}

TEST_F(BvhOfATube, SaysThatNothingIsNearWhenNothingIs)
{
  EXPECT_EQ(bvh_.nearest({1.0, 1.0, 1.0}, 0.1).triangle, -1);
}

}  // namespace
}  // namespace endovascular_sim::contact
