#include "rod/model/bending_pair.h"

#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::rod
{
namespace
{

class BendingPairTest : public testing::Test
{
protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Eigen::Vector3d vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

  std::mt19937 random_{5};
};

TEST_F(BendingPairTest, EqualsTheTermsOfEachOfItsNodes)
{
  for (int trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d e[2] = {Eigen::Vector3d(1e-3, 0, 0) + vector(5e-4),
                                  Eigen::Vector3d(1e-3, 0, 0) + vector(5e-4)};
    const Eigen::Vector3d g[2] = {Eigen::Vector3d(1e-3, 0, 0) + vector(9e-4), vector(1e-3)};
    const Eigen::Vector3d rest[2] = {vector(0.3), vector(0.3)};
    const Pair weight{uniform(0.5, 2.0), uniform(0.5, 2.0)};
    const Pair torque{uniform(-1.0, 1.0), uniform(-1.0, 1.0)};
    const Pair product{1e-6, 1.2e-6};
    const BendingPair pair({PairVector::of(e[0], e[1]), PairVector::of(g[0], g[1]), product, weight,
                            PairVector::of(rest[0], rest[1]), torque, 2.0 * torque});
    for (int lane = 0; lane < 2; ++lane)
    {
      const CurvatureBinormal kb(e[lane], g[lane], product[lane]);
      const BendingHessian hessian(kb, weight[lane]);
      const Eigen::Vector3d strain = kb.value - rest[lane];
      const Eigen::Vector3d proximal = -weight[lane] * kb.transposeBefore(strain) - torque[lane] * kb.value;
      const Eigen::Vector3d distal = weight[lane] * kb.transposeAfter(strain) + 2.0 * torque[lane] * kb.value;
      const double size = hessian.before_before.norm() + hessian.after_after.norm();
      for (int line = 0; line < 3; ++line)
      {
        EXPECT_NEAR(pair.proximal[line][lane], proximal[line], 1e-12 * proximal.norm());
        EXPECT_NEAR(pair.distal[line][lane], distal[line], 1e-12 * distal.norm());
        for (int col = 0; col < 3; ++col)
        {
          EXPECT_NEAR(pair.before_after[line][col][lane], hessian.before_after(line, col), 1e-12 * size);
          if (col > line)
            continue;
          EXPECT_NEAR(pair.before_before[line][col][lane], hessian.before_before(line, col), 1e-12 * size);
          EXPECT_NEAR(pair.after_after[line][col][lane], hessian.after_after(line, col), 1e-12 * size);
        }
      }
    }
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
