#include "common/numerics/counter_noise.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

using endovascular_sim::CounterNoise;

TEST(CounterNoise, HasTheMomentsOfTheNormalDistribution)
{
  const int n = 200000;
  std::vector<float> a(n);
  std::vector<float> b(n);
  CounterNoise(7, 3).fill(0, n, a.data(), b.data());
  double mean = 0.0;
  double square = 0.0;
  double fourth = 0.0;
  double product = 0.0;
  double neighbour = 0.0;
  for (int k = 0; k < n; ++k)
  {
    mean += a[k] / n;
    square += a[k] * a[k] / n;
    fourth += std::pow(a[k], 4) / n;
    product += a[k] * b[k] / n;
    neighbour += k > 0 ? a[k] * a[k - 1] / n : 0.0;
  }
  EXPECT_NEAR(mean, 0.0, 0.01);
  EXPECT_NEAR(square, 1.0, 0.015);
  EXPECT_NEAR(fourth, 3.0, 0.12);
  EXPECT_NEAR(product, 0.0, 0.01);
  EXPECT_NEAR(neighbour, 0.0, 0.01);
}

TEST(CounterNoise, IsAFunctionOfSeedStreamAndIndex)
{
  std::vector<float> a(100);
  std::vector<float> b(100);
  CounterNoise(1, 2).fill(0, 100, a.data(), b.data());
  float c = 0.0F;
  float d = 0.0F;
  CounterNoise(1, 2).fill(63, 1, &c, &d);
  EXPECT_EQ(c, a[63]);
  EXPECT_EQ(d, b[63]);
  CounterNoise(2, 2).fill(63, 1, &c, &d);
  EXPECT_NE(c, a[63]);
  CounterNoise(1, 3).fill(63, 1, &c, &d);
  EXPECT_NE(c, a[63]);
}
